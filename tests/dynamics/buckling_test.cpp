#include "support/equilibria.h"

namespace tendril {
namespace {

using test::balanced;
using test::order;
constexpr double kPi = std::numbers::pi;

/// A pinned rod of unit length and stiffness, its ends brought together to `distance`: the end force over the
/// critical one.
double pinned(int edges, double distance) {
  Scene scene;
  scene.rods.push_back(test::unit_rod(edges, 1e-3));
  scene.anchors.push_back({0, 0, true, false, {}});
  const auto last = static_cast<std::size_t>(edges);
  Anchor moved = test::mover(last, Vec3::UnitX(), Vec3(distance - 1, 0, 0), 0.0);
  moved.holds_frame = false;
  scene.anchors.push_back(moved);
  StaticsOptions options;
  options.until = 1.0;
  const Equilibrium found = balanced(System(scene), options);
  EXPECT_GE(found.left, 1);
  EXPECT_EQ(found.stability.unstable, 0);
  return found.support[0].x() / (kPi * kPi);
}

struct Pinned {
  int degrees;
  double force, distance;
};
void PrintTo(const Pinned& exact, std::ostream* out) {
  *out << exact.degrees << " degrees";
}
class PostBuckling : public testing::TestWithParam<Pinned> {};
// End angle, P / P_critical and end distance by elliptic integrals.
INSTANTIATE_TEST_SUITE_P(Pinned, PostBuckling,
                         testing::Values(Pinned{20, 1.01539687, 0.96973091},
                                         Pinned{40, 1.06366327, 0.88120351},
                                         Pinned{90, 1.39320393, 0.45694658},
                                         Pinned{120, 1.88480087, 0.12315997}),
                         [](const auto& one) { return std::to_string(one.param.degrees); });

TEST_P(PostBuckling, CarriesTheForceOfTheElastica) {
  double error[2];
  for (int i = 0; i < 2; ++i) error[i] = pinned(32 << i, GetParam().distance) - GetParam().force;
  std::printf("%d degrees: P / P_critical off by %.2e, order %.2f\n", GetParam().degrees, error[1],
              order(error[0], error[1]));
  EXPECT_LT(std::abs(error[1]), 2e-3 * GetParam().force);
  EXPECT_NEAR(order(error[0], error[1]), 2.0, 0.1);
}

/// Critical weight q L^3 / E I of an upright clamped column, where its smallest eigenvalue vanishes.
double self_buckling(int edges) {
  Scene scene;
  scene.rods.push_back(test::unit_rod(edges, 1e-3));
  const std::vector<double>& mass = scene.rods[0].mass;
  const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(-1 / total, 0, 0)));
  const System system(scene);
  const auto smallest = [&](double weight) {
    StaticsOptions options;
    options.seek = StaticsOptions::Seek::nearest;
    options.last_load = weight;
    const Equilibrium found = balanced(system, options);
    EXPECT_EQ(found.stability.unstable > 0, found.stability.smallest < -found.stability.threshold);
    return found.stability.smallest;
  };
  EXPECT_GT(smallest(7.5), 0.0);
  EXPECT_LT(smallest(8.2), 0.0);
  return test::root_of(smallest, 7.5, 8.2, 1e-9);
}

TEST(Column, BucklesUnderItsOwnWeight) {
  double error[3];
  for (int i = 0; i < 3; ++i) {
    error[i] = self_buckling(25 << i) - 7.8373474389;
    std::printf("%d edges: critical weight off by %.2e\n", 25 << i, error[i]);
  }
  EXPECT_LT(std::abs(error[2]), 2e-3);
  EXPECT_NEAR(order(error[0], error[1]), 2.0, 0.05);
  EXPECT_NEAR(order(error[1], error[2]), 2.0, 0.05);
}

TEST(Column, LeavesTheUprightStateOnlyWhereItIsAskedForAStableOne) {
  Scene scene;
  scene.rods.push_back(test::unit_rod(20, 1e-3));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(test::point_load(PointLoad::Kind::force, 20, Vec3(-3, 0, 0)));  // critical: pi^2 / 4
  const System system(scene);
  StaticsOptions options;
  options.seek = StaticsOptions::Seek::nearest;
  const Equilibrium upright = balanced(system, options);
  EXPECT_EQ(upright.stability.kind, Stability::Kind::unstable);
  EXPECT_EQ(upright.stability.unstable, 2);  // both ways across
  EXPECT_EQ(upright.left, 0);
  options.seek = StaticsOptions::Seek::stable;
  const Equilibrium bent = balanced(system, options);
  EXPECT_EQ(bent.left, 1);
  EXPECT_EQ(bent.stability.unstable, 0);
  const Vec3 tip = test::at(bent.state.y, 20);
  EXPECT_GT(std::hypot(tip.y(), tip.z()), 0.3);
  EXPECT_LT(bent.elastic + bent.potential, upright.elastic + upright.potential - 0.01);
  // Deterministic: the same again, to the bit.
  EXPECT_EQ(balanced(system, options).state.y, bent.state.y);
}

}  // namespace
}  // namespace tendril
