#include "accuracy/cases.h"
#include "support/equilibria.h"
#include "support/numbers.h"

namespace tendril::accuracy {
namespace {

using tendril::test::kPi;
using test::clamped;
using test::point_load;
using test::tip;

Quantity at_one(std::string name, double reference, int edges, double value, double error, double limit,
                const char* error_is = "relative") {
  return {std::move(name), reference, error_is, {{edges, value, error}}, {{edges, limit}}};
}

}  // namespace

Case twisted_strip() {
  Case out{
      "T1", "Rod twisted many turns between its masses",
      "uniform twist, energy C turn^2 / 2 L + E A pull^2 / 2 L, while M^2 < 4 B T: 20 turns over 8 edges"};
  const double torsion = 0.7, tension = 1e4, pull = 0.3, turn = 40 * kPi;
  Scene scene;
  scene.rods.push_back(test::round_rod(8, 1.0, 1.0, torsion, tension));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.anchors.push_back(test::mover(8, Vec3::UnitX(), Vec3(pull, 0, 0), turn));
  StaticsOptions options;
  options.until = 1.0;
  const Equilibrium found = test::balanced(System(scene), options);
  if (found.stability.kind != Stability::Kind::stable) throw std::runtime_error("pulled tight it is stable");
  Quantity twist{"twist of an edge, worst [rad]", turn / 8, "absolute"};
  double worst = 0.0;
  for (std::size_t i = 0; i < 8; ++i) worst = std::max(worst, std::abs(found.state.twist[i] - turn / 8));
  twist.rows.push_back({8, found.state.twist[0], worst});
  twist.limits.push_back({8, 1e-9});
  const double energy = 0.5 * torsion * turn * turn + 0.5 * tension * pull * pull;
  const double force = found.support[1].x();
  out.quantities = {twist, at_one("energy", energy, 8, found.elastic, found.elastic / energy - 1, 1e-7),
                    at_one("pull at the end", tension * pull, 8, force, force / (tension * pull) - 1, 1e-7)};
  return out;
}

Case pretwisted_strip() {
  Case out{"T2", "Strip twisted at rest, bent by a small load at its end",
           "w = P integral (L - s)^2 (cos^2 f / E I_1 + sin^2 f / E I_2), across it P integral (L - s)^2 sin "
           "f cos f "
           "(1 / E I_1 - 1 / E I_2), f = pi s / L the turn of the section"};
  const double a = 0.02, b = 0.005, young = 1e7, load = 1e-6;
  const double soft = young * a * b * b * b / 12, hard = young * b * a * a * a / 12;
  // Half the integrals of (1 - s)^2 by 1, cos 2f and sin 2f: 1 / 3, 1 / 2 pi^2, 1 / 2 pi.
  const double even = 1.0 / 6, by_cosine = 0.5 / (2 * kPi * kPi), by_sine = 0.5 / (2 * kPi);
  // b lies along z at the clamp.
  const double down = load * (even * (1 / soft + 1 / hard) + by_cosine * (1 / soft - 1 / hard));
  const double across = load * by_sine * (1 / soft - 1 / hard);
  Quantity w{"deflection along the load", down, "relative"}, v{"deflection across it", across, "relative"};
  for (const int edges : {16, 32, 64}) {
    const std::vector<Vec3> p = test::straight(edges, 1.0);
    std::vector<Vec3> q;
    for (int i = 0; i <= edges; ++i)
      q.push_back(p[static_cast<std::size_t>(i)] +
                  0.1 * rotate_about(Vec3::UnitX(), kPi * i / edges, Vec3::UnitZ()));
    const Rod rod = make_rod(p, q, {young, young / 3, 1000}, rectangular_section(a, b));
    const Equilibrium found = clamped(rod, {point_load(PointLoad::Kind::force, edges, Vec3(0, 0, load))});
    w.rows.push_back({edges, tip(found).z(), tip(found).z() / down - 1});
    v.rows.push_back({edges, -tip(found).y(), -tip(found).y() / across - 1});
  }
  w.limits.push_back({32, 5e-3});
  v.limits.push_back({32, 5e-3});
  w.order = v.order = Order{2.0, 0.1, 32};
  out.quantities = {w, v};
  return out;
}

namespace {

/// A quarter of a circle of unit length in the plane x z.
std::vector<Vec3> quarter(int edges) {
  const double half = kPi / 4 / edges;
  std::vector<Vec3> p{Vec3::Zero()};
  for (int i = 0; i < edges; ++i) {
    const double angle = (2 * i + 1) * half;
    p.push_back(p.back() + Vec3(std::cos(angle), 0, std::sin(angle)) / edges);
  }
  return p;
}

/// Of unit bending stiffness.
Rod leaf(int edges) {
  const std::vector<Vec3> p = quarter(edges);
  const double r = 1e-3, young = 4 / (kPi * std::pow(r, 4));
  return make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {young, young / 3, 1000},
                  circular_section(r));
}

}  // namespace

