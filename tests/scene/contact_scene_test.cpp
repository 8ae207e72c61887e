#include <gtest/gtest.h>
#include <tendril/base/file.h>
#include <tendril/scene/scene_run.h>
#include <tendril/scene/summary.h>

#include <nlohmann/json.hpp>

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// A ball above a clamped rod over the ground, beside a post that moves away.
Json scene() {
  return Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "leaf", "points": [[0, 0, 0.5], [0.4, 0, 0.55], [0.8, 0, 0.5]], "nodes": 9, "orientation": [0, 1, 0],
       "material": {"young": 2e8, "poisson": 0.35, "density": 400},
       "section": {"type": "circular", "radius": 0.01},
       "mass_damping": 1.0, "viscosity": 0.002, "anchors": [{"node": 0}]}],
    "bodies": [
      {"name": "ground", "shape": {"type": "half_space"}},
      {"name": "ball", "shape": {"type": "ball", "radius": 0.05}, "position": [0.5, 0.002, 0.7],
       "free": {"mass": 0.02, "velocity": [0, 0, -0.5]}},
      {"shape": {"type": "box", "size": [0.1, 0.1, 0.4]}, "position": [-0.2, 0, 0.2], "axis": [1, 0, 1],
       "translation": {"velocity": [-0.1, 0, 0]}}],
    "contact": {"friction": 0.3, "damping": 0.1},
    "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
    "simulation": {"duration": 0.3, "tolerance": 1e-4, "frames": 31, "method": "automatic"}
  })");
}

scene::SceneFile read(const Json& scene) {
  return scene::parse_scene(scene.dump(1), "scene.json");
}

TEST(ContactScene, ReadsSolidsAndTheirContact) {
  const scene::SceneFile file = read(scene());
  ASSERT_EQ(file.bodies.size(), 3u);
  EXPECT_EQ(file.bodies[1].name, "ball");
  EXPECT_EQ(file.bodies[1].free, 0u);
  EXPECT_EQ(file.bodies[2].name, "body_2");
  EXPECT_TRUE(file.bodies[2].motion);
  EXPECT_FALSE(file.bodies[0].motion);
  EXPECT_EQ(file.contact, 1u);
  ASSERT_EQ(file.scene.bodies.size(), 1u);
  EXPECT_NEAR(file.scene.bodies[0].inertia(0, 0), 0.4 * 0.02 * 0.05 * 0.05, 1e-18);
  EXPECT_EQ(file.scene.bodies[0].velocity, Vec3(0, 0, -0.5));
}

TEST(ContactScene, ABallFallsOnALeafAndIsThrownOff) {
  scene::SceneRun run(read(scene()));
  double pressed = 0.0, least = 1.0;
  std::vector<scene::Snapshot> seen;
  const Report report = run.run([&](const scene::Snapshot& now) {
    seen.push_back(now);
    for (const scene::ContactPoint& c : now.contacts) {
      EXPECT_EQ(c.body, 1u);
      pressed = std::max(pressed, c.force.norm());
      least = std::min(least, c.gap);
      EXPECT_NEAR((c.point - now.bodies[1].position).norm() - 0.05 - 0.01, c.gap, 1e-12);
    }
  });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_GT(pressed, 0.01);
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 1e-3);
  EXPECT_NEAR(seen.back().bodies[2].position.x(), -0.2 - 0.1 * 0.3, 1e-15);
  EXPECT_LT(seen.back().bodies[1].position.z(), 0.7);
  const Json summary = Json::parse(scene::summary_json(run, report, {}));
  EXPECT_EQ(summary.at("bodies"), Json({"ground", "ball", "body_2"}));
}

TEST(ContactScene, WithoutResponseABodyFallsThrough) {
  Json json = scene();
  json["contact"] = {{"response", "off"}};
  scene::SceneRun run(read(json));
  const Report report = run.run();
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_NEAR(run.snapshot().bodies[1].position.z(), 0.7 - 0.5 * 0.3 - 0.5 * 9.81 * 0.09, 1e-6);
}

/// Two rods that cross, and a twig on the one that falls: joined to its stem, it is no contact.
Json crossing() {
  return Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "held", "points": [[0, -0.3, 0], [0, 0.3, 0]], "nodes": 4, "orientation": [0, 0, 1],
       "material": {"young": 1e8, "poisson": 0.35, "density": 400},
       "section": {"type": "circular", "radius": 0.02}, "anchors": [{"nodes": [0, 3]}]},
      {"name": "stem", "points": [[-0.3, 0.01, 0.06], [0.3, 0, 0.06]], "nodes": 5, "orientation": [0, 0, 1],
       "material": {"young": 1e7, "poisson": 0.35, "density": 400},
       "section": {"type": "circular", "radius": 0.015}, "mass_damping": 1.0},
      {"name": "twig", "points": [[0.15, 0.0025, 0.06], [0.25, 0.12, 0.06]], "nodes": 4, "orientation": [0, 0, 1],
       "material": {"young": 1e7, "poisson": 0.35, "density": 400},
       "section": {"type": "circular", "radius": 0.01},
       "joint": {"curve_pair": "stem", "node": 3}}],
    "self_contact": {"friction": 0.3, "damping": 0.5},
    "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
    "simulation": {"duration": 0.15, "tolerance": 1e-4, "frames": 16}
  })");
}

