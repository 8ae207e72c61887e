#include <gtest/gtest.h>
#include <tendril/bind/import.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <optional>
#include <set>

#include "runner/bending.h"
#include "runner/glb_reader.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

struct Shown {
  Folder folder;
  GlbReader glb;
  Json summary;

  Shown(const Json& scene, const std::string& flags, const std::string& mesh = tube_off(41))
      : glb(run(scene, flags, mesh)), summary(Json::parse(bytes_of(folder / "out/summary.json"))) {}

  std::string run(const Json& scene, const std::string& flags, const std::string& mesh) const {
    folder.write("tube.off", mesh);
    folder.write("s.json", scene.dump());
    const Outcome run = folder.run("run s.json --out out --double --no-pictures " + flags);
    EXPECT_EQ(run.code, 0) << run.err;
    return bytes_of(folder / "out/s.glb");
  }

  std::vector<Vec3> frame(std::size_t moment) const {
    return bind::read_mesh(folder / ("out/" + frame_name(moment))).points;
  }

  /// The point of the mesh that each vertex is of, by where it rests.
  std::vector<std::size_t> points() const {
    const std::vector<Vec3> mesh = bind::read_mesh(folder / "tube.off").points;
    std::vector<std::size_t> out;
    for (const Vec3& v : glb.json.contains("skins") ? glb.rest() : glb.morphed(0)) {
      const auto nearer = [&](const Vec3& a, const Vec3& b) { return (a - v).norm() < (b - v).norm(); };
      out.push_back(
          static_cast<std::size_t>(std::min_element(mesh.begin(), mesh.end(), nearer) - mesh.begin()));
      EXPECT_LT((mesh[out.back()] - v).norm(), 1e-6);
    }
    return out;
  }

  double size() const { return bind::bounding_diagonal(bind::read_mesh(folder / "tube.off").points); }

  /// Largest distance of the file's vertices from the run's, over the size, at any output.
  double error(std::vector<Vec3> (GlbReader::*at)(std::size_t) const = &GlbReader::at) const {
    const std::vector<std::size_t> of = points();
    double worst = 0.0;
    EXPECT_EQ(glb.moments(), summary["outputs"]);
    for (std::size_t m = 0; m < glb.moments(); ++m) {
      const std::vector<Vec3> exact = frame(m), seen = (glb.*at)(m);
      for (std::size_t i = 0; i < seen.size(); ++i) worst = std::max(worst, (seen[i] - exact[of[i]]).norm());
    }
    return worst / size();
  }

  Json notes() const { return glb.json["asset"]["extras"]["tendril"]; }
};

TEST(Gltf, SkinIsAsFarOffAsItSaysAndAsWasAskedFor) {
  std::size_t joints = 0;
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const Shown shown(bending(), "--gltf --gltf-tolerance " + std::to_string(tolerance));
    const Json notes = shown.notes();
    EXPECT_NEAR(shown.error(), notes["max_error"].get<double>(), 1e-6);
    EXPECT_LE(notes["max_error"], tolerance);
    EXPECT_TRUE(notes["within_tolerance"]);
    EXPECT_EQ(notes, shown.glb.json["skins"][0]["extras"]["tendril"]);
    EXPECT_EQ(notes, shown.summary["gltf"]);
    EXPECT_EQ(notes["joints"], shown.glb.json["skins"][0]["joints"].size());
    EXPECT_GT(notes["joints"], joints);
    joints = notes["joints"];
  }
  EXPECT_GT(joints, 12u);
}