Case curved_leaf() {
  Case out{
      "L1", "Leaf that grew curved",
      "rests as it grew; a moment M at its end adds M / E I to its curvature pi / 2 L, so that E I pi / 2 L "
      "uncurls the quarter circle"};
  const Equilibrium rest = clamped(leaf(40), {});
  const double moved = (tip(rest) - quarter(40).back()).norm();
  if (rest.iterations != 0 || rest.stability.kind != Stability::Kind::stable)
    throw std::runtime_error("the leaf rests where it grew");
  out.quantities.push_back(
      at_one("tip at rest from where it grew", 0.0, 40, moved, moved, 1e-14, "of the length"));
  Figure figure{"Leaves of 40 edges", "x / L", "z / L", {{"at rest", test::side_view(rest.state)}}, true};
  for (const double part : {1.0, 0.5, -1.0}) {
    char name[48];
    std::snprintf(name, sizeof name, "moment %g E I pi / 2 L", part);
    const double turn = kPi / 2 * (1 - part);
    // The clamp holds the tangent of the first edge's end, where the circle starts.
    const Vec3 end = turn == 0 ? Vec3(1, 0, 0) : Vec3(std::sin(turn) / turn, 0, (1 - std::cos(turn)) / turn);
    Quantity one{name, turn == 0 ? 0.0 : end.z(), "of the length"};
    for (const int edges : {20, 40, 80}) {
      const Equilibrium found =
          clamped(leaf(edges), {point_load(PointLoad::Kind::torque, edges, Vec3(0, part * kPi / 2, 0))});
      one.rows.push_back({edges, tip(found).z(), (tip(found) - end).norm()});
      if (edges == 40) figure.curves.push_back({name, test::side_view(found.state), Curve::Kind::marks});
    }
    one.limits.push_back({40, part == 1 ? 1e-4 : 2e-4});
    out.quantities.push_back(one);
  }
  out.figures.push_back(figure);
  return out;
}

Case anisotropic_section() {
  Case out{"S1", "Section with two bending stiffnesses",
           "a small load between the axes bends about each by its own: P L^3 / 3 E I_1 and P L^3 / 3 E I_2, "
           "less the "
           "chain's 1 / 2 N^2"};
  const double a = 0.02, b = 0.01, young = 1e7, load = 1e-4;
  // The director is towards z, so b is the size along z and l lies along y.
  const double exact_y = load / (3 * young * b * a * a * a / 12),
               exact_z = load / (3 * young * a * b * b * b / 12);
  Quantity y{"deflection the stiff way", exact_y, "relative, less 1 / 2 N^2"};
  Quantity z{"deflection the soft way", exact_z, "relative, less 1 / 2 N^2"};
  for (const int edges : {32, 64}) {
    const std::vector<Vec3> p = test::straight(edges, 1.0);
    const Rod rod = make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {young, young / 3, 1000},
                             rectangular_section(a, b));
    const Equilibrium found = clamped(rod, {point_load(PointLoad::Kind::force, edges, Vec3(0, load, load))});
    const double hinges = 1 + 0.5 / (edges * edges);
    y.rows.push_back({edges, tip(found).y(), tip(found).y() / exact_y - hinges});
    z.rows.push_back({edges, tip(found).z(), tip(found).z() / exact_z - hinges});
  }
  y.limits.push_back({64, 1e-4});
  z.limits.push_back({64, 1e-4});
  out.quantities = {y, z};
  return out;
}

}  // namespace tendril::accuracy
