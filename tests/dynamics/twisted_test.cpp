#include "support/equilibria.h"

namespace tendril {
namespace {

using test::balanced;
using test::order;
constexpr double kPi = std::numbers::pi;

TEST(TwistedStrip, CarriesSeveralTurnsPerEdgeUnderTension) {
  // 20 turns over 8 edges, pulled tight enough to stay straight: M^2 < 4 B T.
  const double torsion = 0.7, tension = 1e4, pull = 0.3, turn = 40 * kPi;
  Scene scene;
  scene.rods.push_back(test::round_rod(8, 1.0, 1.0, torsion, tension));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.anchors.push_back(test::mover(8, Vec3::UnitX(), Vec3(pull, 0, 0), turn));
  const System system(scene);
  StaticsOptions options;
  options.until = 1.0;
  const Equilibrium found = balanced(system, options);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(found.state.twist[i], turn / 8, 1e-9);
  EXPECT_NEAR(found.elastic, 0.5 * torsion * turn * turn + 0.5 * tension * pull * pull, 1e-7 * found.elastic);
  EXPECT_NEAR(found.support[1].x(), tension * pull, 1e-7 * tension * pull);
  EXPECT_EQ(found.stability.kind, Stability::Kind::stable);
}

/// A straight rod bent into a ring of unit length, one end then turned about its tangent.
System ring_of(int edges, double bending, double torsion) {
  Scene scene;
  scene.rods.push_back(test::round_rod(edges, 1.0, bending, torsion, 1e5));
  scene.anchors.push_back({0, 0, true, true, {}});
  Anchor end{0, static_cast<std::size_t>(edges), true, true, {}};
  const Frame rest = frame_towards(Vec3::UnitX(), Vec3::UnitZ()).frame;
  // Until time 1 along circles of growing curvature in the plane of x and y, then about x at a rate of 1.
  end.motion = [=](double t) {
    const double s = std::clamp(t, 0.0, 1.0), a = 2 * kPi * s, spin = std::max(0.0, t - 1.0);
    const auto turned = [&](const Vec3& v) {
      return rotate_about(Vec3::UnitZ(), a, rotate_about(Vec3::UnitX(), spin, v));
    };
    AnchorPose pose;
    pose.position = a > 0.0 ? Vec3(std::sin(a) / a, (1 - std::cos(a)) / a, 0) : Vec3(Vec3::UnitX());
    pose.frame = {turned(rest.x), turned(rest.y), turned(rest.z)};
    pose.angular_velocity = t < 1.0 ? Vec3(0, 0, 2 * kPi) : Vec3(Vec3::UnitX());
    return pose;
  };
  scene.anchors.push_back(end);
  return System(scene);
}

/// Twist at which the flat ring's lowest eigenvalue vanishes, over the closed form's less 1, by a parabola
/// through three unstable flat rings. Below, the ring's roll about its own line is neutral and hides it.
double threshold(int edges, double bending, double torsion) {
  const System system = ring_of(edges, bending, torsion);
  const double exact = 2 * kPi * std::sqrt(3.0) * bending / torsion;
  StaticsOptions options;
  options.seek = StaticsOptions::Seek::nearest;
  const auto stability = [&](double share) {
    options.until = 1.0 + share * exact;
    return balanced(system, options).stability;
  };
  const Stability below = stability(0.97);
  EXPECT_EQ(below.unstable, 0);
  EXPECT_EQ(below.neutral, 1);
  double share[] = {1.015, 1.02, 1.025}, mu[3], root = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Stability above = stability(share[i]);
    EXPECT_EQ(above.unstable, 2);
    mu[i] = above.smallest;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    root += share[i] * mu[j] * mu[k] / ((mu[i] - mu[j]) * (mu[i] - mu[k]));
  }
  return root - 1;
}

TEST(MichellRing, WrithesAtTheClosedFormsTwist) {
  const double at50 = threshold(50, 1.0, 1.0);
  const double at100 = threshold(100, 1.0, 1.0);
  std::printf("threshold off by %.2e at 50 edges, %.2e at 100, order %.2f\n", at50, at100,
              order(at50, at100));
  EXPECT_LT(std::abs(at100), 5e-3);
  EXPECT_NEAR(order(at50, at100), 2.0, 0.2);
  EXPECT_LT(std::abs(threshold(100, 1.0, 0.8)), 5e-3);
}

// Localised helical buckling (van der Heijden and Thompson 2000; Coyne 1990): L = 100, B = 1.345, C = 0.789,
// the ends 3 nearer and turned by 27 turns.
struct Coil {
  double length = 100, bending = 1.345, torsion = 0.789, slack = 3, turn = 54 * kPi;
  double moment = 98.541496171190744, tension = 2900.993205792131;  // M L / B, T L^2 / B of the closed form

