#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/binding_points.h>

#include <cmath>

#include "support/pairs.h"
#include "support/random.h"

namespace tendril::bind {
namespace {

using test::Random;
using Long3 = Eigen::Matrix<long double, 3, 1>;

/// The curve and its derivative by the unit parameter of its span, by de Boor's triangle in longer numbers.
struct LongCurve {
  Long3 value, by_span;
};
LongCurve evaluate(const BSpline& curve, double t) {
  const auto p = static_cast<std::size_t>(curve.degree());
  const auto span = static_cast<std::size_t>(curve.knots().span(t));
  const auto knot = [&](std::size_t i) { return static_cast<long double>(curve.knots().knots()[i]); };
  std::vector<Long3> d;
  for (std::size_t j = 0; j <= p; ++j) d.push_back(curve.control_points()[span - p + j].cast<long double>());
  for (std::size_t level = 1; level < p; ++level)
    for (std::size_t j = p; j >= level; --j) {
      const long double w = (t - knot(span - p + j)) / (knot(span + 1 + j - level) - knot(span - p + j));
      d[j] = (1 - w) * d[j - 1] + w * d[j];
    }
  const long double length = knot(span + 1) - knot(span), w = (t - knot(span)) / length;
  return {(1 - w) * d[p - 1] + w * d[p], static_cast<long double>(p) * (d[p] - d[p - 1])};
}

double largest(const CurvePair& pair) {
  double most = 0.0;
  for (const Vec3& u : pair.primary().control_points()) most = std::max(most, u.norm());
  for (const Vec3& v : pair.orientation().control_points()) most = std::max(most, v.norm());
  return most;
}

/// Distance from exact arithmetic over what is promised.
long double share_of_promise(const CurvePair& pair, const AxialPoint& at, const Vec3& computed) {
  const LongCurve c = evaluate(pair.primary(), at.t), d = evaluate(pair.orientation(), at.t);
  const Long3 n = d.value - c.value, z = c.by_span.normalized(), x = n.cross(z).normalized(), y = z.cross(x);
  const Long3 exact = c.value + at.u * x + at.v * y + at.w * z;
  const long double speed = c.by_span.norm(), across = n.cross(z).norm(), size = largest(pair);
  const long double reach = std::abs(at.u) + std::abs(at.v) + std::abs(at.w);
  const long double promise = 0x1p-36L * size * (1 + reach * ((1 + n.norm() / across) / speed + 1 / across));
  return (computed.cast<long double>() - exact).norm() / promise;
}

CurvePair random_pair(int degree, double along, Random& random) {
  const KnotVector knots = KnotVector::uniform(degree, 9);
  const Vec3 far = random.in_cube(random.integer(3) * 100.0);
  std::vector<Vec3> c, d;
  for (int i = 0; i < 9; ++i) {
    c.push_back(far + Vec3(0.2 * i, 0, 0) + random.in_cube(0.3));
    d.push_back(c.back() + Vec3(along, 0, 0.02) + random.in_cube(0.05));
  }
  return CurvePair(knots, c, d);
}

TEST(BindingPoints, KeepTheirPromiseOnRounding) {
  Random random(1);
  long double worst = 0;
  for (int i = 0; i < 60; ++i) {
    const CurvePair pair = random_pair(1 + i % 5, i % 3 == 0 ? 1.0 : 0.0, random);
    std::vector<Vec3> points;
    for (int k = 0; k < 300; ++k) {
      const double t = random.uniform();
      points.push_back(pair.primary().value(t) + random.in_cube(0.3));
    }
    const Binding binding(pair, points);
    std::vector<Vec3> out(points.size());
    const CurvePair posed = random_pair(1 + i % 5, 0.0, random);
    for (const CurvePair& pose : {pair, posed}) {
      binding.update(pose, out);
      for (std::size_t k = 0; k < points.size(); ++k)
        worst = std::max(worst, share_of_promise(pose, binding.records()[k], out[k]));
    }
  }
  EXPECT_LT(worst, 1);
  EXPECT_GT(worst, 0);
}

PolygonMesh ring() {
  PolygonMesh mesh;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 12; ++j)
      mesh.points.emplace_back(i / 59.0, 0.2 * std::cos(j * 0.5236), 0.2 * std::sin(j * 0.5236));
  for (std::uint32_t i = 0; i + 1 < 60; ++i)
    for (std::uint32_t j = 0; j < 12; ++j) {
      const std::uint32_t a = 12 * i + j, b = 12 * i + (j + 1) % 12;
      mesh.corners.insert(mesh.corners.end(), {a, b, b + 12, a + 12});
      mesh.face_begin.push_back(mesh.face_begin.back() + 4);
    }
  return mesh;
}

CurvePair line(const Vec3& from, const Vec3& to) {
  std::vector<Vec3> p;
  for (int i = 0; i < 6; ++i) p.push_back(from + (to - from) * (i / 5.0));
  return test::pair_through(p, Vec3::UnitZ(), 0.1);
}

CurvePair thrown(const CurvePair& pair, Random& random) {
  std::vector<Vec3> c, d;
  for (std::size_t i = 0; i < pair.primary().control_points().size(); ++i) {
    c.push_back(random.in_cube());
    d.push_back(random.in_cube());
  }
  return CurvePair(pair.knots(), c, d);
}

/// Two axes and blends: any grouping, points twice and groups with none, gives the bits of an update.
TEST(BindingPoints, PlaceGroupsAsAnUpdateDoes) {
  BindOptions options;
  options.mode = BindMode::continuous;
  const std::vector<CurvePair> rest{line({0.05, 0, 0}, {0.45, 0, 0}), line({0.55, 0, 0}, {0.95, 0, 0})};
  const Binding binding(rest, ring(), options);
  ASSERT_GT(binding.report().shares, binding.size());
  const BindingPoints points(binding);
  Random random(2);
  std::vector<std::uint32_t> begin{0}, members;
  for (int g = 0; g < 40; ++g) {
    for (int k = g % 5 == 0 ? 0 : random.integer(600); k > 0; --k)
      members.push_back(static_cast<std::uint32_t>(random.integer(static_cast<int>(binding.size()))));
    begin.push_back(static_cast<std::uint32_t>(members.size()));
  }
  begin.push_back(begin.back());
  const auto groups = points.group(begin, members);
  for (int i = 0; i < 5; ++i) {
    const std::vector<CurvePair> posed{thrown(rest[0], random), thrown(rest[1], random)};
    std::vector<Vec3> all(binding.size());
    binding.update(posed, all);
    groups->pose(posed);
    for (std::size_t g = 0; g + 1 < begin.size(); ++g) {
      std::vector<Vec3> some(begin[g + 1] - begin[g]);
      groups->place(g, some);
      for (std::size_t k = 0; k < some.size(); ++k) ASSERT_EQ(some[k], all[members[begin[g] + k]]);
    }
  }
}

TEST(BindingPoints, TellTheirPlaces) {
  BindOptions options;
  options.mode = BindMode::continuous;
  const std::vector<CurvePair> rest{line({0.05, 0, 0}, {0.45, 0, 0}), line({0.55, 0, 0}, {0.95, 0, 0})};
  const Binding binding(rest, ring(), options);
  const BindingPoints points(binding);
  std::vector<BoundShare> found;
  for (std::size_t i = 0; i < binding.size(); ++i) {
    points.shares(i, found);
    const std::vector<Share> shares = binding.shares(i);
    ASSERT_EQ(found.size(), shares.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].pair, shares[k].pair);
      EXPECT_EQ(found[k].weight, shares[k].weight);
      EXPECT_EQ(found[k].record.t, shares[k].record.t);
      EXPECT_EQ(found[k].record.u, shares[k].record.u);
    }
  }
}

TEST(BindingPoints, RefuseBadInput) {
  const CurvePair pair = line({0, 0, 0}, {1, 0, 0});
  const std::vector<Vec3> some(3, Vec3(0.5, 0.1, 0));
  const BindingPoints points{Binding(pair, some)};
  using List = std::vector<std::uint32_t>;
  EXPECT_THROW(points.group(List{0, 1}, List{3}), InvalidInput);
  EXPECT_THROW(points.group(List{0, 2}, List{1}), InvalidInput);
  EXPECT_THROW(points.group(List{0, 2, 1, 2}, List{1, 1}), InvalidInput);
  EXPECT_THROW(points.group(List{}, List{}), InvalidInput);
  std::vector<BoundShare> out;
  EXPECT_THROW(points.shares(3, out), InvalidInput);
  EXPECT_THROW(points.group(List{0, 1}, List{1})->pose({}), InvalidInput);
  std::vector<Vec3> at(1);
  EXPECT_THROW(points.group(List{0, 1}, List{1})->place(0, at), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
