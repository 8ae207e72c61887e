#include <gtest/gtest.h>
#include <tendril/scene/scene_run.h>

#include <nlohmann/json.hpp>

#include "rod_scene.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

constexpr double kGravity = 9.81;

Json scene_of(const char* points) {
  Json scene = rod_scene(points, 1e8);
  scene["simulation"] = {{"duration", 1}, {"tolerance", 1e-4}, {"frames", 51}};
  return scene;
}

/// But for a rod far away.
Json bodies_alone() {
  Json scene = scene_of("[[50, 0, 50], [51, 0, 50]]");
  scene["curve_pairs"][0]["anchors"] = Json::parse(R"([{"nodes": [0, 8], "hold": "both"}])");
  return scene;
}

/// Where nothing falls the speeds that the file says choose how stiff contact is.
TEST(ContactBySpeed, BallsExchangeTheirVelocitiesWithoutGravity) {
  Json scene = bodies_alone();
  scene["bodies"] = Json::parse(R"([
    {"shape": {"type": "ball", "radius": 0.05}, "position": [0, 0, 0], "free": {"mass": 0.1, "velocity": [3, 0, 0]}},
    {"shape": {"type": "ball", "radius": 0.05}, "position": [0.5, 0, 0], "free": {"mass": 0.1}}])");
  scene::SceneRun run(parsed(scene));
  std::vector<Vec3> before, last;
  const Report report = run.run([&](const scene::Snapshot& now) {
    before = last, last.clear();
    for (const scene::SolidPose& body : now.bodies) last.push_back(body.position);
  });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  ASSERT_EQ(last.size(), 2u);
  EXPECT_NEAR((last[0] - before[0]).norm() / 0.02, 0.0, 3e-3);
  EXPECT_NEAR((last[1] - before[1]).x() / 0.02, 3.0, 3e-3);
}

/// A press that no rod can give way to: the run stops, and says where.
TEST(ContactBySpeed, WhereNothingCanGiveWayTheNodeIsNamed) {
  Json scene = scene_of("[[0, 3, 0.5], [0.5, 3, 0.5]]");
  scene["curve_pairs"][0]["anchors"] = Json::parse(R"([{"node": 0, "hold": "both"}])");
  Json pressed = scene_of("[[0, 0, 0.05], [0.5, 0, 0.05]]")["curve_pairs"][0];
  pressed["name"] = "pressed";
  scene["curve_pairs"].push_back(pressed);
  scene["bodies"] = Json::parse(R"([
    {"shape": {"type": "half_space"}, "position": [0, 0, 0]},
    {"shape": {"type": "box", "size": [1, 1, 0.1]}, "position": [0.25, 0, 0.2],
     "translation": {"velocity": [0, 0, -1]}}])");
  scene::SceneRun run(parsed(scene));
  const Report report = run.run();
  EXPECT_EQ(report.stop, Stop::step_underflow);
  EXPECT_NE(report.reason.find("; the error is largest at rod 1 node "), std::string::npos) << report.reason;
}

TEST(ContactBySpeed, ABoxThatIsDrivenFastSweepsARodAsideAndGoesThroughNone) {
  Json scene = scene_of("[[0, 0, 0], [0, 0, 1]]");
  let_fall(scene);
  scene["curve_pairs"][0]["anchors"] = Json::parse(R"([{"node": 0, "hold": "both"}])");
  scene["bodies"] =
      Json::parse(R"([{"shape": {"type": "box", "size": [0.1, 0.4, 0.1]}, "position": [-1, 0, 0.8],
    "translation": {"velocity": [50, 0, 0]}}])");
  scene["simulation"] = {{"duration", 0.05}, {"tolerance", 1e-3}, {"frames", 101}};
  scene::SceneRun run(parsed(scene));
  double least = 1.0;
  const Report report = run.run([&](const scene::Snapshot& now) {
    const Vec3 centre(-1.0 + 50.0 * now.time, 0.0, 0.8);
    for (const Vec3& p : now.masses[0])
      least = std::min(least,
                       ((p - centre).cwiseAbs() - Vec3(0.05, 0.2, 0.05)).cwiseMax(0.0).norm() - kRodRadius);
  });
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0.05);  // it came near
}

