#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <optional>

#include "runner/chromium.h"
#include "runner/glb_reader.h"

/// What Chromium and Blender make of films. Takes long: both draw on the processor.
namespace tendril::test {
namespace {

using Json = nlohmann::json;

Json with_degree(Json scene, int degree) {
  scene["simulation"]["degree"] = degree;
  return scene;
}

TEST(PlayerInChromium, VerticesInThePageAreTheLibrarysAndItPlays) {
  if (!can_play()) GTEST_SKIP() << kToPlay;
  const Folder folder;
  std::vector<std::string> names;
  for (int degree = 1; degree <= 5; ++degree) {
    names.push_back("degree" + std::to_string(degree));
    make_page(folder, names.back(), with_degree(bending(), degree), tube_off(41));
  }
  names.emplace_back("wound");
  make_page(folder, "wound", wound(), tube_off(41));
  names.emplace_back("blended");
  make_page(folder, "blended", forked(), tube_off(41));
  EXPECT_GT(Json::parse(bytes_of(folder / "blended/summary.json"))["binding"]["ambiguous"], 20);
  const Json seen = play(folder, names);
  ASSERT_EQ(seen.size(), names.size());
  for (const Json& page : seen) {
    const std::string name = page["name"];
    EXPECT_EQ(page["faults"], Json::array()) << name;
    EXPECT_EQ(page["last"], 12);
    EXPECT_EQ(page["times"], Json({0.0, 0.3, 0.6}));
    double worst = 0.0;
    for (const std::size_t moment : page["moments"])
      worst = std::max(worst, shader_error(folder, "tube.off", name, moment));
    EXPECT_LT(worst, 5e-7) << name;
    std::cout << name << ": " << worst << " of the size from the library's vertices\n";
  }
  const Json& last = seen.back();
  EXPECT_EQ(last["stepped"], 1);
  EXPECT_TRUE(last["playing"]);
  EXPECT_TRUE(last["paused"]);
  EXPECT_EQ(last["ended"], 12);
  EXPECT_LT(last["turned"][0], -0.1);
  EXPECT_GT(last["turned"][1], 0.05);
  EXPECT_NEAR(last["nearer"], 0.5, 0.01);
  EXPECT_LT(last["keyed"][0], -0.05);
  EXPECT_NEAR(last["keyed"][1], 1 / 1.1, 0.01);
  EXPECT_EQ(last["clicked"], 6);
  EXPECT_TRUE(last["home"]);
  EXPECT_EQ(last["switches"], Json({"mesh", "curve-pairs", "frames", "tubes", "ambiguous"}));
  EXPECT_LT(last["narrow"]["covered"], last["narrow"]["mesh"]);
  EXPECT_EQ(last["refusal"], "This page needs a browser of 2023 or later.");
  for (const std::string look : {"_all.png", "_light.png", "_dark.png"})
    EXPECT_GT(std::filesystem::file_size(folder / ("blended" + look)), 20000u) << look;
}

/// Rows of a run's table.
std::int64_t rows_of(const std::string& path) {
  const std::string table = bytes_of(path);
  return std::count(table.begin(), table.end(), '\n') - 1;
}

TEST(PlayerInChromium, DrawsEveryContactSolidAndLine) {
  if (!can_play()) GTEST_SKIP() << kToPlay;
  struct Shown {
    std::string name, table;
    int solids;
    Json switches;
  };
  const Shown scenes[] = {
      {"rope_over_rods", "rod_contacts.csv", 0, {"curve-pairs", "frames", "tubes", "contacts"}},
      {"ball_on_leaf", "contacts.csv", 3, {"curve-pairs", "frames", "tubes", "contacts"}},
      {"ball_on_leaf_blade", "mesh_contacts.csv", 1, {"mesh", "curve-pairs", "frames", "tubes", "contacts"}}};
  const Folder folder;
  std::vector<std::string> names;
  for (const Shown& scene : scenes) {
    const Outcome run = folder.run("run '" TENDRIL_SOURCE_DIR "/examples/scenes/" + scene.name +
                                   ".json' --out " + scene.name + " --no-pictures --no-frames --player");
    ASSERT_EQ(run.code, 0) << run.err;
    names.push_back(scene.name);
  }
  names.emplace_back("bending");  // the last is played by hand
  make_page(folder, "bending", bending(), tube_off());
  const Json seen = play(folder, names);
  for (std::size_t k = 0; k < std::size(scenes); ++k) {
    const std::string& name = scenes[k].name;
    const Json& page = seen.at(k);
    EXPECT_EQ(page["faults"], Json::array()) << name;
    EXPECT_EQ(page["switches"], scenes[k].switches) << name;
    EXPECT_TRUE(page["outlines"]["finite"]) << name;
    EXPECT_EQ(page["outlines"]["solids"], scenes[k].solids) << name;
    EXPECT_EQ(page["outlines"]["drawn"], rows_of(folder / (name + "/" + scenes[k].table))) << name;
    EXPECT_GT(page["outlines"]["drawn"], 10) << name;
  }
}

/// Largest distance, at any moment, between where Blender has a file's vertices and where our skinning has
/// them.
double blender_off_by(const Folder& folder, const Json& scene) {
  folder.write("tube.off", tube_off(41));
  folder.write("s.json", scene.dump());
  const Outcome run = folder.run("run s.json --out out --no-frames --no-pictures --gltf");
  EXPECT_EQ(run.code, 0) << run.err;
  const std::string command = "cd '" + folder.path().string() +
                              "' && blender -b --python-exit-code 1 -P '" TENDRIL_SOURCE_DIR
                              "/tests/runner/films/import.py' -- out/s.glb seen.bin > blender.txt 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << bytes_of(folder / "blender.txt");
  const GlbReader glb(bytes_of(folder / "out/s.glb"));
  const std::string bytes = bytes_of(folder / "seen.bin");
  const std::size_t count = glb.at(0).size();
  EXPECT_EQ(bytes.size(), glb.moments() * count * sizeof(Vec3));
  if (bytes.size() != glb.moments() * count * sizeof(Vec3)) return 1.0;
  std::vector<Vec3> seen(count);
  double worst = 0.0;
  for (std::size_t m = 0; m < glb.moments(); ++m) {
    std::memcpy(seen.data()->data(), bytes.data() + m * count * sizeof(Vec3), count * sizeof(Vec3));
    const std::vector<Vec3> ours = glb.at(m);
    for (std::size_t i = 0; i < count; ++i) worst = std::max(worst, (seen[i] - ours[i]).norm());
  }
  return worst;
}

TEST(GltfInBlender, MovesAsOurSkinningWhereInstalled) {
  if (!does("command -v blender"))
    GTEST_SKIP()
        << "needs Debian's blender, which no script here installs: hundreds of megabytes for one test";
  const double size = std::sqrt(1.0 + 0.04 + 0.04);  // of the tube
  const std::pair<const char*, Json> scenes[] = {{"bending", bending()}, {"forked", forked()}};
  for (const auto& [name, scene] : scenes) {
    const Folder folder;
    const double off = blender_off_by(folder, scene) / size;
    EXPECT_LT(off, 1e-6) << name;
    std::cout << name << ": Blender is " << off << " of the size off our skinning\n";
  }
}

bool has_dinosaur() {
  return std::filesystem::exists(TENDRIL_CGAL_MESHES "/diplodocus.off");
}

/// The example of the README, with both films.
struct Dinosaur {
  Folder folder;
  Json summary;

