#include <Eigen/LU>

#include "accuracy/cases.h"
#include "support/equilibria.h"
#include "support/vibrations.h"

namespace tendril::accuracy {
namespace {

constexpr double kStem = 1.0, kArm = 0.6;

/// Of unit bending stiffness and line density.
Rod rod_between(const Vec3& from, const Vec3& to, int edges, double radius) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.push_back(from + (to - from) * (static_cast<double>(i) / edges));
  const double young = 4.0 / (std::numbers::pi * std::pow(radius, 4));  // E I = 1
  const double density = 1.0 / (std::numbers::pi * radius * radius);    // rho A = 1
  return make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {young, young / 3, density},
                  circular_section(radius));
}

/// A stem along z, clamped at its foot, and two arms along x and -x at its head; all of unit bending
/// stiffness and line density.
/// \param edges  of the stem, a multiple of 5
/// \param radius  decides how much they stretch
Scene tee(int edges, double radius) {
  Scene scene;
  scene.rods.push_back(rod_between(Vec3::Zero(), kStem * Vec3::UnitZ(), edges, radius));
  scene.anchors.push_back({0, 0, true, true, {}});
  for (const double side : {1.0, -1.0}) {
    const Vec3 head = scene.rods[0].p.back();
    scene.joints.push_back({0, static_cast<std::size_t>(edges), scene.rods.size(), true});
    scene.rods.push_back(rod_between(head, head + side * kArm * Vec3::UnitX(), edges * 3 / 5, radius));
  }
  return scene;
}

std::vector<std::pair<double, double>> outline(const System& system, const State& state) {
  std::vector<std::pair<double, double>> out;
  for (std::size_t i = 0; i < system.node_count(); ++i)
    out.emplace_back(test::at(state.y, i).x(), test::at(state.y, i).z());
  return out;
}

}  // namespace

Case bent_tee() {
  Case out{"J1", "T of three rods bent by a moment at the end of an arm",
           "the moment runs through the arm and the stem, both circular arcs of curvature M / E I; the other "
           "arm turns "
           "with the stem's head and stays straight",
           "", "edges of the stem"};
  const double turn = 1.2;  // M / E I, the stem being of length 1
  const Vec3 head(1 - std::cos(turn), 0, std::sin(turn));
  const double far = turn + turn * kArm;
  const Vec3 loaded =
      turn * kStem * head / turn + Vec3(std::sin(far) - std::sin(turn), 0, std::cos(far) - std::cos(turn));
  const Vec3 tips[] = {loaded / turn, head / turn - kArm * Vec3(std::cos(turn), 0, -std::sin(turn))};
  Figure figure{"T of 20 edges a stem", "x", "z", {}, true};
  Quantity ends[] = {{"loaded arm's tip", tips[0].z(), "of the stem's length"},
                     {"free arm's tip", tips[1].z(), "of the stem's length"}};
  for (const int edges : {10, 20, 40}) {
    Scene scene = tee(edges, 0.01);
    const std::size_t last = scene.rods[1].p.size() - 1;
    scene.forces.push_back(std::make_shared<PointLoad>(PointLoad::Kind::torque, 1, last, Vec3(0, turn, 0),
                                                       Signal::constant(1.0)));
    const System system(scene);
    const Equilibrium found = test::balanced(system);
    for (std::size_t arm = 0; arm < 2; ++arm) {
      const Vec3 tip = test::at(found.state.y, system.rods()[arm + 1].first + last);
      ends[arm].rows.push_back({edges, tip.z(), (tip - tips[arm]).norm()});
    }
    if (edges == 20) figure.curves.push_back({"computed", outline(system, found.state), Curve::Kind::marks});
  }
  for (Quantity& end : ends) {
    end.order = Order{2.0, 0.1, 20};
    end.limits.push_back({40, 1e-4});
    out.quantities.push_back(end);
  }
  figure.curves.push_back(
      {"closed form, tips and head",
       {{tips[0].x(), tips[0].z()}, {head.x() / turn, head.z() / turn}, {tips[1].x(), tips[1].z()}},
       Curve::Kind::marks});
  out.figures.push_back(figure);
  return out;
}

