#include <gtest/gtest.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/scene/scene_run.h>

#include <cmath>

namespace tendril::test {
namespace {

using scene::SceneError;
using scene::SceneFile;

/// A scene of one rod along x from 0 to 1, 11 masses, round, with what else it says.
std::string one_rod(const std::string& rod, const std::string& scene) {
  return R"({"version": 1, "curve_pairs": [{"name": "rod", "points": [[0,0,0],[1,0,0]], "nodes": 11,
    "orientation": [0,0,1], "material": {"young": 1e6, "poisson": 0.3, "density": 1000},
    "section": {"type": "circular", "radius": 0.02})" +
         rod + "}]" + scene + R"(, "simulation": {"duration": 1, "tolerance": 1e-6, "frames": 2}})";
}

SceneFile parsed(const std::string& rod, const std::string& scene) {
  return scene::parse_scene(one_rod(rod, scene), "s.json");
}

/// What the reader or the run refuses the scene with.
std::string refusal(const std::string& rod, const std::string& scene) {
  try {
    scene::SceneRun run(parsed(rod, scene));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

Energies energies_of(const System& system, const State& state) {
  const auto work = system.make_workspace();
  return system.energies(state, *work);
}

/// A spin about a swivel's axis is the swivel's own; the tangent, across it, has no part in that.
TEST(SceneStart, ASpinTurnsASwivelAboutItsAxis) {
  const SceneFile file = parsed(R"(, "anchors": [{"node": 0, "swivel": [0, 0, -3]}])",
                                R"(, "start": {"motions": [{"spin": [5, 0, 2], "about": [0, 0, 0]}]})");
  const State state = scene::start_state(file, scene::make_system(file));
  EXPECT_EQ(state.y[7 * 11], -2.0);
  EXPECT_EQ(state.y[7 * 11 + 1], 5.0);
}

TEST(SceneStart, AVelocityAndASpinAreThoseOfARigidBody) {
  const SceneFile file =
      parsed("", R"(, "start": {"motions": [{"velocity": [0.3, 0, -0.2], "spin": [0, 0, 2]}]})");
  const System system = scene::make_system(file);
  const State state = scene::start_state(file, system);
  double mass = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < 11; ++i) {
    const double m = file.scene.rods[0].mass[i], x = 0.1 * static_cast<double>(i) - 0.5;
    mass += m, moment += m * x * x;
  }
  // 1/2 m v^2 + 1/2 I w^2: a straight rod has no inertia across its tangents but its masses'.
  const double expected = 0.5 * mass * (0.09 + 0.04) + 0.5 * moment * 4.0;
  EXPECT_NEAR(energies_of(system, state).kinetic / expected, 1.0, 1e-12);

  scene::SceneRun run{SceneFile(file)};
  ASSERT_EQ(run.run().stop, Stop::finished);
  const auto end = run.snapshot();
  // A second later the middle is where the velocity takes it, turned by two radians: less what it lags since
  // it stretches, by rho w^2 L^2 / 8 E = 5e-4 at the middle.
  EXPECT_LT((end.masses[0][5] - Vec3(0.5 + 0.3, 0, -0.2)).norm(), 1e-5);
  const Vec3 along = (end.masses[0][10] - end.masses[0][0]).normalized();
  EXPECT_LT(along.cross(Vec3(std::cos(2.0), std::sin(2.0), 0)).norm(), 2e-3);
}

TEST(SceneStart, ASpinAboutItselfTurnsARodsFrames) {
  const SceneFile file = parsed("", R"(, "start": {"motions": [{"spin": [3, 0, 0]}]})");
  const System system = scene::make_system(file);
  double inertia = 0.0;
  for (const double i : file.scene.rods[0].inertia) inertia += i;
  EXPECT_NEAR(energies_of(system, scene::start_state(file, system)).kinetic / (0.5 * inertia * 9.0), 1.0,
              1e-12);
  scene::SceneRun run{SceneFile(file)};
  ASSERT_EQ(run.run().stop, Stop::finished);
  const auto end = run.snapshot();
  const Vec3 side = (end.orientation[0][4] - end.masses[0][4]).normalized();
  // z turns by three radians about x.
  EXPECT_LT((side - Vec3(0, -std::sin(3.0), std::cos(3.0))).norm(), 1e-6);
}

TEST(SceneStart, AboutAPointAndOfNamedRodsAlone) {
  const SceneFile file = scene::parse_scene(
      R"({"version": 1, "curve_pairs": [
        {"name": "a", "points": [[0,0,0],[1,0,0]], "nodes": 3, "orientation": [0,0,1],
         "springs": {"stretch": 10, "bend_l": 1, "bend_m": 1, "twist": 1, "mass": 1, "inertia": 1}},
        {"name": "b", "points": [[0,1,0],[1,1,0]], "nodes": 3, "orientation": [0,0,1],
         "springs": {"stretch": 10, "bend_l": 1, "bend_m": 1, "twist": 1, "mass": 1, "inertia": 1}}],
        "start": {"motions": [{"curve_pairs": ["b"], "spin": [0, 0, 1], "about": [0, 0, 0]}]},
        "simulation": {"duration": 1}})",
      "s.json");
  const State state = scene::start_state(file, scene::make_system(file));
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_EQ(Vec3(state.y.segment<3>(18 + 3 * i)), Vec3::Zero());
    const double x = 0.5 * static_cast<double>(i);
    EXPECT_LT((state.y.segment<3>(18 + 9 + 3 * i) - Vec3(-1, x, 0)).norm(), 1e-15);
  }
}

