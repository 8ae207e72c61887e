#include "accuracy/cases.h"
#include "support/equilibria.h"
#include "support/numbers.h"

namespace tendril::accuracy {
namespace {

using tendril::test::kPi;
using test::balanced;

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

/// A pinned rod of unit length and stiffness, its ends brought together to `distance`.
Equilibrium pinned(int edges, double distance) {
  Scene scene;
  scene.rods.push_back(test::unit_rod(edges, 1e-3));
  scene.anchors.push_back({0, 0, true, false, {}});
  Anchor moved = test::mover(static_cast<std::size_t>(edges), Vec3::UnitX(), Vec3(distance - 1, 0, 0), 0.0);
  moved.holds_frame = false;
  scene.anchors.push_back(moved);
  StaticsOptions options;
  options.until = 1.0;
  Equilibrium found = balanced(System(scene), options);
  require(found.left >= 1, "the straight rod was not left");
  require(found.stability.unstable == 0, "the bent rod is stable");
  return found;
}

/// The bent rod turned about its chord into the plane of the picture.
std::vector<std::pair<double, double>> unrolled(const State& state) {
  std::vector<std::pair<double, double>> out;
  for (std::size_t i = 0; i < state.tangent.size(); ++i)
    out.emplace_back(test::at(state.y, i).x(),
                     std::hypot(test::at(state.y, i).y(), test::at(state.y, i).z()));
  return out;
}

}  // namespace

Case pinned_post_buckling() {
  Case out{"C5a", "Pinned rod after buckling",
           "P / P_critical = (2 K(sin(angle / 2)) / pi)^2 for the angle at the ends, end distance "
           "2 E / K - 1; P_critical = pi^2 E I / L^2 (Euler)"};
  struct Pinned {
    int degrees;
    double force, distance;
  };
  Figure figure{"Shapes, 64 edges", "x / L", "deflection / L", {}, true};
  for (const Pinned& exact : {Pinned{20, 1.01539687, 0.96973091}, Pinned{40, 1.06366327, 0.88120351},
                              Pinned{90, 1.39320393, 0.45694658}, Pinned{120, 1.88480087, 0.12315997}}) {
    const std::string name = std::to_string(exact.degrees) + " degrees at the ends";
    Quantity one{"force, " + name, exact.force, "relative"};
    for (const int edges : {32, 64, 128}) {
      const Equilibrium found = pinned(edges, exact.distance);
      const double value = found.support[0].x() / (kPi * kPi);
      one.rows.push_back({edges, value, value / exact.force - 1});
      if (edges == 64) figure.curves.push_back({name, unrolled(found.state)});
    }
    one.limits.push_back({64, 5e-4});
    one.order = Order{2.0, 0.1, 64};
    out.quantities.push_back(one);
  }
  out.figures.push_back(figure);
  return out;
}

namespace {

/// The smallest eigenvalue of an upright clamped column of given weight q L^3 / E I.
double upright_stability(const System& system, double weight) {
  StaticsOptions options;
  options.seek = StaticsOptions::Seek::nearest;
  options.last_load = weight;
  const Stability found = balanced(system, options).stability;
  require((found.unstable > 0) == (found.smallest < -found.threshold), "verdict and eigenvalue agree");
  return found.smallest;
}

System column(int edges) {
  Scene scene;
  scene.rods.push_back(test::unit_rod(edges, 1e-3));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(-1 / test::total_mass(scene.rods[0]), 0, 0)));
  return System(scene);
}

}  // namespace

Case self_buckling() {
  Case out{
      "C5b", "Column that buckles under its own weight",
      "q L^3 / E I = (9 / 4) j^2 with J_{-1/3}(j) = 0 (Greenhill 1881): where the smallest eigenvalue of "
      "the tangent vanishes"};
  Quantity critical{"critical weight q L^3 / E I", 7.8373474389, "absolute"};
  for (const int edges : {25, 50, 100}) {
    const System system = column(edges);
    const auto smallest = [&](double weight) { return upright_stability(system, weight); };
    require(smallest(7.5) > 0.0 && smallest(8.2) < 0.0, "stable below, unstable above");
    const double root = test::root_of(smallest, 7.5, 8.2, 1e-9);
    critical.rows.push_back({edges, root, root - critical.reference});
  }
  critical.limits.push_back({100, 5e-4});
  critical.order = Order{2.0, 0.05, 50};
  out.quantities.push_back(critical);
  const System system = column(50);
  Figure figure{"Smallest eigenvalue of the upright column", "q L^3 / E I", "eigenvalue [E I / L]", {}};
  Curve curve{"50 edges", {}};
  for (double weight = 0; weight <= 10; weight += 0.5)
    curve.points.emplace_back(weight, upright_stability(system, weight));
  figure.curves = {curve,
                   {"closed form's weight", {{7.8373474389, -5}, {7.8373474389, 5}}, Curve::Kind::reference}};
  out.figures.push_back(figure);
  return out;
}

namespace {

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

/// Twist at which the flat ring's lowest eigenvalue vanishes, over the closed form's, by a parabola
/// through three unstable flat rings. Below, the ring's roll about its own line is neutral and hides it.
double threshold(int edges, double bending, double torsion, Curve* book = nullptr) {
  const System system = ring_of(edges, bending, torsion);
  const double exact = 2 * kPi * std::sqrt(3.0) * bending / torsion;
  StaticsOptions options;
  options.seek = StaticsOptions::Seek::nearest;
  const auto stability = [&](double share) {
    options.until = 1.0 + share * exact;
    return balanced(system, options).stability;
  };
  const Stability below = stability(0.97);
  require(below.unstable == 0 && below.neutral == 1, "below the threshold only the roll is neutral");
  const double share[] = {1.015, 1.02, 1.025};
  double mu[3], root = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Stability above = stability(share[i]);
    require(above.unstable == 2, "above the threshold two ways are unstable");
    mu[i] = above.smallest;
    if (book) book->points.emplace_back(share[i], mu[i]);
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    root += share[i] * mu[j] * mu[k] / ((mu[i] - mu[j]) * (mu[i] - mu[k]));
  }
  return root;
}

}  // namespace

Case michell_ring() {
  Case out{
      "C7", "Twisted ring that writhes",
      "total twist 2 pi sqrt(3) B / C (Michell 1889, Zajac 1962), B the bending, C the torsional stiffness",
      "A5"};
  const double exact = 2 * kPi * std::sqrt(3.0);
  Quantity even{"critical twist, B = C [rad]", exact, "relative"};
  Curve curve{"100 edges", {}, Curve::Kind::marks};
  for (const int edges : {50, 100}) {
    const double root = threshold(edges, 1.0, 1.0, edges == 100 ? &curve : nullptr);
    even.rows.push_back({edges, root * exact, root - 1});
  }
  even.limits.push_back({100, 5e-3});
  even.order = Order{2.0, 0.2, 100};
  Quantity soft{"critical twist, C = 0.8 B [rad]", exact / 0.8, "relative"};
  const double root = threshold(100, 1.0, 0.8);
  soft.rows.push_back({100, root * exact / 0.8, root - 1});
  soft.limits.push_back({100, 5e-3});
  out.quantities = {even, soft};
  Figure figure{
      "Lowest eigenvalue of the flat ring", "twist over the closed form's", "eigenvalue [B / L]", {}};
  figure.curves = {
      curve, {"closed form's threshold", {{1, curve.points.back().second}, {1, 0}}, Curve::Kind::reference}};
  out.figures.push_back(figure);
  return out;
}

}  // namespace tendril::accuracy
