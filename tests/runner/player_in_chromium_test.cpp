#include <gtest/gtest.h>
#include <tendril/bind/import.h>

#include <cstring>
#include <iostream>

#include "runner/bending.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

Json with_degree(Json scene, int degree) {
  scene["simulation"]["degree"] = degree;
  return scene;
}

bool can_play() {
  return does("command -v node") && does("command -v chromium") &&
         std::filesystem::exists(TENDRIL_NPM "/playwright-core");
}

/// What tests/runner/films/play.cjs saw of pages, in order.
Json play(const Folder& folder, const std::vector<std::string>& names) {
  std::string command = "cd '" + folder.path().string() +
                        "' && node '" TENDRIL_SOURCE_DIR "/tests/runner/films/play.cjs' '" TENDRIL_NPM
                        "' \"$(command -v chromium)\" .";
  for (const std::string& name : names) command += " " + name + "/" + name + ".html";
  EXPECT_EQ(std::system((command + " > seen.json").c_str()), 0);
  return Json::parse(bytes_of(folder / "seen.json"));
}

/// Largest distance of the page's vertices from the run's, over the mesh's size.
double shader_error(const Folder& folder, const std::string& name, std::size_t moment) {
  const std::string bytes = bytes_of(folder / (name + "_" + std::to_string(moment) + ".f32"));
  std::vector<float> seen(bytes.size() / 4);
  std::memcpy(seen.data(), bytes.data(), bytes.size());
  const std::vector<Vec3> rest = bind::read_mesh(folder / "tube.off").points;
  const std::vector<Vec3> exact = bind::read_mesh(folder / (name + "/" + frame_name(moment))).points;
  EXPECT_EQ(seen.size(), 4 * exact.size());
  Vec3 low = rest.front(), high = low;
  for (const Vec3& p : rest) low = low.cwiseMin(p), high = high.cwiseMax(p);
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Vec3 now = Eigen::Map<const Eigen::Vector3f>(seen.data() + 4 * i).cast<double>();
    worst = std::max(worst, (now - (exact[i] - 0.5 * (low + high)) / (high - low).norm()).norm());
  }
  return worst;
}

TEST(PlayerInChromium, VerticesInThePageAreTheLibrarysAndItPlays) {
  if (!can_play())
    GTEST_SKIP() << "needs node, Debian's chromium, and playwright-core of npm in " TENDRIL_NPM
                    ", which tests/run.sh --long installs";
  const Folder folder;
  std::vector<std::string> names;
  for (int degree = 1; degree <= 5; ++degree) {
    names.push_back("degree" + std::to_string(degree));
    make_page(folder, names.back(), with_degree(bending(), degree), tube_off(41));
  }
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
      worst = std::max(worst, shader_error(folder, name, moment));
    EXPECT_LT(worst, 5e-7) << name;
    std::cout << name << ": " << worst << " of the size from the library's vertices\n";
  }
  const Json& last = seen.back();
  EXPECT_EQ(last["stepped"], 1);
  EXPECT_TRUE(last["playing"]);
  EXPECT_TRUE(last["paused"]);
  EXPECT_EQ(last["ended"], 12);
  EXPECT_EQ(last["switches"], Json({"mesh", "curve-pairs", "frames", "tubes", "ambiguous"}));
  for (const std::string look : {"_all.png", "_light.png", "_dark.png"})
    EXPECT_GT(std::filesystem::file_size(folder / ("blended" + look)), 20000u) << look;
}

}  // namespace
}  // namespace tendril::test
