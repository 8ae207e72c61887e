#include <gtest/gtest.h>
#include <tendril/bind/import.h>

#include <algorithm>
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
  for (const auto& [scene, flags] : runs) {
    const Shown shown(scene, flags, colored_tube("COFF", " 255 128 0 200", ""));
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