  /// Tangent along the axis at s in [-1/2, 1/2].
  double tangent(double s) const {
    const double m = moment / (2 * kPi), t = tension / (4 * kPi * kPi);
    const double depth = 2 - moment * moment / (2 * tension);
    const double sech = 1 / std::cosh(kPi * s * std::sqrt(4 * t - m * m));
    return 1 - depth * sech * sech;
  }
};

/// Edges graded towards the middle, where the coil is: there a third as long as on average.
Rod coiling_rod(const Coil& coil, int edges) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) {
    const double x = static_cast<double>(i) / edges - 0.5;
    p.emplace_back(coil.length * (0.5 + x * (0.35 + 2.6 * x * x)), 0, 0);
  }
  Rod rod = make_rod(p, orientation_towards(p, Vec3::UnitZ(), 1), SpringConstants{1, 0, 0, 1, 1, 1, 1});
  std::vector<double> length;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) length.push_back(p[i + 1].x() - p[i].x());
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double before = length[i > 0 ? i - 1 : 0], after = length[i < length.size() ? i : i - 1];
    rod.bend_t[i] = 4 * coil.bending / (before + after);
  }
  const double tension = 1e9 * coil.bending / (coil.length * coil.length);
  for (std::size_t i = 0; i < length.size(); ++i) {
    rod.stretch[i] = tension / length[i];
    rod.twist[i] = coil.torsion / length[i];
  }
  return rod;
}

/// Slack first, until time 1; then the turns, half at each end.
Anchor coiling_end(const Coil& coil, const Rod& rod, std::size_t node) {
  const double side = node > 0 ? 1 : -1;
  const Anchor slack = test::mover(node, rod.p[node], Vec3(-side * coil.slack / 2, 0, 0), 0.0);
  const Anchor turn = test::mover(node, slack.motion(1.0).position, Vec3::Zero(), side * coil.turn / 2);
  Anchor end = slack;
  end.motion = [=](double t) { return t < 1.0 ? slack.motion(t) : turn.motion(t - 1.0); };
  return end;
}

/// Largest difference of the tangent along the axis from the closed form's.
double coil_error(int edges) {
  const Coil coil;
  Scene scene;
  scene.rods.push_back(coiling_rod(coil, edges));
  for (const int node : {0, edges})
    scene.anchors.push_back(coiling_end(coil, scene.rods[0], static_cast<std::size_t>(node)));
  const System system(scene);
  const double begin = test::cpu_seconds();
  StaticsOptions options;
  options.until = 1.0;
  Equilibrium found = balanced(system, options);
  options.until = 2.0;
  found = find_equilibrium(system, std::move(found.state), options);
  EXPECT_EQ(found.balance, Balance::converged) << found.reason;
  const double seconds = test::cpu_seconds() - begin;
  EXPECT_EQ(found.stability.unstable, 0);
  // Where along the rod the coil stands costs next to nothing: it is measured from its own middle.
  double weight = 0.0, middle = 0.0, error = 0.0;
  for (std::size_t i = 1; i + 1 < found.state.tangent.size(); ++i) {
    const double depth =
        (1 - found.state.tangent[i].x()) * (scene.rods[0].p[i + 1] - scene.rods[0].p[i - 1]).x();
    weight += depth;
    middle += depth * (scene.rods[0].p[i].x() / coil.length - 0.5);
  }
  middle /= weight;
  for (std::size_t i = 0; i < found.state.tangent.size(); ++i) {
    const double s = scene.rods[0].p[i].x() / coil.length - 0.5 - middle;
    error = std::max(error, std::abs(found.state.tangent[i].x() - coil.tangent(s)));
  }
  std::printf(
      "%d edges: envelope off by %.2e, middle at %.1e, T L^2 / B %.1f, %ld steps, %ld iterations, %.2f s\n",
      edges, error, middle, found.support[1].x() * coil.length * coil.length / coil.bending, found.steps,
      found.iterations, seconds);
  return error;
}

TEST(HelicalBuckling, LocalisesAsTheClosedFormSays) {
  const double at100 = coil_error(100);
  const double at200 = coil_error(200);
  const double at400 = coil_error(400);
  std::printf("order %.2f, %.2f\n", order(at100, at200), order(at200, at400));
  EXPECT_LT(at100, 2e-2);
  EXPECT_LT(at200, 1e-2);
  EXPECT_NEAR(order(at200, at400), 2.0, 0.4);
}

}  // namespace
}  // namespace tendril