  Dinosaur() {
    std::filesystem::copy(TENDRIL_CGAL_MESHES "/diplodocus.off", folder.path());
    const Outcome rig = folder.run("rig diplodocus.off --size 1.5 --wind 12 --out scene.json");
    EXPECT_EQ(rig.code, 0) << rig.err;
    const std::string player = TENDRIL_HAS_PLAYER != 0 ? " --player" : "";
    const Outcome run = folder.run("run scene.json --out scene --double --no-pictures --gltf" + player);
    EXPECT_EQ(run.code, 0) << run.err;
    std::cout << run.out;
    summary = Json::parse(bytes_of(folder / "scene/summary.json"));
  }

  std::vector<Vec3> frame(std::size_t moment) const {
    return bind::read_mesh(folder / ("scene/" + frame_name(moment))).points;
  }
};

/// Index of the nearest of some points, for each of others.
std::vector<std::size_t> nearest(const std::vector<Vec3>& points, const std::vector<Vec3>& others) {
  std::vector<std::size_t> order(points.size()), out;
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return points[a].x() < points[b].x(); });
  for (const Vec3& p : others) {
    constexpr double kNear = 1e-5;  // beyond single precision's rounding
    auto at = std::lower_bound(order.begin(), order.end(), p.x() - kNear,
                               [&](std::size_t i, double x) { return points[i].x() < x; });
    std::size_t best = *std::min(at, order.end() - 1);
    for (; at != order.end() && points[*at].x() <= p.x() + kNear; ++at)
      if ((points[*at] - p).norm() < (points[best] - p).norm()) best = *at;
    out.push_back(best);
  }
  return out;
}

constexpr const char* kNeeds =
    "needs tendril::axis, and the meshes of libcgal-demo, which tests/run.sh unpacks";

TEST(DinosaurFilms, SkinKeepsItsToleranceWithFewJoints) {
  if (!has_dinosaur()) GTEST_SKIP() << kNeeds;
  const Dinosaur run;
  const Json notes = run.summary["gltf"];
  EXPECT_TRUE(notes["within_tolerance"]);
  EXPECT_LE(notes["joints"], 40);
  const GlbReader glb(bytes_of(run.folder / "scene/scene.glb"));
  const std::vector<Vec3> rest = bind::read_mesh(run.folder / "diplodocus.off").points;
  const std::vector<std::size_t> of = nearest(rest, glb.rest());
  const double size = bind::bounding_diagonal(rest);
  double worst = 0.0;
  for (std::size_t m = 0; m < glb.moments(); ++m) {
    const std::vector<Vec3> exact = run.frame(m), seen = glb.at(m);
    for (std::size_t i = 0; i < seen.size(); ++i)
      worst = std::max(worst, (seen[i] - exact[of[i]]).norm() / size);
  }
  EXPECT_NEAR(worst, notes["max_error"].get<double>(), 1e-6);
  EXPECT_LE(worst, 1e-3);
  std::cout << notes["joints"] << " joints, " << worst << " of the size, "
            << std::filesystem::file_size(run.folder / "scene/scene.glb") << " bytes\n";
}

TEST(DinosaurFilms, PageIsSmallAndItsVerticesTheLibrarys) {
  if (!has_dinosaur()) GTEST_SKIP() << kNeeds;
  if (!can_play()) GTEST_SKIP() << kToPlay;
  const Dinosaur run;
  const auto bytes = std::filesystem::file_size(run.folder / "scene/scene.html");
  EXPECT_LE(bytes, 1500000u);
  const Json page = play(run.folder, {"scene"}).at(0);
  EXPECT_EQ(page["faults"], Json::array());
  double worst = 0.0;
  for (const std::size_t moment : page["moments"])
    worst = std::max(worst, shader_error(run.folder, "diplodocus.off", "scene", moment));
  EXPECT_LT(worst, 5e-7);
  std::cout << bytes << " bytes; vertices " << worst << " of the size from the library's\n";
}

}  // namespace
}  // namespace tendril::test
