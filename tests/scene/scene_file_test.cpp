#include <gtest/gtest.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/scene/scene_file.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "scene/full_scene.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

scene::SceneFile read(const Json& scene) {
  return scene::parse_scene(scene.dump(), "scene.json");
}

TEST(SceneReader, ASizeListedPerPointIsTheSameAsTheSizeGivenOnce) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["section"]["radius"] = 0.07;
  const Rod once = read(scene).scene.rods[0];
  scene["curve_pairs"][0]["section"]["radius"] = {0.07, 0.07, 0.07};
  const Rod listed = read(scene).scene.rods[0];
  for (std::size_t i = 0; i < once.p.size(); ++i) {
    EXPECT_NEAR(listed.mass[i], once.mass[i], 1e-14 * once.mass[i]);
    EXPECT_NEAR(listed.bend_l[i], once.bend_l[i], 1e-14 * once.bend_l[i]);
  }
  const Rod library = make_rod(once.p, once.q, {2e5, 2e5 / 2.8, 1000}, circular_section(0.07));
  for (std::size_t i = 0; i < once.p.size(); ++i) {
    EXPECT_NEAR(once.mass[i], library.mass[i], 1e-14 * once.mass[i]);
    EXPECT_NEAR(once.inertia[i], library.inertia[i], 1e-14 * once.inertia[i]);
    EXPECT_NEAR(once.bend_m[i], library.bend_m[i], 1e-12 * once.bend_m[i]);
  }
  for (std::size_t i = 0; i + 1 < once.p.size(); ++i) {
    EXPECT_NEAR(once.stretch[i], library.stretch[i], 1e-14 * once.stretch[i]);
    EXPECT_NEAR(once.twist[i], library.twist[i], 1e-12 * once.twist[i]);
  }
}

TEST(SceneReader, AMeshFollowsTheTreeOfTheFirstOrThoseNamed) {
  Json scene = Json::parse(full_scene());
  EXPECT_EQ(read(scene).bound_to, (std::vector<std::size_t>{0}));
  scene["bound_to"] = {"chain", "stem"};
  EXPECT_EQ(read(scene).bound_to, (std::vector<std::size_t>{1, 0}));
  scene.erase("bound_to");
  EXPECT_EQ(read(scene).bound_to, (std::vector<std::size_t>{0}));
  Json branch = scene["curve_pairs"][0];
  branch.erase("anchors");
  branch["name"] = "branch";
  branch["points"] = Json::parse("[[0, 0, 0], [0.2, 0, 0], [0.4, 0, 0]]");
  branch["orientation"] = {0, 0, 1};
  branch["joint"] = {{"curve_pair", "stem"}, {"node", 3}, {"relative", true}};
  scene["curve_pairs"].push_back(branch);
  EXPECT_EQ(read(scene).bound_to, (std::vector<std::size_t>{0, 2}));
}

TEST(SceneReader, ATaperedRodHasTheMassOfItsCone) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["nodes"] = 101;
  scene["curve_pairs"][0]["section"]["radius"] = {0.1, 0.06, 0.02};
  const Rod rod = read(scene).scene.rods[0];
  double mass = 0.0;
  for (const double m : rod.mass) mass += m;
  const double cone = 1000 * std::numbers::pi / 3.0 * (0.1 * 0.1 + 0.1 * 0.02 + 0.02 * 0.02);
  EXPECT_NEAR(mass, cone, 1e-4 * cone);
  // I goes with the fourth power of the radius: 5^4 from end to end, edges of the same length.
  EXPECT_NEAR(rod.bend_l.front() / rod.bend_l.back(), 625.0, 1e-9);
  EXPECT_NEAR(rod.width.front(), 2 * 0.0996, 1e-12);
  const double ratio = 0.0996 / 0.0204;  // radii halfway along the first and the last edge
  EXPECT_NEAR(rod.stretch.front() / rod.stretch.back(), std::pow(ratio, 2), 1e-9);
  EXPECT_NEAR(rod.twist.front() / rod.twist.back(), std::pow(ratio, 4), 1e-7);
}

