#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/bindingf.h>

#include "bind/unit_missing.h"
#include "place/sweep.h"
#include "support/pairs.h"
#include "support/random.h"

namespace tendril::bind {
namespace {

/// A curve-pair of any degree on knots with gaps of all sizes, and a pose of it.
struct Case {
  std::vector<CurvePair> rest, posed;
  std::vector<Vec3> points;
};

CurvePair wavy(const KnotVector& knots, double wave, test::Random& random) {
  std::vector<Vec3> u, v;
  for (int i = 0; i < knots.control_points(); ++i) {
    u.push_back(Vec3(i, wave * std::sin(0.9 * i), wave * std::cos(0.7 * i)) + random.in_cube(0.1));
    v.push_back(u.back() + Vec3(0.1 * std::sin(i), std::cos(0.2 * i), std::sin(0.2 * i)));
  }
  return {knots, u, v};
}

KnotVector uneven(int degree, int spans, test::Random& random) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, -2.0);
  for (int i = 1; i < spans; ++i) knots.push_back(knots.back() + random.uniform(0.1, 2));
  if (degree > 1 && spans > 3) knots.push_back(knots.back());
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, knots.back() + 0.7);
  return {degree, knots};
}

Case make_case(int degree, int count) {
  test::Random random(static_cast<std::uint64_t>(degree));
  const KnotVector knots = uneven(degree, 7, random);
  Case c{{wavy(knots, 0.3, random)}, {wavy(knots, 1.5, random)}, {}};
  for (int i = 0; i < count; ++i)
    c.points.push_back(Vec3(random.uniform(-1, knots.control_points()), 0, 0) + random.in_cube(1));
  return c;
}

template <class T>
struct Arrays {
  std::vector<T> x, y, z;
  explicit Arrays(std::size_t n) : x(n), y(n), z(n) {}
  Columns<T> columns() { return {x, y, z}; }
};

class EveryDegree : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, EveryDegree, testing::Range(1, kMaxDegree + 1));

TEST_P(EveryDegree, IsTheAxialMapInEveryForm) {
  const Case c = make_case(GetParam(), 4000);
  const Binding binding(c.rest[0], c.points);
  EXPECT_LT(binding.report().rest_error, 1e-14);
  std::vector<Vec3> rows(c.points.size()), some(3);
  binding.update(c.posed[0], rows);
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_LT((rows[i] - from_axial(c.posed[0], binding.records()[i])).norm(), 1e-13) << i;
  Arrays<double> sorted(rows.size());
  binding.update(c.posed, sorted.columns());
  std::vector<int> seen(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::uint32_t i = binding.order()[k];
    ++seen[i];
    EXPECT_EQ(rows[i], Vec3(sorted.x[k], sorted.y[k], sorted.z[k]));
    if (k > 0)
      EXPECT_LE(c.rest[0].knots().span(binding.records()[binding.order()[k - 1]].t),
                c.rest[0].knots().span(binding.records()[i].t));
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ssize(seen));
  const std::vector<std::uint32_t> which{5, 3999, 0};
  binding.at(c.posed, which, some);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(some[k], rows[which[k]]);
}

TEST_P(EveryDegree, SinglePrecisionIsTheSameMapRounded) {
  const Case c = make_case(GetParam(), 4000);
  const Binding binding(c.rest[0], c.points);
  const Bindingf single(binding);
  std::vector<Eigen::Vector3f> rest(c.points.size()), rows = rest, again = rest;
  std::vector<Vec3> expected(c.points.size());
  single.update(c.rest, rest);
  single.update(c.posed, rows);
  single.update(c.posed, again, 3);
  binding.update(c.posed, expected);
  EXPECT_EQ(rows, again);
  Arrays<float> sorted(rows.size());
  single.update(c.posed, sorted.columns(), 2);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::uint32_t i = binding.order()[k];
    EXPECT_LT((rest[i].cast<double>() - c.points[i]).norm(), 1e-6 * 15);
    EXPECT_LT((rows[i].cast<double>() - expected[i]).norm(), 3e-5) << i;
    EXPECT_EQ(rows[i], Eigen::Vector3f(sorted.x[k], sorted.y[k], sorted.z[k]));
    EXPECT_EQ(rows[i], single.at(c.posed, i));
  }
}

/// Frames that fail for some points and hold for their neighbours.
TEST(Update, LeavesPointsWithoutFrameToTheRulesOfTheCurvePair) {
  Case c = make_case(3, 3000);
  std::vector<Vec3> u(c.posed[0].primary().control_points().begin(),
                      c.posed[0].primary().control_points().end());
  std::vector<Vec3> v(c.posed[0].orientation().control_points().begin(),
                      c.posed[0].orientation().control_points().end());
  for (std::size_t i = 2; i < 6; ++i) v[i] = u[i];         // no offset
  for (std::size_t i = 7; i < u.size(); ++i) u[i] = u[7];  // no speed
  const std::vector<CurvePair> posed{CurvePair(c.posed[0].knots(), u, v)};
  const Binding binding(c.rest[0], c.points);
  const Bindingf single(binding);
  std::vector<Vec3> rows(c.points.size());
  std::vector<Eigen::Vector3f> rows_f(c.points.size());
  binding.update(posed, rows, 3);
  single.update(posed, rows_f, 3);
  std::size_t without = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const AxialPoint& at = binding.records()[i];
    EXPECT_LT((rows[i] - from_axial(posed[0], at)).norm(), 1e-6) << i;
    EXPECT_LT((rows_f[i].cast<double>() - rows[i]).norm(), 1e-3) << i;
    EXPECT_EQ(rows[i], binding.at(posed, i));
    EXPECT_EQ(rows_f[i], single.at(posed, i));
    without += posed[0].frame(at.t).status != FrameStatus::ok;
  }
  EXPECT_GT(without, 300u);
  EXPECT_LT(without, 2700u);
}