TEST(SceneStart, FromTheEquilibriumNothingMoves) {
  const std::string gravity = R"(, "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}])";
  const std::string clamp = R"(, "anchors": [{"node": 0}])";
  scene::SceneRun run(parsed(clamp, gravity + R"(, "start": {"from": "equilibrium"})"));
  const auto start = run.snapshot();
  EXPECT_LT(start.masses[0][10].z(), -0.1);  // it hangs
  ASSERT_EQ(run.run().stop, Stop::finished);
  const auto end = run.snapshot();
  for (std::size_t i = 0; i < 11; ++i) EXPECT_LT((end.masses[0][i] - start.masses[0][i]).norm(), 1e-6);
  // What nothing holds has none.
  const std::string reason = refusal("", gravity + R"(, "start": {"from": "equilibrium"})");
  EXPECT_NE(reason.find("#/start"), std::string::npos) << reason;
  EXPECT_NE(reason.find("no equilibrium to start from"), std::string::npos) << reason;
}

TEST(SceneStart, WhatIsHeldMovesAsItsAnchorSays) {
  const SceneFile file =
      parsed(R"(, "anchors": [{"node": 0}])", R"(, "start": {"motions": [{"velocity": [0, 1, 0]}]})");
  const System system = scene::make_system(file);
  const State state = scene::start_state(file, system);
  EXPECT_EQ(Vec3(state.y.segment<3>(33)), Vec3::Zero());
  EXPECT_EQ(Vec3(state.y.segment<3>(36)), Vec3(0, 1, 0));
}

TEST(SceneMasses, AreAddedToTheirNodes) {
  const SceneFile plain = parsed("", "");
  const SceneFile file =
      parsed(R"(, "masses": [{"node": -1, "mass": 0.25, "inertia": 0.01}, {"node": 3, "mass": 2}])", "");
  const Rod &rod = file.scene.rods[0], &bare = plain.scene.rods[0];
  for (std::size_t i = 0; i < 11; ++i) {
    EXPECT_EQ(rod.mass[i], bare.mass[i] + (i == 10 ? 0.25 : i == 3 ? 2.0 : 0.0));
    EXPECT_EQ(rod.inertia[i], bare.inertia[i] + (i == 10 ? 0.01 : 0.0));
  }
}

