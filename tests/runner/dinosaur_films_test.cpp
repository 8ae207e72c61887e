#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <optional>

#include "runner/chromium.h"
#include "runner/glb_reader.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// The example of the README, with both films.
struct Dinosaur {
  Folder folder;
  Json summary;

  Dinosaur() {
    std::filesystem::copy(TENDRIL_CGAL_MESHES "/diplodocus.off", folder.path());
    const Outcome rig = folder.run("rig diplodocus.off --size 1.5 --wind 12 --out scene.json");
    EXPECT_EQ(rig.code, 0) << rig.err;
    const Outcome run = folder.run("run scene.json --out scene --double --no-pictures --gltf --player");
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

TEST(DinosaurFilms, SkinKeepsItsToleranceWithFewJoints) {
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
  if (!can_play())
    GTEST_SKIP() << "needs node, Debian's chromium, and playwright-core of npm in " TENDRIL_NPM
                    ", which tests/run.sh --long installs";
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