TEST(ContactScene, RodsMeetEachOther) {
  scene::SceneRun run(read(crossing()));
  double pressed = 0.0, least = 1.0;
  const Report report = run.run([&](const scene::Snapshot& now) {
    EXPECT_TRUE(now.contacts.empty());
    for (const scene::RodContactPoint& c : now.rod_contacts) {
      EXPECT_EQ(c.curve_pair[0], 0u);
      EXPECT_EQ(c.curve_pair[1], 1u);
      pressed = std::max(pressed, -c.force.z());
      least = std::min(least, c.gap);
    }
  });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_GT(pressed, 0.001);
  EXPECT_GT(least, 0.0);
  EXPECT_GT(run.snapshot().masses[1][2].z(), 0.03);
  Json off = crossing();
  off["self_contact"]["response"] = "off";
  scene::SceneRun through(read(off));
  EXPECT_EQ(through.run().stop, Stop::finished);
  EXPECT_LT(through.snapshot().masses[1][2].z(), 0.0);
}

/// A flat blade about the rod.
bind::PolygonMesh blade() {
  bind::PolygonMesh mesh;
  for (int i = 0; i <= 8; ++i)
    for (const double y : {-0.1, 0.0, 0.1}) mesh.points.emplace_back(0.1 * i, y, 0.52);
  for (std::uint32_t i = 0; i < 8; ++i)
    for (std::uint32_t j = 0; j < 2; ++j) {
      const std::uint32_t a = 3 * i + j;
      for (const std::uint32_t corner : {a, a + 3, a + 4, a + 1}) mesh.corners.push_back(corner);
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  return mesh;
}

TEST(ContactScene, ABallMeetsTheMeshBesideItsRod) {
  Json json = scene();
  json["contact"] = {{"of", "mesh"}, {"skin", 0.005}, {"friction", 0.3}};
  json["curve_pairs"][0].erase("viscosity");
  json["bodies"][1]["position"] = {0.5, 0.06, 0.6};
  json["simulation"]["duration"] = 0.05;
  scene::SceneRun run(read(json), blade());
  double pressed = 0.0;
  std::size_t face = 99;
  const Report report = run.run([&](const scene::Snapshot& now) {
    EXPECT_TRUE(now.contacts.empty());
    for (const scene::MeshContactPoint& c : now.mesh_contacts) {
      EXPECT_EQ(c.body, 1u);
      EXPECT_GT(c.gap, 0.0);
      pressed = std::max(pressed, -c.force.z());
      face = c.face;
    }
  });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_GT(pressed, 0.0);
  ASSERT_LT(face, run.mesh()->mesh().face_count());
  EXPECT_GT(run.mesh()->mesh().points[run.mesh()->mesh().face(face)[2]].y(), 0.0);
  EXPECT_GT(run.snapshot().bodies[1].position.z(), 0.54);
}

/// Two blades in one mesh, about a rod each.
bind::PolygonMesh two_blades() {
  bind::PolygonMesh mesh;
  for (const double z : {0.5, 0.53})
    for (int i = 0; i <= 8; ++i)
      for (const double y : {-0.1, 0.0, 0.1}) mesh.points.emplace_back(0.1 * i, y, z);
  for (std::uint32_t blade : {0U, 27U})
    for (std::uint32_t i = 0; i < 8; ++i)
      for (std::uint32_t j = 0; j < 2; ++j) {
        const std::uint32_t a = blade + 3 * i + j;
        for (const std::uint32_t corner : {a, a + 3, a + 4, a + 1}) mesh.corners.push_back(corner);
        mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
      }
  return mesh;
}

TEST(ContactScene, PartsOfTheMeshMeetEachOther) {
  for (const char* meets : {"all", "other_parts"}) {
    Json json = scene();
    json.erase("bodies");
    json.erase("contact");
    Json& lower = json["curve_pairs"][0];
    lower.erase("viscosity");
    Json upper = lower;
    upper["name"] = "upper";
    upper.erase("anchors");
    lower["points"] = {{0, 0, 0.5}, {0.4, 0, 0.5}, {0.8, 0, 0.5}};
    upper["points"] = {{0, 0, 0.53}, {0.4, 0, 0.53}, {0.8, 0, 0.53}};
    json["curve_pairs"].push_back(upper);
    json["bound_to"] = {"leaf", "upper"};
    json["self_contact"] = {{"of", "mesh"}, {"skin", 0.004}, {"meets", meets}};
    json["simulation"]["duration"] = 0.1;
    scene::SceneRun run(read(json), two_blades());
    double pressed = 0.0, least = 1.0;
    const Report report = run.run([&](const scene::Snapshot& now) {
      for (const scene::MeshSelfContactPoint& c : now.mesh_self_contacts) {
        EXPECT_NE(c.face[0] < 16, c.face[1] < 16);
        pressed = std::max(pressed, std::abs(c.force.z()));
        least = std::min(least, c.gap);
      }
    });
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_GT(pressed, 0.0);
    EXPECT_GT(least, 0.0);
  }
}

/// A rod falls on a pyramid of a file, which a plate of the same height would hold up as high.
TEST(ContactScene, ASolidMayBeAMesh) {
  const std::string folder = testing::TempDir();
  write_file_whole(folder + "/pyramid.off",
                   "OFF 5 5 0\n-0.2 -0.2 0\n0.2 -0.2 0\n0.2 0.2 0\n-0.2 0.2 0\n0 0 0.3\n"
                   "4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n");
  Json json = scene();
  json["bodies"] = {{{"name", "pyramid"},
                     {"shape", {{"type", "mesh"}, {"file", "pyramid.off"}}},
                     {"position", {0.6, 0.0, 0.2}}}};
  json["simulation"]["duration"] = 0.5;
  const auto read_here = [&] { return scene::parse_scene(json.dump(1), folder + "/scene.json"); };
  scene::SceneRun run(read_here());
  double least = 1.0;
  bool touched = false;
  const Report report = run.run([&](const scene::Snapshot& now) {
    for (const scene::ContactPoint& c : now.contacts) {
      touched = true;
      least = std::min(least, c.gap);
      EXPECT_NEAR(c.point.x(), 0.6, 0.1);
    }
  });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_TRUE(touched);
  EXPECT_GT(least, 0.0);
  json["bodies"][0]["free"] = {{"mass", 1.0}};
  EXPECT_THROW(read_here(), InvalidInput);
  json["bodies"][0].erase("free");
  json["bodies"][0]["shape"]["file"] = "nothing.off";
  EXPECT_THROW(read_here(), std::exception);
}

std::string refusal(const Json& json) {
  try {
    scene::SceneRun run(read(json));
  } catch (const InvalidInput& refused) {
    return refused.what();
  }
  return "accepted";
}

TEST(ContactScene, RefusesWithThePlace) {
  const auto expect = [](const std::function<void(Json&)>& change, const std::string& place) {
    Json json = scene();
    change(json);
    EXPECT_NE(refusal(json).find(place), std::string::npos) << refusal(json);
  };
  expect([](Json& s) { s["bodies"][1]["shape"]["type"] = "cone"; }, "#/bodies/1/shape/type");
  expect([](Json& s) { s["bodies"][1]["shape"].erase("radius"); }, "#/bodies/1/shape");
  expect([](Json& s) { s["bodies"][1]["shape"]["length"] = 1.0; }, "#/bodies/1/shape/length");
  expect([](Json& s) { s["bodies"][1]["name"] = "ground"; }, "#/bodies/1");
  expect([](Json& s) { s["bodies"][0]["free"] = {{"mass", 1.0}}; }, "#/bodies/0/free");
  expect([](Json& s) { s["bodies"][2]["free"] = {{"mass", 1.0}}; }, "#/bodies/2/free");
  expect([](Json& s) { s["bodies"][2]["axis"] = {0, 0, 0}; }, "#/bodies/2/axis");
  expect([](Json& s) { s["bodies"][2]["shape"]["size"] = {1, 0, 1}; }, "#/bodies/2");
  expect([](Json& s) { s["contact"]["range"] = 0.0; }, "#/contact/range");
  expect([](Json& s) { s.erase("bodies"); }, "#/contact");
  expect([](Json& s) { s["contact"]["skin"] = 0.01; }, "#/contact/skin");
  expect([](Json& s) { s["contact"]["of"] = "mesh"; }, "#/contact");
  expect(
      [](Json& s) {
        s["contact"]["of"] = "mesh";
        s["contact"]["skin"] = 0.01;
      },
      "not bound");
  expect([](Json& s) { s["self_contact"] = {{"range", -1.0}}; }, "#/self_contact/range");
  expect(
      [](Json& s) {
        s.erase("forces");
        for (Json& body : s["bodies"])
          if (body.contains("free"))
            body["free"].erase("velocity");
          else
            body.erase("translation");
      },
      "#/contact");
  expect(
      [](Json& s) {
        s["bodies"][1]["position"] = {0.5, 0, 0.56};
      },
      "rod 0 begins within collider 1 (ball)");
}

}  // namespace
}  // namespace tendril::test
