#include <gtest/gtest.h>
#include <tendril/scene/scene_run.h>

#include <functional>
#include <nlohmann/json.hpp>

namespace tendril::test {
namespace {

using Json = nlohmann::json;

constexpr double kRadius = 0.01;  // of the rod

/// A solid below the origin that touches it there, and how far a point is from it.
struct Below {
  const char* name;
  const char* body;
  std::function<double(const Vec3&)> distance;
};
void PrintTo(const Below& below, std::ostream* out) {
  *out << below.name;
}

double to_box(const Vec3& p) {
  return ((p - Vec3(0, 0, -0.1)).cwiseAbs() - Vec3::Constant(0.1)).cwiseMax(0.0).norm();
}

class FallingRod : public testing::TestWithParam<Below> {};

/// With the stiffness that the reader chooses: what falls on its side, aslant or on its tip is stopped, by
/// whatever is there.
TEST_P(FallingRod, IsStoppedHoweverItLands) {
  for (const char* points : {"[[-0.5, 0, 0.4], [0.5, 0, 0.4]]", "[[0, 0, 0.4], [0.8, 0.02, 1.0]]",
                             "[[0.01, 0, 0.4], [0.01, 0.003, 1.4]]"}) {
    Json scene = Json::parse(R"({
      "version": 1,
      "curve_pairs": [{"name": "rod", "nodes": 9, "orientation": [0, 1, 0],
        "material": {"young": 1e9, "poisson": 0.35, "density": 1000},
        "section": {"type": "circular", "radius": 0.01}}],
      "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
      "simulation": {"duration": 0.6, "tolerance": 1e-3, "frames": 61}
    })");
    scene["curve_pairs"][0]["points"] = Json::parse(points);
    scene["bodies"] = Json::array({Json::parse(GetParam().body)});
    scene::SceneRun run(scene::parse_scene(scene.dump(1), "scene.json"));
    double least = 1.0;
    const Report report = run.run([&](const scene::Snapshot& now) {
      for (const Vec3& p : now.masses[0]) least = std::min(least, GetParam().distance(p) - kRadius);
    });
    EXPECT_EQ(report.stop, Stop::finished) << points << ": " << report.reason;
    EXPECT_GT(least, 0.0) << points;
    EXPECT_LT(least, 0.05) << points;  // it came near
    EXPECT_LT(std::abs(report.imbalance), 0.01) << points;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Solids, FallingRod,
    testing::Values(
        Below{"floor", R"({"shape": {"type": "half_space"}})", [](const Vec3& p) { return p.z(); }},
        Below{"ball", R"({"shape": {"type": "ball", "radius": 0.1}, "position": [0, 0, -0.1]})",
              [](const Vec3& p) { return (p - Vec3(0, 0, -0.1)).norm() - 0.1; }},
        Below{"box", R"({"shape": {"type": "box", "size": [0.2, 0.2, 0.2]}, "position": [0, 0, -0.1]})",
              to_box}),
    [](const auto& at) { return at.param.name; });

}  // namespace
}  // namespace tendril::test
