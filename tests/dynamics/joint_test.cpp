#include <gtest/gtest.h>

#include "support/equilibria.h"
#include "support/vibrations.h"

// Joined pieces of one rod are that rod, at rest and in motion, and a branch passes its moment on.
namespace tendril {
namespace {

constexpr double kYoung = 1e8, kShear = kYoung / 2.6, kRadius = 0.01;

Rod piece(const Vec3& from, const Vec3& to, int edges) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.push_back(from + static_cast<double>(i) / edges * (to - from));
  return make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {kYoung, kShear, 1000},
                  circular_section(kRadius));
}

/// A cantilever of unit length along x in equal pieces.
Scene cantilever(int pieces, int edges) {
  Scene scene;
  for (int k = 0; k < pieces; ++k) {
    const double from = static_cast<double>(k) / pieces, to = (k + 1.0) / pieces;
    scene.rods.push_back(piece(Vec3(from, 0, 0), Vec3(to, 0, 0), edges / pieces));
    const auto child = static_cast<std::size_t>(k);
    if (k > 0) scene.joints.push_back({child - 1, static_cast<std::size_t>(edges / pieces), child});
  }
  scene.anchors.push_back({0, 0, true, true, {}});
  return scene;
}

std::shared_ptr<const Force> at_tip(const Scene& scene, PointLoad::Kind kind, const Vec3& load) {
  return std::make_shared<PointLoad>(kind, scene.rods.size() - 1, scene.rods.back().p.size() - 1, load,
                                     Signal::constant(1.0));
}

TEST(Joint, MakesTenPiecesOneRodAtRest) {
  Vec3 tips[2];
  for (const int pieces : {1, 10}) {
    Scene scene = cantilever(pieces, 40);
    scene.forces = {at_tip(scene, PointLoad::Kind::force, Vec3(0.02, -0.4, 0.3))};
    tips[pieces / 10] = test::tip(test::balanced(System(scene)));
  }
  std::printf("ten pieces: tip off by %.1e of the length\n", (tips[0] - tips[1]).norm());
  EXPECT_GT(std::abs(tips[0].y()), 0.1);
  EXPECT_LT((tips[0] - tips[1]).norm(), 1e-8);
}

/// Bending and torsion, with the inertia of the joined nodes.
TEST(Joint, MakesTenPiecesOneRodInMotion) {
  Eigen::VectorXd frequency[2];
  for (const int pieces : {1, 10}) {
    Scene scene = cantilever(pieces, 40);
    scene.twist = Scene::Twist::everywhere;
    const System system(scene);
    const auto all = [](Eigen::Index) { return true; };
    frequency[pieces / 10] = test::vibrations(system, system.rest_state(), all).frequency.head(30);
  }
  const double off = (frequency[1].cwiseQuotient(frequency[0]).array() - 1.0).abs().maxCoeff();
  std::printf("ten pieces: 30 frequencies from %.1f to %.1f off by at most %.1e\n", frequency[0][0],
              frequency[0][29], off);
  EXPECT_LT(off, 1e-6);
}

/// A branch halfway up a clamped stem, at right angles to it, loaded at its end along the stem or across
/// both. Beams: b^3 / 3 B + b^2 a / B + a / E A along it, b^3 / 3 B + a^3 / 3 B + b^2 a / C across.
TEST(Joint, PassesTheMomentOfABranchIntoTheStem) {
  const double area = std::numbers::pi * kRadius * kRadius, second = 0.25 * area * kRadius * kRadius;
  const double bending = kYoung * second, torsion = 2 * kShear * second, a = 0.5, b = 0.5, load = 1e-5;
  const double exact[] = {load * ((b * b * b / 3 + b * b * a) / bending + a / (kYoung * area)),
                          load * ((b * b * b + a * a * a) / (3 * bending) + b * b * a / torsion)};
  for (const Eigen::Index way : {0, 1}) {
    std::vector<double> error;
    for (const int edges : {16, 32, 64}) {
      Scene scene;
      scene.rods = {piece(Vec3::Zero(), Vec3::UnitX(), edges),
                    piece(Vec3(a, 0, 0), Vec3(a, 0, b), edges / 2)};
      scene.joints.push_back({0, static_cast<std::size_t>(edges / 2), 1});
      scene.anchors.push_back({0, 0, true, true, {}});
      scene.forces = {at_tip(scene, PointLoad::Kind::force, load * Vec3::Unit(way))};
      const Vec3 moved = test::tip(test::balanced(System(scene))) - scene.rods[1].p.back();
      error.push_back(moved[way] / exact[way] - 1);
    }
    std::printf("branch, way %d: %.1e %.1e %.1e, order %.2f\n", static_cast<int>(way), error[0], error[1],
                error[2], test::order(error[1], error[2]));
    EXPECT_LT(std::abs(error[2]), 3e-4);
    EXPECT_GT(test::order(error[1], error[2]), 1.9);
  }
}

}  // namespace
}  // namespace tendril
