#include <gtest/gtest.h>

#include "contact/self/posed_sets.h"
#include "contact/surfaces/span_motion.h"
#include "leaf.h"

namespace tendril::contact {
namespace {

using test::Random;
using test::Shown;
using test::shown_of;
using test::stalks;

/// Loads on masses and frames do the work of forces on the points.
TEST(RodPoints, LoadsDoTheWorkOfForcesOnPoints) {
  Random random(3);
  const std::vector<Rod> rods = stalks();
  const test::Leaf leaf = test::leaf(1.0, 0.2, 20, 4);
  const contact::ContactSurface surface = test::surface_on(rods, leaf, 0.01);
  const RodPoints& points = *surface.points;
  std::vector<std::uint32_t> all(leaf.points.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  for (int round = 0; round < 10; ++round) {
    const Shown s = shown_of(rods, random, 0.02, 1.0);
    const auto pairs = points.pairs(s.view()), rates = points.rates(s.view());
    std::vector<Vec3> velocity(all.size()), forces;
    points.points().velocities(pairs, rates, all, velocity);
    double power = 0.0, scale = 0.0;
    for (const Vec3& v : velocity) {
      forces.push_back(random.in_cube(1.0));
      power += forces.back().dot(v);
      scale += v.norm();
    }
    std::vector<Vec3> force(s.p.size(), Vec3::Zero()), torque = force;
    points.add_loads(s.view(), points.points().pull_back(pairs, all, forces), {force, torque});
    for (std::size_t i = 0; i < force.size(); ++i) power -= force[i].dot(s.v[i]) + torque[i].dot(s.turn[i]);
    EXPECT_LT(std::abs(power), 1e-12 * scale);

    // And velocities are what differences of places say.
    const double h = 1e-5;
    std::vector<Vec3> there(all.size()), here(all.size());
    const auto moved = [&](double by) {
      std::vector<CurvePair> out;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto at = [&](Points u, Points rate) {
          std::vector<Vec3> x(u.begin(), u.end());
          for (std::size_t i = 0; i < x.size(); ++i) x[i] += by * rate[i];
          return x;
        };
        out.emplace_back(
            pairs[k].knots(), at(pairs[k].primary().control_points(), rates[k].primary().control_points()),
            at(pairs[k].orientation().control_points(), rates[k].orientation().control_points()));
      }
      return out;
    };
    points.points().place(moved(h), all, there);
    points.points().place(moved(-h), all, here);
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_LT((velocity[i] - (there[i] - here[i]) / (2 * h)).norm(), 2e-7 * (1.0 + velocity[i].norm()));
  }
}

/// Curve-pairs anyhow, and moved anyhow: no bound point moves farther.
TEST(SpanMotion, BoundsWhatPointsMove) {
  Random random(8);
  const KnotVector knots = KnotVector::uniform(3, 8);
  double closest = 0.0;
  for (int round = 0; round < 400; ++round) {
    const double by = std::pow(10.0, random.uniform(-4.0, -0.5));
    const auto pair = [&](double shake, const CurvePair* from) {
      std::vector<Vec3> u, v;
      for (int i = 0; i < 8; ++i) {
        const auto k = static_cast<std::size_t>(i);
        u.push_back((from ? from->primary().control_points()[k] : Vec3(i, 0, 0)) + random.in_cube(shake));
        v.push_back((from ? from->orientation().control_points()[k] : Vec3(i, 0, 1)) + random.in_cube(shake));
      }
      return CurvePair(knots, u, v);
    };
    const CurvePair before = pair(0.15, nullptr), now = pair(by, &before);
    Placement still, placed;
    placed.position = random.in_cube(by);
    placed.rotation = Eigen::AngleAxisd(by, random.in_cube(1.0).normalized()).toRotationMatrix();
    UsedSpan span(0, knots, 3 + round % 5);
    span.reach = 0.8;
    const double bound = motion(span, shape_of(span, before), {before, still}, {now, placed});
    ASSERT_TRUE(bound < 1e9 || round > 0);
    for (int point = 0; point < 20; ++point) {
      const double start = knots.knots()[static_cast<std::size_t>(3 + round % 5)];
      const AxialPoint at{start + random.uniform(0.0, 0.2), random.uniform(-0.4, 0.4),
                          random.uniform(-0.4, 0.4), 0.0};
      const double moved =
          (placed.to_local(from_axial(now, at)) - still.to_local(from_axial(before, at))).norm();
      EXPECT_LE(moved, bound);
      if (bound > 0.0) closest = std::max(closest, moved / bound);
    }
  }
  std::cout << "a point moved " << closest << " of its bound\n";
  EXPECT_GT(closest, 0.02);
}

/// Curve-pairs that go anywhere, turning up to half a radian, and are a bit beside their way: no bound point
/// is farther from the straight way between its two ends. Exactly on their way, no farther than they stray by
/// turning, by the square of how far they turn.
TEST(SpanMotion, BoundsHowFarPointsAreFromTheirWay) {
  Random random(10);
  const KnotVector knots = KnotVector::uniform(3, 8);
  double beside = 0.0, on_it = 0.0;
  for (int round = 0; round < 600; ++round) {
    const double by = std::pow(10.0, random.uniform(-3.0, -0.3)), off = round % 2 == 0 ? 0.02 * by : 0.0;
    const Mat3 turned = Eigen::AngleAxisd(by, random.in_cube(1.0).normalized()).toRotationMatrix();
    std::vector<Vec3> u, v, u_after, v_after, u_now, v_now;
    const double share = random.uniform(0.0, 1.0);
    for (int i = 0; i < 8; ++i) {
      u.push_back(Vec3(i, 0, 0) + random.in_cube(0.1));
      v.push_back(u.back() + Vec3(0, 0, 1) + random.in_cube(0.1));
      u_after.push_back(turned * u.back() + random.in_cube(0.1 * by));
      v_after.push_back(turned * v.back() + random.in_cube(0.1 * by));
      u_now.push_back((1.0 - share) * u.back() + share * u_after.back() + random.in_cube(off));
      v_now.push_back((1.0 - share) * v.back() + share * v_after.back() + random.in_cube(off));
    }
    const CurvePair from(knots, u, v), to(knots, u_after, v_after), now(knots, u_now, v_now);
    UsedSpan span(0, knots, 3 + round % 5);
    span.reach = 0.8;
    const SpanWay way = way_of(span, from, to);
    const double bound = motion(span, way, share, now);
    const double start = knots.knots()[static_cast<std::size_t>(3 + round % 5)];
    for (int point = 0; point < 20; ++point) {
      const AxialPoint at{start + random.uniform(0.0, 0.2), random.uniform(-0.4, 0.4),
                          random.uniform(-0.4, 0.4), 0.0};
      const Vec3 taken = (1.0 - share) * from_axial(from, at) + share * from_axial(to, at);
      const double is = (from_axial(now, at) - taken).norm();
      EXPECT_LE(is, bound);
      double& closest = off > 0.0 ? beside : on_it;
      if (bound < 1e9) closest = std::max(closest, is / bound);
    }
    EXPECT_LE(motion(span, way, 0.0, from), 1e-10);
    EXPECT_LE(motion(span, way, 1.0, to), 1e-10);
    if (off == 0.0 && by < 0.1) EXPECT_LE(bound, 30.0 * by * by);
  }
  std::cout << "a point was " << beside << " of the bound from its way, " << on_it << " on it\n";
  EXPECT_GT(beside, 0.05);
  EXPECT_GT(on_it, 0.02);
}

/// Masses and directors anyhow, and moved anyhow, most of it or all of it together: nor by what bounds say
/// that know the masses alone, or the curves.
TEST(SpanMotion, BoundsWhatRodsMove) {
  Random random(9);
  const Rod rod = test::straight_rod(7, 1e6, 0.01);
  const RodCurves curves(std::span(&rod, 1));
  const KnotVector& knots = curves.knots(0);
  const auto interpolation = curves.interpolation(0);
  double closest = 0.0, carried = 0.0;
  for (int round = 0; round < 400; ++round) {
    const double by = std::pow(10.0, random.uniform(-4.0, -1.0));
    const double apart = round % 2 == 0 ? 0.1 * by : 0.0;
    const Vec3 way = random.in_cube(by);
    const Mat3 turned = Eigen::AngleAxisd(by, random.in_cube(1.0).normalized()).toRotationMatrix();
    std::vector<Vec3> p, q, r, s;
    RodMotion most;
    MassMotions masses;
    for (std::size_t i = 0; i < 8; ++i) {
      p.push_back(rod.p[i] + random.in_cube(0.01));
      q.push_back(p.back() + rod.q[i] - rod.p[i] + random.in_cube(0.01));
      r.push_back(turned * p[i] + way + random.in_cube(apart));
      s.push_back(r[i] + turned * (q[i] - p[i]) + random.in_cube(apart));
      most.mass = std::max(most.mass, (r[i] - p[i]).norm());
      most.arm = std::max(most.arm, (s[i] - r[i] - q[i] + p[i]).norm());
      masses.mass.push_back((r[i] - p[i]).norm());
      masses.arm.push_back((s[i] - r[i] - q[i] + p[i]).norm());
      if (i > 0) masses.edge.push_back((r[i] - r[i - 1] - p[i] + p[i - 1]).norm());
      if (i > 0) most.edge = std::max(most.edge, masses.edge.back());
    }
    masses.edge.push_back(0.0);
    const CurvePair before = curves.through(0, p, q), now = curves.through(0, r, s);
    const int index = knots.degree() + round % 5;
    const int part = round % 3;
    UsedSpan span(0, knots, index, part, 3);
    span.reach = 0.1;
    const double coarse = motion(gain_of(span, interpolation), span.reach, shape_of(span, before), most);
    const double local =
        motion(local_gain_of(span, interpolation), span, shape_of(span, before), most, masses);
    const double fine = motion(span, way_of(span, before, before), 0.0, now);  // one that stays
    EXPECT_LE(local, coarse * (1.0 + 1e-6));
    const double begin = knots.knots()[static_cast<std::size_t>(index)];
    const double third = (knots.knots()[static_cast<std::size_t>(index + 1)] - begin) / 3.0;
    const double from = begin + part * third, to = from + third;
    for (int point = 0; point < 20; ++point) {
      const AxialPoint at{random.uniform(from, to), random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                          0.0};
      const double moved = (from_axial(now, at) - from_axial(before, at)).norm();
      EXPECT_LE(moved, local);
      EXPECT_LE(moved, fine);
      closest = std::max(closest, moved / local);
      carried = std::max(carried, moved / fine);
    }
  }
  std::cout << "a point moved " << closest << " of the bound by masses, " << carried << " of the other\n";
  EXPECT_GT(closest, 0.05);
  EXPECT_GT(carried, 0.2);
}

/// What sets have between them along a direction, by all their vertices in double precision.
double apart(const VertexSets& sets, const std::vector<Vec3>& at, std::size_t p, std::size_t q,
             const Direction& n) {
  const auto least = [&](std::size_t set, double sign) {
    double most = std::numeric_limits<double>::infinity();
    for (std::size_t i = sets.begin[set]; i < sets.begin[set + 1]; ++i) {
      const Vec3& x = at[sets.vertices[i]];
      most = std::min(most, sign * (static_cast<double>(n[0]) * x.x() + static_cast<double>(n[1]) * x.y() +
                                    static_cast<double>(n[2]) * x.z()));
    }
    return most;
  };
  return least(p, 1.0) + least(q, -1.0);
}

/// Single precision says less than double does, but not much less: of a set's size, wherever both are.
TEST(PosedSets, AreNoFartherApartThanTheirVertices) {
  Random random(8);
  VertexSets sets;
  for (std::uint32_t set = 0, first = 0; set < 6; ++set) {
    std::vector<std::uint32_t> of(1 + 9 * set);
    for (std::uint32_t& v : of) v = first++;
    sets.add(of);
  }
  double most = 0.0;
  for (int round = 0; round < 200; ++round) {
    const Vec3 where = random.in_cube(round % 2 == 0 ? 1.0 : 1e3);
    std::vector<Vec3> at, after;
    for (std::size_t i = 0; i < sets.vertices.back() + 1; ++i) {
      at.push_back(where + random.in_cube());
      after.push_back(at.back() + random.in_cube(0.1));
    }
    PosedSets posed(sets, at, after);
    posed.take(0, sets.size());
    const Vec3 way = random.in_cube().normalized();
    const Direction n{static_cast<float>(way.x()), static_cast<float>(way.y()), static_cast<float>(way.z())};
    for (std::size_t p = 0; p < sets.size(); ++p)
      for (std::size_t q = 0; q < sets.size(); ++q) {
        const std::array<double, 2> truly{apart(sets, at, p, q, n), apart(sets, after, p, q, n)};
        for (std::size_t end = 0; end < 2; ++end) {
          const PosedSets::Along said = posed.along(p, q, n, end);
          EXPECT_LE(said.apart, truly[end]);
          most = std::max(most, truly[end] - said.apart);
          EXPECT_NEAR(said.way.dot(way), truly[end], 1e-5);
        }
        const double least = std::min(truly[0], truly[1]);
        EXPECT_FALSE(posed.part(p, q, n, least));
        EXPECT_TRUE(posed.part(p, q, n, least - 1e-4));
      }
  }
  EXPECT_LT(most, 5e-5);
  std::cout << "at most " << most << " too little, of sets of size 3\n";
}

TEST(PosedSets, ArePartedByNothingWhereSinglePrecisionEnds) {
  VertexSets sets;
  sets.add({0, 1});
  sets.add({2, 3});
  for (const double size : {1e20, 1e36, 1e60, 1e140}) {
    const std::vector<Vec3> at{Vec3::Zero(), Vec3(size, 0, 0), Vec3(0, 0, -size), Vec3(size, 0, -size)};
    PosedSets posed(sets, at, at);
    posed.take(0, 2);
    const Direction up{0.0F, 0.0F, 1.0F};
    EXPECT_EQ(posed.part(0, 1, up, 0.5 * size), size < 1e30);
    EXPECT_EQ(posed.along(0, 1, up, 0).apart > 0.0, size < 1e30);
  }
}

}  // namespace
}  // namespace tendril::contact