TEST(SceneReader, NodesAreSpreadEvenlyAndKeepTheEnds) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["points"] = Json::parse("[[0, 0, 0], [0, 0.9, 0], [0, 1, 0]]");
  const Rod rod = read(scene).scene.rods[0];
  ASSERT_EQ(rod.p.size(), 6U);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT((rod.p[static_cast<std::size_t>(i)] - Vec3(0, 0.2 * i, 0)).norm(), 1e-15) << i;
  }
}

TEST(SceneReader, AnchorsMoveWithTheVelocityTheySay) {
  const scene::SceneFile file = read(Json::parse(full_scene()));
  int moving = 0;
  for (const Anchor& anchor : file.scene.anchors) {
    if (!anchor.motion) continue;
    ++moving;
    EXPECT_FALSE(anchor.holds_frame);
    for (const double t : {0.0, 0.13, 0.4}) {
      const double h = 1e-5;
      const AnchorPose pose = anchor.motion(t), before = anchor.motion(t - h), after = anchor.motion(t + h);
      EXPECT_LT((pose.velocity - (after.position - before.position) / (2 * h)).norm(), 1e-7);
      const Vec3 rate = (after.frame.x - before.frame.x) / (2 * h);
      EXPECT_LT((pose.angular_velocity.cross(pose.frame.x) - rate).norm(), 1e-7);
    }
    const double turn = 0.1 * std::sin(0.5 * std::numbers::pi);
    const Vec3 rest = file.scene.rods[anchor.rod].p[anchor.node] - Vec3(1, 1, 0);
    const Vec3 turned(rest.x() * std::cos(turn), rest.x() * std::sin(turn), 0);
    EXPECT_LT((anchor.motion(0.25).position - Vec3(1, 1, 0) - turned).norm(), 1e-12);
  }
  EXPECT_EQ(moving, 2);
}

TEST(SceneReader, AnchorsSlideAlongALineOrAcrossADirection) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["anchors"][0]["slide"] = {{"along", {0, 3, 0}}};
  const Anchor line = read(scene).scene.anchors.front();
  EXPECT_EQ(line.slide, Anchor::Slide::line);
  EXPECT_EQ(line.slide_axis, Vec3(0, 3, 0));
  scene["curve_pairs"][0]["anchors"][0]["slide"] = {{"across", {1, 0, 2}}};
  const scene::SceneFile file = read(scene);
  EXPECT_EQ(file.scene.anchors.front().slide, Anchor::Slide::plane);
  EXPECT_EQ(file.scene.anchors.front().slide_axis, Vec3(1, 0, 2));
  EXPECT_EQ(file.scene.anchors.back().slide, Anchor::Slide::none);
}

TEST(SceneReader, AnchorsSwivelAboutAnAxis) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["anchors"][0]["swivel"] = {0, 3, 1};
  const scene::SceneFile file = read(scene);
  EXPECT_TRUE(file.scene.anchors.front().swivels);
  EXPECT_EQ(file.scene.anchors.front().swivel_axis, Vec3(0, 3, 1));
  EXPECT_FALSE(file.scene.anchors.back().swivels);
}

TEST(SceneReader, AnchorsLetGoAtTheTimeTheySay) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["anchors"][0]["until"] = 0.3;
  const scene::SceneFile file = read(scene);
  EXPECT_EQ(file.scene.anchors.front().until, 0.3);
  EXPECT_EQ(file.scene.anchors.back().until, HUGE_VAL);
}