namespace {

/// Determinant of the boundary conditions of the T swinging in its plane, the arms against each other, at
/// beta = (w^2 rho A / E I)^(1/4): the stem's A (cosh - cos) + B (sinh - sin), the arm's C (cosh - cos) + D
/// sinh + F sin.
double boundary(double b) {
  const double H = b * kStem, a = b * kArm;
  Eigen::Matrix<double, 5, 5> m = Eigen::Matrix<double, 5, 5>::Zero();
  const double ch = std::cosh(H), sh = std::sinh(H), c = std::cos(H), s = std::sin(H);
  m.row(0) << sh + s, ch - c, 0, -1, -1;  // the arm starts as the head turns
  m.row(1) << ch + c, sh + s, -4, 0, 0;   // the stem's moment bends both arms
  m.row(2) << sh - s + 2 * a * (ch - c), ch + c + 2 * a * (sh - s), 0, 0, 0;  // its shear moves both
  m.row(3) << 0, 0, std::cosh(a) + std::cos(a), std::sinh(a), -std::sin(a);   // no moment at the tip
  m.row(4) << 0, 0, std::sinh(a) - std::sin(a), std::cosh(a), -std::cos(a);   // no shear there
  return m.determinant() * std::exp(-H - a);
}

/// Zeros of it, ascending.
std::vector<double> swinging_roots(std::size_t count) {
  std::vector<double> out;
  const double step = 0.05;
  for (double b = step; out.size() < count; b += step) {
    if (boundary(b) * boundary(b + step) > 0) continue;
    double low = b, high = b + step;
    for (int i = 0; i < 60; ++i)
      (boundary(low) * boundary(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    out.push_back(low);
  }
  return out;
}

/// Frequencies of motions in the plane x z, sorted into those in which the arms go up together and against
/// each other.
struct Sorted {
  std::vector<double> together, against;
};
Sorted swings_of(const System& system) {
  const auto n = static_cast<Eigen::Index>(system.node_count());
  const test::Vibrations found =
      test::vibrations(system, system.rest_state(), [&](Eigen::Index k) { return k < 3 * n && k % 3 != 1; });
  const auto place = [&](std::size_t rod) {
    const NodeRange& range = system.rods()[rod];
    const auto y = 3 * static_cast<Eigen::Index>(range.first + range.count - 1) + 2;
    return std::find(found.y.begin(), found.y.end(), y) - found.y.begin();
  };
  const auto right = place(1), left = place(2);
  Sorted out;
  for (Eigen::Index k = 0; k < 8; ++k) {
    const bool up = found.shape(right, k) * found.shape(left, k) > 0;
    (up ? out.together : out.against).push_back(found.frequency[k]);
  }
  return out;
}

}  // namespace

Case swinging_tee() {
  Case out{
      "J2", "Frequencies of a T of three rods",
      "arms together: the clamped beam's, 1.875104^2 sqrt(E I / rho A a^4); against each other: zeros of the "
      "determinant of beam solutions on stem and arm (slope and moment pass through the head, its shear "
      "moves both "
      "arms)",
      "", "edges of the stem"};
  const std::vector<double> roots = swinging_roots(3);
  std::vector<Quantity> all{{"arms together", std::pow(1.875104069 / kArm, 2), "relative"}};
  for (const double root : roots)
    all.push_back({"arms against each other " + std::to_string(all.size()), root * root, "relative"});
  for (const int edges : {20, 40, 80}) {
    const Sorted found = swings_of(System(tee(edges, 1e-3)));
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double value = k == 0 ? found.together[0] : found.against[k - 1];
      all[k].rows.push_back({edges, value, value / all[k].reference - 1});
    }
  }
  for (Quantity& one : all) {
    one.order = Order{2.0, 0.15, 40};
    one.limits.push_back({40, 1e-2});
    out.quantities.push_back(one);
  }
  return out;
}

}  // namespace tendril::accuracy