TEST(Gltf, BlendedVerticesFollowSeveralCurvePairs) {
  Json scene = forked();
  scene["simulation"]["duration"] = 0.2;
  const Shown shown(scene, "--gltf");
  EXPECT_GT(shown.summary["binding"]["ambiguous"], 20);
  EXPECT_NEAR(shown.error(), shown.notes()["max_error"].get<double>(), 1e-6);
  EXPECT_LE(shown.notes()["max_error"], 1e-3);
  const std::vector<double> joint = shown.glb.attribute("JOINTS_0"),
                            weight = shown.glb.attribute("WEIGHTS_0");
  std::size_t of_both = 0;
  for (std::size_t i = 0; i < joint.size(); i += 4) {
    double sum = 0.0;
    std::set<std::string> pairs;
    for (std::size_t k = i; k < i + 4; ++k) {
      EXPECT_GE(weight[k], 0.0);
      sum += weight[k];
      if (weight[k] == 0.0) {
        EXPECT_EQ(joint[k], 0.0);
        continue;
      }
      const Json& nodes = shown.glb.json["skins"][0]["joints"];
      const std::string name =
          shown.glb.json["nodes"][nodes[static_cast<std::size_t>(joint[k])].get<std::size_t>()]["name"];
      pairs.insert(name.substr(0, name.find('_')));
    }
    EXPECT_NEAR(sum, 1.0, 2e-7);
    if (pairs.size() == 2) ++of_both;
  }
  EXPECT_GT(of_both, 20u);
}

TEST(Gltf, SaysSoWhereJointsDoNotReachTheTolerance) {
  const Shown shown(forked(), "--gltf --gltf-tolerance 1e-7");
  const Json notes = shown.notes();
  EXPECT_FALSE(notes["within_tolerance"]);
  EXPECT_GT(notes["max_error"], 1e-7);
  EXPECT_LE(notes["joints"], notes["max_joints"]);
  EXPECT_NEAR(shown.error(), notes["max_error"].get<double>(), 1e-6);
  EXPECT_NE(bytes_of(shown.folder / "stderr.txt").find("s.glb: its error is"), std::string::npos);
}

TEST(Gltf, RotationsGoTheShortWayFromKeyToKey) {
  const Shown shown(wound(), "--gltf");
  double least = 1.0;
  const Json& animation = shown.glb.json["animations"][0];
  for (const Json& channel : animation["channels"]) {
    if (channel["target"]["path"] != "rotation") continue;
    const Json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
    const std::vector<double> keys = shown.glb.numbers(sampler["output"]);
    for (std::size_t i = 4; i < keys.size(); i += 4) {
      const Eigen::Map<const Eigen::Vector4d> a(keys.data() + i - 4), b(keys.data() + i);
      EXPECT_GE(a.dot(b), 0.0);
      least = std::min(least, b.w());
    }
  }
  EXPECT_LT(least, 0.0);  // as no quaternion is that is taken from a matrix alone
}

TEST(Gltf, WhatIsOutOfReachStays) {
  Json scene = bending();
  scene["curve_pairs"][0]["reach"] = {1.0, 0.1, 0.1};
  const Shown shown(scene, "--gltf");
  EXPECT_GT(shown.summary["binding"]["out_of_reach"], 4);
  EXPECT_LE(shown.error(), 1e-3);
}

TEST(Gltf, StandsUprightWhateverTheScenesUpIs) {
  Json scene = bending();
  scene["picture"]["up"] = {0, 0, 1};
  const Shown shown(scene, "--gltf");
  const std::vector<Vec3> rest = shown.glb.rest();
  double high = -1e9;
  for (const Vec3& p : rest) high = std::max(high, p.y());
  EXPECT_NEAR(high, 0.1, 1e-6);  // the tube's z, not its y, which is up to 1
}

TEST(Gltf, MorphTargetsAreExact) {
  const Shown shown(bending(), "--gltf-morph");
  EXPECT_LT(shown.error(&GlbReader::morphed), 2e-7);
  EXPECT_EQ(shown.notes()["targets"], shown.summary["outputs"]);
  std::vector<double> normal = shown.glb.attribute("NORMAL");
  const std::vector<double> turned = shown.glb.numbers(shown.glb.primitive()["targets"].back()["NORMAL"]);
  double most = 0.0;
  for (std::size_t i = 0; i < normal.size(); i += 3) {
    const Vec3 before(normal.data() + i), after = before + Vec3(turned.data() + i);
    EXPECT_NEAR(after.norm(), 1.0, 1e-6);
    most = std::max(most, (after - before).norm());
  }
  EXPECT_GT(most, 0.5);
}