TEST(SceneReader, AJointPlacesTheChildAndStiffensItsRoot) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][1].erase("anchors");
  scene["curve_pairs"][1]["points"] = Json::parse("[[0, 0, 0], [0.2, 0, 0], [0.4, 0, 0], [0.6, 0, 0]]");
  scene["curve_pairs"][1]["orientation"] = {0, 1, 0};
  scene["curve_pairs"][1]["joint"] = {
      {"curve_pair", "stem"}, {"node", 2}, {"relative", true}, {"stiffness", 3}};
  const scene::SceneFile file = read(scene);
  ASSERT_EQ(file.scene.joints.size(), 1U);
  EXPECT_EQ(file.scene.joints[0].parent, 0U);
  EXPECT_EQ(file.scene.joints[0].child, 1U);
  EXPECT_TRUE(file.scene.joints[0].reaction);
  const Rod& child = file.scene.rods[1];
  EXPECT_EQ(child.p.front(), file.scene.rods[0].p[2]);
  EXPECT_LT((child.p.back() - child.p.front() - Vec3(0.6, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(child.bend_l.front(), 3 * child.bend_l.back(), 1e-15);
  EXPECT_NEAR(child.twist.front(), 3 * child.twist.back(), 1e-15);
  EXPECT_NO_THROW(System(file.scene));
}

TEST(SceneReader, OutputsReachFromTheStartToTheEnd) {
  Json scene = Json::parse(full_scene());
  EXPECT_EQ(read(scene).outputs.size(), 6U);
  EXPECT_EQ(read(scene).outputs.front(), 0.0);
  EXPECT_EQ(read(scene).outputs.back(), 0.1);
  scene["simulation"] = {{"duration", 1.0}, {"output_every", 0.1}};
  EXPECT_EQ(read(scene).outputs.size(), 11U);
  EXPECT_EQ(read(scene).outputs.back(), 1.0);
  scene["simulation"] = {{"duration", 1.05}, {"output_every", 0.1}};
  EXPECT_EQ(read(scene).outputs.size(), 11U);
}

/// Text with one value per line; the number of the line on which `word` stands first.
std::size_t line_with(const std::string& text, const std::string& word) {
  const auto at = static_cast<std::ptrdiff_t>(text.find(word));
  return static_cast<std::size_t>(1 + std::count(text.begin(), text.begin() + at, '\n'));
}

scene::FilePlace place_of(const std::string& text) {
  try {
    scene::parse_scene(text, "scene.json");
  } catch (const scene::SceneError& error) {
    return error.at();
  }
  ADD_FAILURE() << "not refused: " << text;
  return {};
}

TEST(SceneReader, ErrorsHoldFilePointerAndLineApart) {
  Json scene = Json::parse(full_scene());
  scene["forces"][1]["gust"] = "much";
  std::string text = scene.dump(2);
  scene::FilePlace at = place_of(text);
  EXPECT_EQ(at.file, "scene.json");
  EXPECT_EQ(at.pointer, "/forces/1/gust");
  EXPECT_EQ(at.line, line_with(text, "\"gust\""));
  EXPECT_EQ(at.column, 0U);

  scene = Json::parse(full_scene());
  scene["curve_pairs"][1]["points"][2] = {1.2, 1, 77};
  scene["curve_pairs"][1]["points"][3] = {1.2, 1, 77};
  text = scene.dump(2);
  at = place_of(text);
  EXPECT_EQ(at.pointer, "/curve_pairs/1/points/3");
  EXPECT_EQ(at.line, line_with(text, "77") + 2);  // the bracket after the one that closes the point before

  scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["points"][2][1] = "high";
  text = scene.dump(2);
  EXPECT_EQ(place_of(text).line, line_with(text, "high"));

  scene = Json::parse(full_scene());
  scene["simulation"].erase("duration");
  text = scene.dump(2);
  at = place_of(text);
  EXPECT_EQ(at.pointer, "/simulation");
  EXPECT_EQ(at.line, line_with(text, "\"simulation\""));

  at = place_of("{\n  \"version\": 1,\n  \"mesh\": ]\n}");
  EXPECT_EQ(at.pointer, "");
  EXPECT_EQ(at.line, 3U);
  EXPECT_EQ(at.column, 11U);
}

/// Numbers end where the next character begins: a line end behind one is no part of it.
TEST(SceneReader, TheLineOfANumberIsItsOwn) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["points"][1] = {-0.0, 0.0, 0.0};  // the same as the first
  scene["curve_pairs"][0]["section"]["radius"] = {0.1, 0.09, -5};
  const std::string text = scene.dump(2);
  const scene::FilePlace at = place_of(text);
  EXPECT_EQ(at.pointer, "/curve_pairs/0/section/radius/2");
  EXPECT_EQ(at.line, line_with(text, "-5"));
}

TEST(SceneReader, TheScenesOfTheTreeAreGood) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TENDRIL_SOURCE_DIR "/examples/scenes")) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_NO_THROW({
      const scene::SceneFile file = scene::read_scene(entry.path().string());
      const System system(file.scene);
    }) << entry.path();
    ++scenes;
  }
  EXPECT_GE(scenes, 5);
}

