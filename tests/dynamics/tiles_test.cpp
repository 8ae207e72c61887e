// Steps of large scenes are taken a range of nodes at a time; beside a free body, as a whole.
#include <gtest/gtest.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/forces.h>

#include <cmath>

#include "support/rods.h"

namespace tendril {
namespace {

using test::Random;

struct Twin {
  explicit Twin(Scene scene) : system(std::move(scene)), stepper(system), state(system.rest_state()) {}
  System system;
  CashKarp stepper;
  State state;
};

/// A scene in ranges, and as a whole.
struct Twins {
  explicit Twins(const Scene& scene) : tiled(scene), whole(beside_a_body(scene)) {}
  static Scene beside_a_body(Scene scene) {
    scene.bodies.push_back({});
    return scene;
  }
  /// The numbers of the whole are those of the tiled, the body's and the work.
  Eigen::Index shared() const { return tiled.state.y.size() - 1; }
  double step_size() const {
    return 1.0 / tiled.system.largest_frequency(tiled.state, 16, *tiled.system.make_workspace());
  }
  /// Gives all nodes random velocities, and those that have one a spin, the same in both.
  void push(Random& random, double speed, double spin) {
    const auto n = static_cast<Eigen::Index>(tiled.system.node_count());
    const auto m = static_cast<Eigen::Index>(tiled.system.twist_count());
    const auto push_at = [&](Eigen::Index i, double most) {
      tiled.state.y[i] = whole.state.y[i] = random.uniform(-most, most);
    };
    for (Eigen::Index i = 3 * n; i < 6 * n; ++i) push_at(i, speed);
    for (Eigen::Index i = 6 * n + m; i < 6 * n + 2 * m; ++i) push_at(i, spin);
    for (Twin* twin : {&tiled, &whole})
      ASSERT_TRUE(twin->system.rebase(twin->state, *twin->system.make_workspace()).ok());
  }

  Twin tiled, whole;
};

/// In parts of the largest number.
double off(const auto& a, const auto& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(b.cwiseAbs().maxCoeff(), 1e-300);
}

Eigen::Map<const Eigen::VectorXd> numbers(const std::vector<double>& v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

/// Some steps, each tried and then taken. To rounding: what a vector loop leaves over at its end is rounded
/// otherwise, and that end is elsewhere.
void expect_same(Twins& twins, double h) {
  const Eigen::Index n = twins.shared();
  Eigen::VectorXd y, y_whole, error, error_whole;
  for (int k = 0; k < 8; ++k) {
    ASSERT_TRUE(twins.tiled.stepper.step(twins.tiled.state, h, y, error).ok());
    ASSERT_TRUE(twins.whole.stepper.step(twins.whole.state, h, y_whole, error_whole).ok());
    EXPECT_LE(off(y.head(n), y_whole.head(n)), 1e-15) << "step " << k;
    EXPECT_LE(off(error.head(n), error_whole.head(n)), 1e-12) << "step " << k;
    twins.whole.stepper.restart();  // a tile's first stage is not kept
    ASSERT_TRUE(twins.tiled.stepper.advance(twins.tiled.state, h).ok());
    ASSERT_TRUE(twins.whole.stepper.advance(twins.whole.state, h).ok());
    const State& a = twins.tiled.state;
    const State& b = twins.whole.state;
    EXPECT_LE(off(a.y.head(n), b.y.head(n)), 1e-15) << "step " << k;
    EXPECT_LE(farthest(a.tangent, b.tangent) + farthest(a.director, b.director), 1e-14) << "step " << k;
    EXPECT_LE(off(numbers(a.twist), numbers(b.twist)), 1e-14) << "step " << k;
  }
  EXPECT_EQ(twins.tiled.stepper.evaluations(), twins.whole.stepper.evaluations());
  const double work = twins.whole.state.y[twins.whole.state.y.size() - 1];
  EXPECT_NEAR(twins.tiled.state.y[n], work, 1e-12 * std::abs(work));
}

Rod moved(Rod rod, const Vec3& by) {
  for (auto* points : {&rod.p, &rod.q})
    for (Vec3& p : *points) p += by;
  return rod;
}

/// Five thousand nodes with springs of all kinds, held in all ways, at ends and within.
Scene uneven_scene(Random& random) {
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 5000));
  scene.rods[0].mass_damping = 0.4;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.anchors.push_back({.rod = 0, .node = 1020, .holds_frame = false});
  scene.anchors.push_back({.rod = 0, .node = 2051, .holds_position = false});
  scene.anchors.push_back({.rod = 0, .node = 3070});
  const System rest{Scene{{scene.rods[0]}, {}, {}, {}}};
  const Frame frame = rest.frames(rest.rest_state(), *rest.make_workspace())[3070];
  const Vec3 at = scene.rods[0].p[3070];
  scene.anchors[3].motion = [frame, at](double t) {
    const auto turned = [&](const Vec3& v) { return rotate_about(Vec3::UnitZ(), 3.0 * t, v); };
    return AnchorPose{at + t * Vec3(0.1, 0.2, -0.1),
                      {turned(frame.x), turned(frame.y), turned(frame.z)},
                      Vec3(0.1, 0.2, -0.1),
                      3.0 * Vec3::UnitZ()};
  };
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  return scene;
}

TEST(Tiles, StepUnevenRodsAsAWhole) {
  Random random(3);
  Twins twins(uneven_scene(random));
  twins.push(random, 0.1, 50.0);
  expect_same(twins, twins.step_size());
}

TEST(Tiles, StepALongChainWithoutTwistAsAWhole) {
  Random random(4);
  Scene scene;
  scene.rods.push_back(test::straight_rod(5000, 1e6, 2e-4));
  scene.rods[0].mass_damping = 0.1;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.anchors.push_back({.rod = 0, .node = 5000, .holds_frame = false});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  Twins twins(scene);
  ASSERT_EQ(twins.tiled.system.twist_count(), 0u);
  twins.push(random, 1e-4, 1e-2);
  expect_same(twins, twins.step_size());
}

/// Ranges of one shape, whose masses, springs and rest lengths are not the same.
TEST(Tiles, StepAFreeUnevenRodAsAWhole) {
  Random random(8);
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 7000));
  scene.rods[0].mass_damping = 0.3;
  Twins twins(scene);
  twins.push(random, 0.1, 50.0);
  expect_same(twins, twins.step_size());
}