std::string colored_tube(const std::string& head, const std::string& of_point, const std::string& of_face) {
  std::istringstream plain(tube_off());
  std::string out, line;
  for (int k = 0; std::getline(plain, line); ++k)
    out += (k == 0 ? head : line) + (k < 2 ? "" : k < 38 ? of_point : of_face) + "\n";
  return out;
}

TEST(Gltf, KeepsColorsAndNormals) {
  const Shown points(bending(), "--gltf", colored_tube("COFF", " 255 128 0 255", ""));
  const std::vector<double> color = points.glb.attribute("COLOR_0");
  const double linear = std::pow((128.0 / 255.0 + 0.055) / 1.055, 2.4);
  for (std::size_t i = 0; i < color.size(); i += 4) {
    EXPECT_EQ(color[i], 1.0);
    EXPECT_NEAR(color[i + 1], linear, 1e-4);
    EXPECT_EQ(color[i + 2], 0.0);
  }
  const Shown faces(bending(), "--gltf", colored_tube("OFF", "", " 0 0 255"));
  EXPECT_EQ(faces.glb.attribute("COLOR_0").at(2), 1.0);
  const Shown given(bending(), "--gltf", colored_tube("NOFF", " 0 3 4", ""));
  const std::vector<double> normal = given.glb.attribute("NORMAL");
  EXPECT_EQ(normal.size(), 3u * 36u);
  EXPECT_NEAR(normal[1], 0.6, 1e-7);
  EXPECT_NEAR(normal[2], 0.8, 1e-7);
}

TEST(Gltf, KeepsTextureCoordinates) {
  const Shown of_points(bending(), "--gltf", colored_tube("STOFF", " 0.25 0.875", ""));
  const std::vector<double> texture = of_points.glb.attribute("TEXCOORD_0");
  ASSERT_EQ(texture.size(), 2 * of_points.glb.rest().size());
  for (std::size_t i = 0; i < texture.size(); i += 2) {
    EXPECT_EQ(texture[i], 0.25);
    EXPECT_EQ(texture[i + 1], 0.125);  // rows are counted from above
  }
}

/// The tube with one place in a texture for the corners of some faces and another for those of the others, in
/// no regular order.
std::string checkered_tube() {
  std::istringstream off(tube_off());
  std::string head, out = "vt 0.25 0\nvt 0.75 0\n";
  std::size_t points, faces, edges, corners, corner;
  off >> head >> points >> faces >> edges;
  for (std::size_t i = 0; i < points; ++i) {
    std::string x, y, z;
    off >> x >> y >> z;
    out += "v " + x + " " + y + " " + z + "\n";
  }
  for (std::size_t f = 0; f < faces; ++f) {
    out += "f";
    off >> corners;
    for (std::size_t k = 0; k < corners && off >> corner; ++k)
      out += " " + std::to_string(corner + 1) + "/" + std::to_string(1 + std::popcount(f) % 2);
    out += "\n";
  }
  return out;
}

TEST(Gltf, APointHasAVertexForEachOfItsPlacesInATexture) {
  Json scene = bending();
  scene["mesh"] = "tube.obj";
  const Folder folder;
  folder.write("tube.obj", checkered_tube());
  folder.write("s.json", scene.dump());
  const Outcome run = folder.run("run s.json --out out --no-pictures --gltf");
  ASSERT_EQ(run.code, 0) << run.err;
  const GlbReader glb(bytes_of(folder / "out/s.glb"));
  const std::vector<double> texture = glb.attribute("TEXCOORD_0"),
                            corners = glb.numbers(glb.primitive()["indices"]);
  std::size_t even = 0, odd = 0;
  for (std::size_t k = 0; k < corners.size(); k += 3) {
    const auto s = [&](std::size_t i) { return texture[2 * static_cast<std::size_t>(corners[i])]; };
    EXPECT_EQ(s(k), s(k + 1));
    EXPECT_EQ(s(k), s(k + 2));
    s(k) == 0.25 ? ++even : ++odd;
  }
  EXPECT_GT(even, 10u);
  EXPECT_GT(odd, 10u);
}