/// A stalk in gusty wind, of which the scene says speed and strength alone: in metres, or in millimetres,
/// grams and milliseconds.
Json stalk_in_wind(bool small) {
  const double length = small ? 1e3 : 1.0, time = small ? 1e3 : 1.0, mass = small ? 1e3 : 1.0;
  const double density = mass / std::pow(length, 3), speed = length / time;
  Json scene = Json::parse(R"({"version": 1})");
  scene["units"] = {
      {"length", small ? "mm" : "m"}, {"mass", small ? "g" : "kg"}, {"time", small ? "ms" : "s"}};
  scene["curve_pairs"] = Json::array({{
      {"points", {{0, 0, 0}, {0, 0, 0.5 * length}}},
      {"nodes", 6},
      {"orientation", {1, 0, 0}},
      {"material",
       {{"young", 1e7 * mass / (length * time * time)}, {"poisson", 0.3}, {"density", 500 * density}}},
      {"section", {{"type", "circular"}, {"radius", 0.004 * length}}},
      {"mass_damping", 1.0 / time},
      {"anchors", {{{"node", 0}}}},
  }});
  scene["forces"] = {{{"type", "wind"}, {"mean", {6 * speed, 0, 0}}, {"gust", 0.7}}};
  scene["simulation"] = {{"duration", 0.4 * time}, {"tolerance", 1e-6}};
  return scene;
}

Vec3 tip_after(const Json& json) {
  const scene::SceneFile file = read(json);
  const System system(file.scene);
  Simulation simulation(system, system.rest_state(), file.options);
  EXPECT_EQ(simulation.run(file.duration).stop, Stop::finished);
  return simulation.pairs()[0].primary().value(1.0);
}

TEST(SceneReader, WhatIsNotSaidOfWindIsMeantInTheScenesUnits) {
  const Vec3 tip = tip_after(stalk_in_wind(false)), small = 1e-3 * tip_after(stalk_in_wind(true));
  EXPECT_GT(tip.x(), 0.05);
  EXPECT_LT((tip - small).norm(), 1e-5);

  Json words = stalk_in_wind(true);
  words["units"] = {{"length", "0.5 mm"}, {"mass", "pound"}, {"time", "minutes"}};
  EXPECT_NO_THROW(read(words));
  for (const char* unknown : {"cubit", "", "-1 mm", "1e999 mm", "x mm", "mm m"}) {
    words["units"]["length"] = unknown;
    EXPECT_THROW(read(words), scene::SceneError) << unknown;
  }
  words["forces"][0]["air_density"] = 1e-6;
  EXPECT_THROW(read(words), scene::SceneError);
  words["forces"][0]["gust_frequency"] = 0.001;
  EXPECT_NO_THROW(read(words));
  words["units"].erase("mass");
  words["forces"][0].erase("air_density");
  EXPECT_THROW(read(words), scene::SceneError);
}

}  // namespace
}  // namespace tendril::test