TEST(ContactBySpeed, RefusesToChooseWhereNothingMoves) {
  Json scene = bodies_alone();
  scene["bodies"] = Json::parse(R"([{"shape": {"type": "half_space"}}])");
  try {
    parsed(scene);
    ADD_FAILURE() << "accepted";
  } catch (const scene::SceneError& refused) {
    EXPECT_NE(std::string(refused.what()).find("no gravity or speed to choose one by"), std::string::npos);
  }
}

/// What has corners and lands on one, and what is short and falls far, are stopped as well.
TEST(ContactByFall, ABoxIsStoppedOnItsCorner) {
  for (const char* body :
       {R"({"shape": {"type": "box", "size": [0.1, 0.1, 0.1]}, "axis": [-1, -1, 1]})",
        R"({"shape": {"type": "cylinder", "radius": 0.03, "length": 0.06}, "axis": [1, 0, 1]})"}) {
    Json scene = bodies_alone();
    let_fall(scene);
    scene["bodies"] = Json::parse(R"([{"shape": {"type": "half_space"}}])");
    scene["bodies"].push_back(Json::parse(body));
    scene["bodies"][1]["position"] = {0, 0, 1.5};
    scene["bodies"][1]["free"] = {{"mass", 0.5}};
    scene["contact"] = {{"friction", 0.2}, {"damping", 0.1}};
    scene["simulation"]["tolerance"] = 1e-5;
    scene::SceneRun run(parsed(scene));
    double lowest = 1.0;
    const Report report =
        run.run([&](const scene::Snapshot& now) { lowest = std::min(lowest, now.bodies[1].position.z()); });
    EXPECT_EQ(report.stop, Stop::finished) << body << report.reason;
    EXPECT_GT(lowest, 0.02) << body;
    EXPECT_LT(lowest, 0.1) << body;  // it came down
  }
}

TEST(ContactByFall, AShortRodIsStoppedThatFallsFar) {
  Json scene = scene_of("[[0, 0, 2], [0.04, 0, 2.03]]");
  let_fall(scene);
  scene["bodies"] = Json::parse(R"([{"shape": {"type": "half_space"}}])");
  scene["contact"] = {{"damping", 0.1}};
  scene["simulation"]["tolerance"] = 1e-3;
  scene::SceneRun run(parsed(scene));
  double least = 1.0;
  const Report report = run.run([&](const scene::Snapshot& now) {
    for (const Vec3& p : now.masses[0]) least = std::min(least, p.z() - kRodRadius);
  });
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0.5);
}

constexpr double kSlope = 0.35;

/// A ball that bounces, while a rod 2000 times as long is carried away a hundred times as fast: its
/// errors are measured on its own.
TEST(ContactOnASlope, ABallBouncesToItsOwnTolerance) {
  Json scene = bodies_alone();
  scene["curve_pairs"][0]["points"] = {{50, 0, 50}, {150, 0, 50}};
  scene["curve_pairs"][0]["anchors"][0]["translation"] = {{"velocity", {0, 100, 0}}};
  scene["forces"] = {{{"type", "gravity"},
                      {"acceleration", {kGravity * std::sin(kSlope), 0.0, -kGravity * std::cos(kSlope)}}}};
  scene["bodies"] = Json::parse(R"([{"shape": {"type": "half_space"}},
    {"shape": {"type": "ball", "radius": 0.05}, "position": [0, 0, 0.3], "free": {"mass": 0.1}}])");
  scene["contact"] = {{"friction", 0.05}, {"stiffness", 2e6}};  // else chosen by the rod's speed
  scene["simulation"]["duration"] = 2.0;
  std::vector<double> heights;
  for (const double tolerance : {1e-4, 1e-7}) {
    scene["simulation"]["tolerance"] = tolerance;
    scene::SceneRun run(parsed(scene));
    double last = 0.0;
    const Report report = run.run([&](const scene::Snapshot& now) { last = now.bodies[1].position.z(); });
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    heights.push_back(last);
  }
  EXPECT_NEAR(heights[0], heights[1], 2e-3);
}