TEST(SceneTables, PassThroughTheirRowsSmoothlyAndRestAtBothEnds) {
  // 3 t^2 - 2 t^3 is at rest at 0 and 1: the spline through its values, however spaced, is itself.
  const auto f = [](double t) { return t * t * (3 - 2 * t); };
  std::string rows, turns;
  for (const double t : {0.0, 0.2, 0.3, 0.7, 1.0}) {
    const std::string comma = t > 0 ? ", " : "", at = std::to_string(t), value = std::to_string(f(t));
    rows += comma + "[" + at + ", " + value + ", 0, 0]";
    turns += comma + "[" + at + ", " + value + "]";
  }
  const SceneFile file = parsed(R"(, "anchors": [{"node": 0, "translation": {"table": [)" + rows +
                                    R"(]}, "rotation": {"axis": [0, 0, 1], "table": [)" + turns + "]}}]",
                                "");
  const Anchor& anchor = file.scene.anchors.at(0);
  EXPECT_NEAR(anchor.period, 0.2, 1e-12);
  for (double t = -0.5; t < 1.5; t += 0.0625) {
    const double s = std::clamp(t, 0.0, 1.0);
    const AnchorPose pose = anchor.motion(t);
    EXPECT_NEAR(pose.position.x(), f(s), 1e-12);
    EXPECT_NEAR(pose.velocity.x(), 6 * s * (1 - s), 1e-11);
    EXPECT_NEAR(pose.angular_velocity.z(), 6 * s * (1 - s), 1e-11);
    EXPECT_LT((pose.frame.z - Vec3(std::cos(f(s)), std::sin(f(s)), 0)).norm(), 1e-12);
  }
}

TEST(SceneTables, OfAnyRowsHaveTheirDerivativeAsVelocity) {
  const SceneFile file = parsed(R"(, "anchors": [{"node": 0, "translation": {"table":
      [[0, 0, 0, 0], [0.4, 1, -1, 2], [0.5, 0, 3, 1], [2, 1, 1, 1]]}}])",
                                "");
  const auto& motion = file.scene.anchors.at(0).motion;
  EXPECT_LT((motion(0.4).position - Vec3(1, -1, 2)).norm(), 1e-14);
  EXPECT_LT((motion(0.5).position - Vec3(0, 3, 1)).norm(), 1e-14);
  const double h = 1e-6;
  for (double t = 0.01; t < 2.1; t += 0.037) {
    const Vec3 rate = (motion(t + h).position - motion(t - h).position) / (2 * h);
    EXPECT_LT((motion(t).velocity - rate).norm(), 1e-7 * (1 + rate.norm()));
  }
  // The acceleration does not jump at a row.
  const auto slope = [&](double t, double side) {
    return Vec3((motion(t + side * 1e-7).velocity - motion(t).velocity) / (side * 1e-7));
  };
  for (const double t : {0.4, 0.5}) EXPECT_LT((slope(t, 1) - slope(t, -1)).norm(), 1e-3 * slope(t, 1).norm());
}

TEST(SceneStart, RefusesWhatMakesNoSense) {
  const std::vector<std::array<std::string, 3>> cases{
      {"", R"(, "start": {"motions": [{"about": [0,0,0]}]})", "velocity or spin"},
      {"", R"(, "start": {"motions": [{"velocity": [0,0,1], "about": [0,0,0]}]})", "#/start/motions/0/about"},
      {"", R"(, "start": {"motions": [{"velocity": [0,0,1], "curve_pairs": ["x"]}]})",
       "no curve-pair is called"},
      {"", R"(, "start": {"from": "somewhere"})", "#/start/from"},
      {R"(, "masses": [{"node": 11, "mass": 1}])", "", "#/curve_pairs/0/masses/0/node"},
      {R"(, "masses": [{"node": 1, "mass": 0}])", "", "#/curve_pairs/0/masses/0/mass"},
      {R"(, "anchors": [{"node": 0, "translation": {"table": [[0,0,0,0],[0,1,1,1]]}}])", "",
       "ascending times"},
      {R"(, "anchors": [{"node": 0, "translation": {"table": [[0,0,0,0],[1,1,1]]}}])", "", "table/1"},
      {R"(, "anchors": [{"node": 0, "translation": {"table": [[0,0,0,0]]}}])", "", "table"},
      {R"(, "anchors": [{"node": 0, "translation": {"velocity": [1,0,0], "table": [[0,0,0,0],[1,1,1,1]]}}])",
       "", "a table alone"},
  };
  for (const auto& [rod, scene, expected] : cases) {
    const std::string reason = refusal(rod, scene);
    EXPECT_NE(reason.find(expected), std::string::npos) << rod << scene << ": " << reason;
  }
}

}  // namespace
}  // namespace tendril::test