template <class T>
void expect_same_bits(int degree, bool off, VectorUnit unit) {
  const Case c = make_case(degree, 1);
  test::Random random(7);
  for (const int span : c.posed[0].knots().nonempty_spans()) {
    const Piece<T> piece = pose<T>(make_span(0, c.posed[0].knots(), span), c.posed[0]);
    Records<T> records(203);
    for (auto* column : {&records.s, &records.u, &records.v, &records.w})
      for (T& value : *column) value = static_cast<T>(random.uniform(-0.5, 0.5));
    Arrays<T> plain(203), wide(203);
    const auto view = [](Arrays<T>& a) { return ColumnsView<T>{a.x.data(), a.y.data(), a.z.data()}; };
    sweep_on(VectorUnit::plain, piece, off, records.from(0), view(plain), 203);
    sweep_on(unit, piece, off, records.from(0), view(wide), 203);
    EXPECT_EQ(plain.x, wide.x);
    EXPECT_EQ(plain.y, wide.y);
    EXPECT_EQ(plain.z, wide.z);
    for (std::size_t i = 0; i < 203; i += 10)
      EXPECT_EQ(evaluate_one(piece, off, records.from(i)).point.y, plain.y[i]);
  }
}

class EveryVectorUnit : public testing::TestWithParam<VectorUnit> {};
INSTANTIATE_TEST_SUITE_P(Update, EveryVectorUnit,
                         testing::Values(VectorUnit::bits_256, VectorUnit::bits_512));

TEST_P(EveryVectorUnit, GivesTheBitsOfThePlainLoop) {
  if (GetParam() > widest_unit()) GTEST_SKIP() << unit_missing(GetParam());
  for (const int degree : {1, 2, 3, 4, 5})
    for (const bool off : {false, true}) {
      expect_same_bits<double>(degree, off, GetParam());
      expect_same_bits<float>(degree, off, GetParam());
    }
}

std::vector<Vec3> scaled(Points from, double size) {
  std::vector<Vec3> to;
  for (const Vec3& p : from) to.push_back(size * p);
  return to;
}
CurvePair scaled(const CurvePair& from, double size) {
  return {from.knots(), scaled(from.primary().control_points(), size),
          scaled(from.orientation().control_points(), size)};
}

TEST(Update, KeepsAnySizeAndPlace) {
  const Case c = make_case(3, 500);
  for (const double size : {1e-120, 1e-20, 1e20, 1e120}) {
    const Binding binding(scaled(c.rest[0], size), scaled(c.points, size));
    std::vector<Vec3> rows(c.points.size()), expected(c.points.size());
    binding.update(scaled(c.posed[0], size), rows);
    Binding(c.rest[0], c.points).update(c.posed[0], expected);
    EXPECT_LT(binding.report().rest_error, 1e-14 * size) << size;
    for (std::size_t i = 0; i < rows.size(); ++i)
      EXPECT_LT((rows[i] / size - expected[i]).norm(), 1e-9) << size;
  }
}

/// Beside such a curve the offsets are nothing. Single precision: squares overflow from some size on.
TEST(Update, FollowsPosesAsLargeAsNumbersGo) {
  const Case c = make_case(3, 500);
  const Binding binding(c.rest[0], c.points);
  const Bindingf single(binding);
  const auto at = [&](std::size_t i) { return c.posed[0].primary().value(binding.records()[i].t); };
  const CurvePair large = scaled(c.posed[0], 1e150);
  std::vector<Vec3> rows(c.points.size());
  binding.update(large, rows);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_LT((rows[i] / 1e150 - at(i)).norm(), 1e-12) << i;
  std::vector<Eigen::Vector3f> rowsf(c.points.size());
  for (const double size : {1e17, 1e18, 1e19, 1e20, 1e22}) {
    const CurvePair posed = scaled(c.posed[0], size);
    single.update({&posed, 1}, rowsf);
    for (std::size_t i = 0; i < rowsf.size(); ++i)
      EXPECT_LT((rowsf[i].cast<double>() / size - at(i)).norm(), 1e-4) << size << " " << i;
  }
}

TEST(Update, RefusesColumnsOfAnotherLength) {
  const Case c = make_case(3, 10);
  const Binding binding(c.rest[0], c.points);
  Arrays<double> out(10);
  out.y.resize(9);
  EXPECT_THROW(binding.update(c.posed, out.columns()), InvalidInput);
  std::vector<Vec3> some(1);
  const std::vector<std::uint32_t> none{10};
  EXPECT_THROW(binding.at(c.posed, none, some), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