/// What hardly moves yet, lying on a floor and pushed, is not refused for its energy.
TEST(ContactOnASlope, ABallIsPushedAlongAFloor) {
  Json scene = bodies_alone();
  let_fall(scene);
  scene["bodies"] = Json::parse(R"([{"shape": {"type": "half_space"}},
    {"shape": {"type": "box", "size": [0.1, 0.5, 0.2]}, "position": [-0.2, 0, 0.15],
     "translation": {"velocity": [0.5, 0, 0]}},
    {"shape": {"type": "ball", "radius": 0.05}, "position": [0, 0, 0.051], "free": {"mass": 0.1}}])");
  scene["contact"] = {{"friction", 0.0}, {"damping", 0.5}};
  for (const double tolerance : {1e-3, 1e-4}) {
    scene["simulation"]["tolerance"] = tolerance;
    scene::SceneRun run(parsed(scene));
    double apart = 1.0;
    const Report report = run.run([&](const scene::Snapshot& now) {
      apart = std::min(apart, now.bodies[2].position.x() - now.bodies[1].position.x() - 0.1);
    });
    EXPECT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_GT(apart, 0.0);
    EXPECT_LT(apart, 0.01);
  }
}

/// 5/14 g t^2 sin of the slope.
TEST(ContactOnASlope, ABallRollsAtAToleranceOfAThousandth) {
  Json scene = bodies_alone();
  scene["forces"] = {{{"type", "gravity"},
                      {"acceleration", {kGravity * std::sin(kSlope), 0.0, -kGravity * std::cos(kSlope)}}}};
  scene["bodies"] = Json::parse(R"([{"shape": {"type": "half_space"}},
    {"shape": {"type": "ball", "radius": 0.05}, "position": [0, 0, 0.051], "free": {"mass": 0.1}}])");
  scene["contact"] = {{"friction", 0.5}};
  scene["simulation"]["tolerance"] = 1e-3;
  scene::SceneRun run(parsed(scene));
  double last = 0.0;
  const Report report = run.run([&](const scene::Snapshot& now) { last = now.bodies[1].position.x(); });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_NEAR(last, 5.0 / 14.0 * kGravity * std::sin(kSlope), 5e-3);
}

/// On a floor that moves friction carries a rod along: v t - v^2 / (2 mu g) once it has its speed.
TEST(ContactOnABelt, ARodIsTakenAlong) {
  Json scene = scene_of("[[0, 0, 0.01095], [1, 0, 0.01095]]");
  let_fall(scene);
  scene["bodies"] =
      Json::parse(R"([{"shape": {"type": "half_space"}, "translation": {"velocity": [0.5, 0, 0]}}])");
  scene["contact"] = {{"friction", 0.1}, {"damping", 0.3}};
  scene::SceneRun run(parsed(scene));
  Vec3 last = Vec3::Zero();
  const Report report = run.run([&](const scene::Snapshot& now) { last = now.masses[0][0]; });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_NEAR(last.x(), 0.5 - 0.25 / (2.0 * 0.1 * kGravity), 1e-3);
}

/// What begins deep in the range is thrown out with the energy that it has there, however long the run is and
/// with it the first step would be.
TEST(ContactBegunDeep, ThrowsOutWithTheEnergyOfTheStart) {
  double heights[2] = {};
  for (const int longer : {0, 1}) {
    Json scene = scene_of("[[0, 0, 0.0101], [1, 0, 0.0101]]");
    let_fall(scene);
    scene["bodies"] = Json::parse(R"([{"shape": {"type": "half_space"}}])");
    scene["contact"] = {{"friction", 0.1}};
    scene["simulation"]["duration"] = longer ? 3.0 : 0.1;
    scene["simulation"]["frames"] = longer ? 31 : 2;
    scene::SceneRun run(parsed(scene));
    const Report report = run.run([&](const scene::Snapshot& now) {
      if (now.time <= 0.1 + 1e-9) heights[longer] = now.masses[0][0].z();
    });
    EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  }
  EXPECT_GT(heights[0], 0.2);
  EXPECT_NEAR(heights[1], heights[0], 1e-3);
}

}  // namespace
}  // namespace tendril::test
