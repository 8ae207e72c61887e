#include <gtest/gtest.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/scene/scene_run.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "rod_scene.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

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

Json falling(const char* points) {
  Json scene = rod_scene(points, 1e9);
  let_fall(scene);
  scene["simulation"] = {{"duration", 0.6}, {"tolerance", 1e-3}, {"frames", 61}};
  return scene;
}

constexpr const char* kOnItsSide = "[[-0.5, 0, 0.4], [0.5, 0, 0.4]]";
constexpr const char* kAslant = "[[0, 0, 0.4], [0.8, 0.02, 1.0]]";
constexpr const char* kOnItsTip = "[[0.01, 0, 0.4], [0.01, 0.003, 1.4]]";

/// With the stiffness that the reader chooses: what falls is stopped, by whatever is there.
TEST_P(FallingRod, IsStoppedHoweverItLands) {
  for (const char* points : {kOnItsSide, kAslant, kOnItsTip}) {
    Json scene = falling(points);
    scene["bodies"] = Json::array({Json::parse(GetParam().body)});
    scene::SceneRun run(parsed(scene));
    double least = 1.0;
    const Report report = run.run([&](const scene::Snapshot& now) {
      for (const Vec3& p : now.masses[0]) least = std::min(least, GetParam().distance(p) - kRodRadius);
    });
    EXPECT_EQ(report.stop, Stop::finished) << points << ": " << report.reason;
    EXPECT_GT(least, 0.0) << points;
    EXPECT_LT(least, 0.05) << points;  // it came near
    EXPECT_LT(std::abs(report.imbalance), 0.01) << points;
  }
}

/// A closed box about a rod upright, its lid a pyramid.
bind::PolygonMesh post() {
  bind::PolygonMesh mesh;
  mesh.points = {{0.01, 0, 0.37}};
  for (int i = 0; i <= 10; ++i)
    for (int k = 0; k < 4; ++k)
      mesh.points.emplace_back(0.01 + 0.02 * (k == 0) - 0.02 * (k == 2), 0.02 * (k == 1) - 0.02 * (k == 3),
                               0.4 + 0.1 * i);
  const auto face = [&](std::initializer_list<int> corners) {
    for (const int corner : corners) mesh.corners.push_back(static_cast<std::uint32_t>(corner));
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  };
  mesh.face_begin = {0};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    face({0, 1 + next, 1 + k});
    for (int i = 0; i < 10; ++i) face({1 + 4 * i + k, 1 + 4 * i + next, 5 + 4 * i + next, 5 + 4 * i + k});
  }
  face({41, 42, 43, 44});
  return mesh;
}

TEST_P(FallingRod, IsStoppedByACornerOfItsMesh) {
  Json scene = falling(kOnItsTip);
  scene["bodies"] = Json::array({Json::parse(GetParam().body)});
  scene["contact"] = {{"of", "mesh"}, {"skin", 0.002}};
  scene::SceneRun run(parsed(scene), post());
  double least = 1.0;
  const Report report = run.run([&](const scene::Snapshot& now) {
    for (const Vec3& p : now.points) least = std::min(least, GetParam().distance(p));
  });
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0.05);
}

TEST(FallingRodOnARod, IsStoppedAcrossItAndByItsTip) {
  for (const char* points : {kOnItsSide, kAslant, kOnItsTip}) {
    Json scene = falling(points);
    Json bar = scene["curve_pairs"][0];
    bar["name"] = "bar";
    bar["points"] = Json::parse("[[0.003, -0.5, -0.02], [0.003, 0.5, -0.02]]");
    bar["orientation"] = Json::parse("[1, 0, 0]");
    bar["anchors"] = Json::parse(R"([{"nodes": [0, 8]}])");
    scene["curve_pairs"].push_back(bar);
    scene["self_contact"] = Json::object();
    scene::SceneRun run(parsed(scene));
    double least = 1.0;
    const Report report = run.run([&](const scene::Snapshot& now) {
      const std::vector<Vec3>& with = now.masses[1];
      for (const Vec3& p : now.masses[0])
        for (std::size_t i = 0; i + 1 < with.size(); ++i) {
          const Vec3 edge = with[i + 1] - with[i];
          const double at = std::clamp((p - with[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
          least = std::min(least, (p - with[i] - at * edge).norm());
        }
    });
    EXPECT_EQ(report.stop, Stop::finished) << points << ": " << report.reason;
    EXPECT_GT(least, 2 * kRodRadius) << points;
    EXPECT_LT(least, 0.06) << points;  // it came near
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
