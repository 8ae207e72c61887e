#include <gtest/gtest.h>

#include <iostream>

#include "runner/bending.h"
#include "runner/chromium.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

Json with_degree(Json scene, int degree) {
  scene["simulation"]["degree"] = degree;
  return scene;
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
  EXPECT_EQ(last["switches"], Json({"mesh", "curve-pairs", "frames", "tubes", "ambiguous"}));
  for (const std::string look : {"_all.png", "_light.png", "_dark.png"})
    EXPECT_GT(std::filesystem::file_size(folder / ("blended" + look)), 20000u) << look;
}

}  // namespace
}  // namespace tendril::test
