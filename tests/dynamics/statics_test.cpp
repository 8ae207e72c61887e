#include "support/equilibria.h"

namespace tendril {
namespace {

using test::balanced;
using test::order;

Equilibrium clamped(Rod rod, std::vector<std::shared_ptr<const Force>> forces) {
  Scene scene;
  scene.rods.push_back(std::move(rod));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces = std::move(forces);
  return balanced(System(scene));
}

Vec3 tip(const Equilibrium& found) {
  return test::at(found.state.y, found.state.tangent.size() - 1);
}

struct Elastica {
  const char* name;
  double load, drop, shortening, tolerance;
};
void PrintTo(const Elastica& exact, std::ostream* out) {
  *out << exact.name << ' ' << exact.load;
}

class Cantilever : public testing::TestWithParam<Elastica> {};
// Elliptic integrals for the tip load P L^2 / E I; shooting for the weight q L^3 / E I.
INSTANTIATE_TEST_SUITE_P(Statics, Cantilever,
                         testing::Values(Elastica{"tip", 1, 0.3017207738, 0.05643323628, 1.5e-4},
                                         Elastica{"tip", 5, 0.7137915236, 0.3876283607, 5e-4},
                                         Elastica{"tip", 10, 0.8106090249, 0.5549955978, 5.5e-4},
                                         Elastica{"weight", 1, 0.123471402, 0.008753605, 1.5e-4},
                                         Elastica{"weight", 5, 0.495905045, 0.153342820, 5e-4},
                                         Elastica{"weight", 10, 0.700199716, 0.343646239, 6e-4}),
                         [](const auto& one) {
                           return one.param.name + std::to_string(static_cast<int>(one.param.load));
                         });

/// (drop, shortening)
Eigen::Vector2d bent(const Elastica& exact, int edges) {
  Rod rod = test::unit_rod(edges);
  const double mass = std::accumulate(rod.mass.begin(), rod.mass.end(), 0.0);
  std::shared_ptr<const Force> force = std::make_shared<Gravity>(Vec3(0, 0, -exact.load / mass));
  if (std::string(exact.name) == "tip")
    force = test::point_load(PointLoad::Kind::force, edges, Vec3(0, 0, -exact.load));
  const Equilibrium found = clamped(std::move(rod), {force});
  EXPECT_EQ(found.stability.kind, Stability::Kind::stable);
  EXPECT_NEAR(found.support[0].z(), exact.load, 1e-5 * exact.load);
  return {-tip(found).z(), 1 - tip(found).x()};
}

TEST_P(Cantilever, ConvergesAtOrderTwoAndExtrapolates) {
  const Eigen::Vector2d exact(GetParam().drop, GetParam().shortening);
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  double before = 0.0;
  for (const int edges : {16, 32, 64, 128, 256}) {
    const Eigen::Vector2d now = bent(GetParam(), edges);
    const double error = (now - exact).norm();
    const double extrapolated = ((4 * now - last) / 3 - exact).norm();
    std::printf("%d edges: error %.2e of the length, order %.3f, extrapolated %.1e\n", edges, error,
                order(before, error), extrapolated);
    if (edges == 32) EXPECT_LT(error, GetParam().tolerance);
    if (edges >= 64) EXPECT_NEAR(order(before, error), 2.0, 0.05);
    if (edges >= 64) EXPECT_LT(extrapolated, 1e-6);
    last = now;
    before = error;
  }
}

TEST(SmallDeflection, MatchesBeamTheory) {
  const double load = 1e-3;
  double error[2][2];
  for (int i = 0; i < 2; ++i) {
    const int edges = i == 0 ? 32 : 64;
    const Equilibrium end =
        clamped(test::unit_rod(edges), {test::point_load(PointLoad::Kind::force, edges, Vec3(0, 0, -load))});
    error[0][i] = -tip(end).z() / (load / 3) - 1;
    Rod rod = test::unit_rod(edges);
    const double mass = std::accumulate(rod.mass.begin(), rod.mass.end(), 0.0);
    const Equilibrium spread = clamped(std::move(rod), {std::make_shared<Gravity>(Vec3(0, 0, -load / mass))});
    error[1][i] = -tip(spread).z() / (load / 8) - 1;
    std::printf("%d edges: relative error %.2e (end), %.2e (spread)\n", edges, error[0][i], error[1][i]);
  }
  // A chain of hinges with half-edge clamps: 1 / (2 N^2) for the load at the end.
  EXPECT_NEAR(error[0][0], 0.5 / (32 * 32), 1e-6);
  EXPECT_NEAR(order(error[0][0], error[0][1]), 2.0, 0.02);
  EXPECT_NEAR(order(error[1][0], error[1][1]), 2.0, 0.02);
}

TEST(EndMoment, ClosesTheCircleAndBendsTheHalfCircle) {
  const auto moment = [](int edges, double turn) {
    return clamped(test::unit_rod(edges),
                   {test::point_load(PointLoad::Kind::torque, edges, Vec3(0, -turn, 0))});
  };
  const double pi = std::numbers::pi;
  const Equilibrium circle = moment(64, 2 * pi);
  EXPECT_FALSE(circle.conservative);
  std::printf("circle: open by %.1e of the length\n", tip(circle).norm());
  EXPECT_LT(tip(circle).norm(), 1e-12);
  double error[2];
  for (int i = 0; i < 2; ++i) error[i] = (tip(moment(32 << i, pi)) - Vec3(0, 0, 2 / pi)).norm();
  std::printf("half circle: error %.2e, order %.3f\n", error[1], order(error[0], error[1]));
  EXPECT_LT(error[1], 1e-3);
  EXPECT_NEAR(order(error[0], error[1]), 2.0, 0.05);
}

TEST(AnisotropicSection, BendsAboutBothAxesByTheirOwnStiffness) {
  const double a = 0.02, b = 0.01, young = 1e7, load = 1e-4;
  const std::vector<Vec3> p = test::straight(64, 1.0);
  const Rod rod = make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {young, young / 3, 1000},
                           rectangular_section(a, b));
  const Equilibrium found = clamped(rod, {test::point_load(PointLoad::Kind::force, 64, Vec3(0, load, load))});
  // The director is towards z, so b is the size along z and l lies along y.
  const Vec3 expected(0, load / (3 * young * b * a * a * a / 12), load / (3 * young * a * b * b * b / 12));
  const double hinges = 1 + 0.5 / (64 * 64);
  EXPECT_NEAR(tip(found).y() / expected.y(), hinges, 1e-4);
  EXPECT_NEAR(tip(found).z() / expected.z(), hinges, 1e-4);
}

/// A quarter of a circle of unit length in the plane x z.
std::vector<Vec3> quarter(int edges) {
  const double half = std::numbers::pi / 4 / edges;
  std::vector<Vec3> p{Vec3::Zero()};
  for (int i = 0; i < edges; ++i) {
    const double angle = (2 * i + 1) * half;
    p.push_back(p.back() + Vec3(std::cos(angle), 0, std::sin(angle)) / edges);
  }
  return p;
}

TEST(CurvedLeaf, RestsAsItGrewAndUncurlsUnderTheMomentOfItsCurvature) {
  const int edges = 40;
  const std::vector<Vec3> p = quarter(edges);
  // Unit bending stiffness; the clamp's tangent is the first edge's, so the first half hinge is straight.
  const double r = 1e-3, young = 4 / (std::numbers::pi * std::pow(r, 4));
  const Rod rod =
      make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {young, young / 3, 1000}, circular_section(r));
  const Equilibrium rest = clamped(rod, {});
  EXPECT_LT((tip(rest) - p.back()).norm(), 1e-14);
  EXPECT_EQ(rest.stability.kind, Stability::Kind::stable);
  EXPECT_EQ(rest.iterations, 0);
  // Each hinge, of two springs 2 E I / h in series, opens by its turn h pi / 2 under a moment E I pi / 2. The
  // clamp's half hinge, straight at rest, bends back by half of that.
  const double moment = std::numbers::pi / 2;
  const Equilibrium flat =
      clamped(rod, {test::point_load(PointLoad::Kind::torque, edges, Vec3(0, moment, 0))});
  const double back = std::numbers::pi / 4 / edges;
  const double begin = back - std::numbers::pi / 4 / edges;
  EXPECT_LT((tip(flat) - Vec3(std::cos(begin), 0, std::sin(begin))).norm(), 1e-4);
}

