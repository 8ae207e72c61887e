#include <gtest/gtest.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/dynamics/simulation.h>

#include "support/rods.h"

namespace tendril {
namespace {

/// Fixed forces on all control points of all rods' curves: minus their work is their energy.
struct OnCurves : Force {
  OnCurves(std::span<const Rod> rods, int degree, bool with_twist) : curves(rods, degree), twist(with_twist) {
    test::Random random(static_cast<std::uint64_t>(degree));
    for (const Rod& rod : rods) {
      ControlForces one;
      for (std::size_t i = 0; i < rod.p.size(); ++i) {
        one.primary.push_back(random.in_cube());
        one.orientation.push_back(random.in_cube());
      }
      forces.push_back(one);
    }
  }
  void add(const StateView& state, const Loads& loads) const override {
    for (std::size_t r = 0; r < curves.size(); ++r) curves.add_loads(state, r, forces[r], loads);
  }
  Couplings couplings(std::span<const NodeRange> rods) const override {
    std::size_t longest = 0;
    for (const NodeRange& rod : rods) longest = std::max(longest, rod.count);
    return Couplings::within(longest);
  }
  bool depends_on_time() const override { return false; }
  bool twists() const override { return twist; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override {
    double work = 0.0;
    for (std::size_t r = 0; r < curves.size(); ++r) {
      const CurvePair pair = curves.pair(state, r);
      for (std::size_t i = 0; i < forces[r].primary.size(); ++i)
        work += forces[r].primary[i].dot(pair.primary().control_points()[i]) +
                forces[r].orientation[i].dot(pair.orientation().control_points()[i]);
    }
    return -work;
  }
  RodCurves curves;
  std::vector<ControlForces> forces;
  bool twist;
};

/// Three rods, one of them with fewer masses than the higher degrees need.
std::vector<Rod> rods() {
  test::Random random(11);
  std::vector<Rod> all{test::uneven_rod(random, 9), test::uneven_rod(random, 4), test::uneven_rod(random, 7)};
  return all;
}

TEST(RodCurves, TakeForcesToLoadsOfTheSameWork) {
  for (int degree = 1; degree <= 5; ++degree) {
    SCOPED_TRACE(degree);
    Scene scene;
    scene.rods = rods();
    const OnCurves force(scene.rods, degree, true);
    const System system(scene);
    test::Random random(4);
    const State state = test::stirred(system, random, 0.1);
    const auto work = system.make_workspace();
    const std::vector<Frame> frames = system.frames(state, *work);
    std::vector<Vec3> p, t, m;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      p.push_back(test::at(state.y, i));
      t.push_back(frames[i].z);
      m.push_back(frames[i].y);
    }
    const std::vector<Vec3> v(p.size(), Vec3::Zero());
    const std::vector<double> none(p.size(), 0.0), one(p.size(), 1.0);
    const StateView view{0.0, p, v, t, none, one, none, system.rods(), m};
    const ForceCheck found = check_force(force, view);
    std::printf("degree %d: virtual work off by %.1e of the largest load\n", degree, found.energy);
    EXPECT_LT(found.energy, 1e-8);
    EXPECT_TRUE(found.undeclared.empty());

    // The same curves by the state, with directors the force sees.
    const std::vector<CurvePair> pairs = force.curves.pairs(system, state, *work);
    ASSERT_EQ(pairs.size(), 3u);
    for (std::size_t r = 0; r < pairs.size(); ++r) {
      const CurvePair seen = force.curves.pair(view, r);
      EXPECT_EQ(seen.knots().degree(), std::min<int>(degree, static_cast<int>(system.rods()[r].count) - 1));
      for (const double at : {0.0, 0.3, 1.0}) {
        EXPECT_LT((seen.primary().value(at) - pairs[r].primary().value(at)).norm(), 1e-12);
        EXPECT_LT((seen.orientation().value(at) - pairs[r].orientation().value(at)).norm(), 1e-12);
      }
    }
  }
}

/// With and without twist state, the curves pass through the masses of each rod.
TEST(RodCurves, PassThroughTheMasses) {
  for (const bool twist : {false, true})
    for (int degree = 1; degree <= 5; ++degree) {
      Scene scene;
      scene.rods = {test::straight_rod(6, 1e5, 0.02), test::straight_rod(3, 1e5, 0.02)};
      if (twist) scene.twist = Scene::Twist::everywhere;
      const System system(scene);
      ASSERT_EQ(system.twist_count() > 0, twist);
      test::Random random(8);
      const State state = test::stirred(system, random, 0.05);
      const auto work = system.make_workspace();
      const std::vector<Vec3> q = system.orientation_masses(state, *work);
      const RodCurves curves(system, degree);
      const std::vector<CurvePair> pairs = curves.pairs(system, state, *work);
      for (std::size_t r = 0; r < 2; ++r)
        for (std::size_t i = 0; i < system.rods()[r].count; ++i) {
          const std::size_t node = system.rods()[r].first + i;
          const double at = curves.parameters(r)[i];
          EXPECT_LT((pairs[r].primary().value(at) - test::at(state.y, node)).norm(), 1e-12);
          EXPECT_LT((pairs[r].orientation().value(at) - q[node]).norm(), 1e-12);
        }
    }
}

TEST(RodCurves, KeepTheEnergyOfARunWhoseForcesGoThroughThem) {
  Scene scene;
  scene.rods = {test::straight_rod(6, 1e5, 0.02), test::straight_rod(3, 1e5, 0.02)};
  scene.anchors = {{.rod = 0, .node = 0}, {.rod = 1, .node = 0}};
  scene.forces = {std::make_shared<OnCurves>(scene.rods, 3, true)};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-7});
  const Report report = simulation.run(0.1);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_LT(std::abs(report.imbalance), 1e-6);
}

TEST(RodCurves, RefuseForcesThatSeeNoDirectors) {
  Scene scene;
  scene.rods = {test::straight_rod(6, 1e5, 0.02)};
  scene.forces = {std::make_shared<OnCurves>(scene.rods, 3, false)};
  const System system(scene);
  ASSERT_EQ(system.twist_count(), 0u);
  try {
    Simulation simulation(system, system.rest_state());
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.place(), "rods[0]");
  }
}

TEST(RodCurves, RefuseWhatNoCurvePassesThrough) {
  std::vector<Rod> all = rods();
  EXPECT_THROW(RodCurves(all, 0), InvalidInput);
  EXPECT_THROW(RodCurves(all, 6), InvalidInput);
  all[1].q.pop_back();
  EXPECT_THROW(RodCurves{all}, InvalidInput);
  const RodCurves curves(rods());
  EXPECT_THROW(curves.parameters(3), std::out_of_range);
}

}  // namespace
}  // namespace tendril