TEST(Tiles, StepAFreeUnevenChainWithoutTwistAsAWhole) {
  Random random(9);
  Scene scene;
  scene.rods.push_back(test::straight_rod(7000, 1e6, 2e-4));
  Rod& rod = scene.rods[0];
  rod.mass_damping = 0.1;
  for (std::size_t i = 0; i < rod.p.size(); ++i) {
    rod.mass[i] *= random.uniform(1.0, 2.0);
    rod.bend_l[i] = rod.bend_m[i] = rod.bend_l[i] * random.uniform(0.5, 1.0);
  }
  for (double& stretch : rod.stretch) stretch *= random.uniform(0.5, 1.0);
  Twins twins(scene);
  ASSERT_EQ(twins.tiled.system.twist_count(), 0u);
  twins.push(random, 1e-4, 1e-2);
  expect_same(twins, twins.step_size());
}

Scene chain_with_twist(int edges) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(edges, 1e6, 2e-4));
  scene.twist = Scene::Twist::everywhere;
  return scene;
}

TEST(Tiles, StepALongChainWithTwistAsAWhole) {
  Random random(5);
  Twins twins(chain_with_twist(4300));
  twins.push(random, 1e-4, 1e-2);
  expect_same(twins, twins.step_size());
}

TEST(Tiles, StepManyRodsOfAllLengthsAsAWhole) {
  Random random(6);
  Scene scene;
  for (int k = 0; k < 300; ++k) {
    const int nodes = 2 + k % 61;
    Rod rod = k % 3 == 0 ? test::straight_rod(nodes, 1e5, 1e-2) : test::uneven_rod(random, nodes);
    rod.mass_damping = 0.01 * (k % 7);
    scene.rods.push_back(moved(std::move(rod), 3.0 * k * Vec3::UnitY()));
    if (k % 4 == 1) scene.anchors.push_back({.rod = static_cast<std::size_t>(k), .node = 0});
  }
  Twins twins(scene);
  ASSERT_GT(twins.tiled.system.node_count(), 4096u);
  ASSERT_GT(twins.tiled.system.twist_count(), 2048u);
  ASSERT_LT(twins.tiled.system.twist_count(), twins.tiled.system.node_count());
  twins.push(random, 0.1, 1.0);
  expect_same(twins, twins.step_size());
}

/// Where large angles begin and end another loop does them, in ranges at other places.
TEST(Tiles, StepPartlyBentRodsToRounding) {
  Random random(7);
  Twins twins(chain_with_twist(5000));
  for (Twin* twin : {&twins.tiled, &twins.whole})
    for (Eigen::Index i : {1010, 1500, 2047, 4500}) twin->state.y[3 * i + 2] += 3e-4;
  twins.push(random, 1e-4, 1e-2);
  const double h = twins.step_size();
  for (int k = 0; k < 20; ++k)
    for (Twin* twin : {&twins.tiled, &twins.whole}) ASSERT_TRUE(twin->stepper.advance(twin->state, h).ok());
  const Eigen::Index n = twins.shared();
  EXPECT_LE((twins.tiled.state.y.head(n) - twins.whole.state.y.head(n)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Tiles, NameTheNodeWhereAStepFails) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(5000, 1e6, 2e-4));
  Twins twins(scene);
  Eigen::VectorXd y, error;
  for (Twin* twin : {&twins.tiled, &twins.whole}) {
    twin->state.y.segment<3>(3 * 1701) = twin->state.y.segment<3>(3 * 1700).eval();
    const Evaluation at = twin->stepper.step(twin->state, 1e-6, y, error);
    EXPECT_EQ(at.outcome, Evaluation::Outcome::zero_edge);
    EXPECT_EQ(at.node, 1700u);
    const Evaluation after = twin->system.rebase(twin->state, *twin->system.make_workspace());
    EXPECT_EQ(after.outcome, Evaluation::Outcome::zero_edge);
    EXPECT_EQ(after.node, 1700u);
    const Evaluation taken = twin->stepper.advance(twin->state, 1e-6);
    EXPECT_EQ(taken.outcome, Evaluation::Outcome::zero_edge);
    EXPECT_EQ(taken.node, 1700u);
  }
}

}  // namespace
}  // namespace tendril