TEST(Gltf, SolidsMoveBesideTheMesh) {
  Json scene = bending();
  scene["bodies"] = {{{"name", "ball"},
                      {"shape", {{"type", "ball"}, {"radius", 0.25}}},
                      {"position", {3, 1, 0.5}},
                      {"free", {{"mass", 2}, {"spin", {0, 0, 3}}}}},
                     {{"name", "block"},
                      {"shape", {{"type", "box"}, {"size", {0.5, 0.25, 0.125}}}},
                      {"position", {-4, 1, 0}}}};
  scene["contact"] = {{"of", "mesh"}, {"skin", 0.1}, {"range", 0.1}};
  for (const char* flags : {"--gltf", "--gltf-morph"}) {
    const Shown shown(scene, flags);
    for (std::size_t m = 0; m < shown.glb.moments(); ++m) {
      const double t = 0.05 * static_cast<double>(m);
      const Vec3 falls = Vec3(3, 1, 0.5) + 0.5 * t * t * Vec3(6, -9.81, 2);
      const Eigen::Affine3d ball = shown.glb.place("ball", m);
      EXPECT_LT((ball.translation() - falls).norm(), 1e-5) << m;
      EXPECT_LT((ball.linear() - Eigen::AngleAxisd(3 * t, Vec3::UnitZ()).toRotationMatrix()).norm(), 1e-5);
      EXPECT_LT((shown.glb.place("block", m).translation() - Vec3(-4, 1, 0)).norm(), 1e-6);
    }
    const Json& nodes = shown.glb.json["nodes"];
    const auto extent = [&](const char* name) {
      const Json& at = shown.glb.primitive(nodes[shown.glb.node(name)]["mesh"])["attributes"]["POSITION"];
      return shown.glb.json["accessors"][at.get<std::size_t>()]["max"].get<std::vector<double>>();
    };
    EXPECT_NEAR(extent("ball")[2], 0.25, 1e-6);
    EXPECT_EQ(extent("block"), (std::vector<double>{0.25, 0.125, 0.0625}));
    const double off = shown.error(std::string(flags) == "--gltf" ? &GlbReader::at : &GlbReader::morphed);
    EXPECT_LE(off, 1e-3);
  }
}

TEST(Gltf, IsRefusedWithoutAMesh) {
  Json scene = bending();
  scene.erase("mesh");
  scene.erase("bound_to");
  const Folder folder;
  folder.write("s.json", scene.dump());
  const Outcome run = folder.run("run s.json --out out --gltf");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("no mesh for --gltf"), std::string::npos) << run.err;
}

TEST(Gltf, PassesTheValidatorWhereInstalled) {
  if (!does("command -v node") || !std::filesystem::exists(TENDRIL_NPM "/gltf-validator"))
    GTEST_SKIP() << "needs node, and gltf-validator of npm in " TENDRIL_NPM ", which tests/run.sh fetches";
  const std::pair<Json, std::string> runs[] = {
      {bending(), "--gltf"}, {forked(), "--gltf --gltf-tolerance 1e-4"}, {bending(), "--gltf-morph"}};
  for (auto [scene, flags] : runs) {
    scene["bodies"] = {{{"name", "ground"},
                        {"shape", {{"type", "half_space"}}},
                        {"axis", {0, 1, 0}},
                        {"position", {0, -9, 0}}}};
    scene["contact"] = {{"of", "mesh"}, {"skin", 0.1}, {"range", 0.1}};
    const Shown shown(scene, flags, colored_tube("STCOFF", " 255 128 0 200 0.5 0.5", ""));
    const std::string command = "node '" TENDRIL_SOURCE_DIR "/tests/runner/films/validate.cjs' '" TENDRIL_NPM
                                "' '" +
                                (shown.folder / "out/s.glb") + "' > '" + (shown.folder / "found.json") + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const Json found = Json::parse(bytes_of(shown.folder / "found.json"));
    EXPECT_EQ(found["errors"], 0) << found.dump(1);
    EXPECT_EQ(found["warnings"], 0) << found.dump(1);
  }
}

}  // namespace
}  // namespace tendril::test