TEST(Catenary, HangsASlackChain) {
  struct Case {
    double length, sag, tension;
  };
  for (const Case& exact : {Case{1.1, 0.2003007907, 0.7775133985}, Case{2, 0.7963883559, 0.5130142855}}) {
    const int edges = 96;
    Scene scene;
    scene.rods.push_back(test::round_rod(edges, exact.length, 0.0, 0.0, 1e5));
    scene.rods[0].mass.front() = scene.rods[0].mass.back() = 0.5 * exact.length / edges;
    scene.anchors.push_back({0, 0, true, false, {}});
    Anchor moved = test::mover(edges, Vec3(exact.length, 0, 0), Vec3(1 - exact.length, 0, 0), 0.0);
    moved.holds_frame = false;
    scene.anchors.push_back(moved);
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -1)));
    StaticsOptions options;
    options.until = 1.0;
    const Equilibrium found = balanced(System(scene), options);
    const double sag = -test::at(found.state.y, edges / 2).z();
    const double tension = found.support[0].norm() / exact.length;
    std::printf("chain of %.1f spans: sag %.6f (error %.1e), end tension error %.1e\n", exact.length, sag,
                sag - exact.sag, tension - exact.tension);
    EXPECT_NEAR(sag, exact.sag, 1e-4);
    EXPECT_NEAR(tension, exact.tension, 1e-4);
    EXPECT_EQ(found.stability.kind, Stability::Kind::stable);
  }
}

}  // namespace
}  // namespace tendril
