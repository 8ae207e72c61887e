#include "accuracy/cases.h"
#include "support/equilibria.h"
#include "support/numbers.h"

namespace tendril::accuracy {
namespace {

using tendril::test::kPi;
using test::clamped;
using test::point_load;
using test::tip;
constexpr int kLadder[] = {16, 32, 64, 128, 256};

struct Elastica {
  double load, drop, shortening, angle, limit;
};

/// The closed form's shape: E I theta'' = -moment'(s) cos(theta), theta below the horizontal, integrated from
/// the tip by the classic Runge-Kutta method; at the clamp theta must vanish.
std::vector<std::pair<double, double>> exact_shape(double tip_angle, double (*shear)(double), double load) {
  constexpr int kSteps = 400;
  using Four = Eigen::Vector4d;  // theta, theta', x, z
  const auto rate = [&](double s, const Four& y) {
    return Four(y[1], -load * shear(s) * std::cos(y[0]), std::cos(y[0]), -std::sin(y[0]));
  };
  Four y(tip_angle, 0, 0, 0);
  std::vector<Four> all{y};
  const double h = -1.0 / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double s = 1 + h * i;
    const Four k1 = rate(s, y), k2 = rate(s + h / 2, y + h / 2 * k1), k3 = rate(s + h / 2, y + h / 2 * k2);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(s + h, y + h * k3));
    all.push_back(y);
  }
  if (std::abs(y[0]) > 1e-7) throw std::runtime_error("the tip angle is not the closed form's");
  std::vector<std::pair<double, double>> out;
  for (const Four& one : all) out.emplace_back(one[2] - y[2], one[3] - y[3]);
  return out;
}

using Bend = Equilibrium (*)(int edges, double load);

/// One load at every number of edges, drop and shortening together.
Quantity ladder_of(const Elastica& exact, Bend bend, Figure& figure) {
  char name[32];
  std::snprintf(name, sizeof name, "load %g, tip", exact.load);
  Quantity out{name, exact.drop, "of the length"};
  const Eigen::Vector2d wanted(exact.drop, exact.shortening);
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (const int edges : kLadder) {
    const Equilibrium found = bend(edges, exact.load);
    if (found.stability.kind != Stability::Kind::stable) throw std::runtime_error("not stable");
    if (std::abs(found.support[0].z() / exact.load - 1) > 1e-5) throw std::runtime_error("unsupported");
    const Eigen::Vector2d now(-tip(found).z(), 1 - tip(found).x());
    Row row{edges, now[0], (now - wanted).norm()};
    if (!out.rows.empty()) row.extrapolated = ((4 * now - last) / 3 - wanted).norm();
    out.rows.push_back(row);
    if (edges == 32) {
      std::snprintf(name, sizeof name, "load %g, 32 edges", exact.load);
      figure.curves.push_back({name, test::side_view(found.state), Curve::Kind::marks});
    }
    last = now;
  }
  out.limits.push_back({32, exact.limit});
  out.order = Order{2.0, 0.05, 64};
  out.extrapolated = Limit{64, 1e-6};
  return out;
}

Figure shapes() {
  return {"Shape at rest", "x / L", "z / L", {}, true};
}

void add_exact(Figure& figure, const Elastica& exact, double (*shear)(double)) {
  figure.curves.push_back({exact.load == 10 ? "closed form" : "", exact_shape(exact.angle, shear, exact.load),
                           Curve::Kind::reference});
}

Equilibrium under_tip_load(int edges, double load) {
  return clamped(test::unit_rod(edges), {point_load(PointLoad::Kind::force, edges, Vec3(0, 0, -load))});
}

Equilibrium under_weight(int edges, double load) {
  Rod rod = test::unit_rod(edges);
  const double mass = test::total_mass(rod);
  return clamped(std::move(rod), {std::make_shared<Gravity>(Vec3(0, 0, -load / mass))});
}

/// The tip under a load of a rod given by the thesis's spring constants, less that of the rod of the same
/// material: the masses differ at the ends, the springs do not.
double by_spring_constants(int edges, double load) {
  const double h = 1.0 / edges, r = 2e-4;
  const std::vector<Vec3> p = test::straight(edges, 1.0);
  const SpringConstants springs{.stretch = 4 / (r * r) / h,
                                .bend_l = 2 / h,
                                .bend_m = 2 / h,
                                .bend_t = 0,
                                .twist = 2.0 / 3 / h,
                                .mass = h,
                                .inertia = h};
  Rod rod = make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), springs);
  const Equilibrium found =
      clamped(std::move(rod), {point_load(PointLoad::Kind::force, edges, Vec3(0, 0, -load))});
  return (tip(found) - tip(under_tip_load(edges, load))).norm();
}

}  // namespace

Case tip_load() {
  Case out{"C1", "Cantilever with a dead load at its tip",
           "E I theta'' = -P cos(theta): drop and shortening of the tip by elliptic integrals (Bisshopp and "
           "Drucker 1945, Mattiasson 1981); loads are P L^2 / E I",
           "A1"};
  Figure figure = shapes();
  // The error of a given chain grows with the load, and once the bend is no longer than some edges, faster.
  for (const Elastica& exact : {Elastica{0.2, 0.06636448214, 0.002646548341, 0.09963616304, 1.5e-4},
                                Elastica{1, 0.3017207738, 0.05643323628, 0.4613519497, 1.5e-4},
                                Elastica{2, 0.4934574804, 0.1606417208, 0.7817498316, 5e-4},
                                Elastica{5, 0.7137915236, 0.3876283607, 1.215368118, 5e-4},
                                Elastica{10, 0.8106090249, 0.5549955978, 1.430285539, 5.5e-4}}) {
    out.quantities.push_back(ladder_of(exact, under_tip_load, figure));
    add_exact(figure, exact, [](double) { return 1.0; });
  }
  const double apart = by_spring_constants(32, 5);
  Quantity same{
      "load 5, by spring constants instead of a material", 0.0, "of the length", {{32, apart, apart}}};
  same.limits.push_back({32, 1e-9});
  out.quantities.push_back(same);
  out.figures.push_back(figure);
  return out;
}

Case own_weight() {
  Case out{"C2", "Cantilever under its own weight",
           "E I theta'' = -q (L - s) cos(theta), by shooting at 1e-13; loads are q L^3 / E I", "A2"};
  Figure figure = shapes();
  for (const Elastica& exact : {Elastica{1, 0.123471402, 0.008753605, 0.165115561, 1.5e-4},
                                Elastica{2, 0.238506583, 0.033107053, 0.321593798, 5e-4},
                                Elastica{5, 0.495905045, 0.153342820, 0.697004778, 5e-4},
                                Elastica{10, 0.700199716, 0.343646239, 1.052643117, 6e-4}}) {
    out.quantities.push_back(ladder_of(exact, under_weight, figure));
    add_exact(figure, exact, [](double s) { return 1.0 - s; });
  }
  out.figures.push_back(figure);
  return out;
}

Case small_deflection() {
  const double load = 1e-3;
  Case out{
      "C3", "Small deflection of a cantilever",
      "P L^3 / 3 E I and q L^4 / 8 E I; a chain of hinges with a half-edge clamp is off by 1 / 2 N^2 for the "
      "load at the end"};
  Quantity end{"deflection by an end load", load / 3, "relative"};
  Quantity spread{"deflection by a spread load", load / 8, "relative"};
  Quantity hinges{"end load, relative error less 1 / 2 N^2", 0.0, "absolute"};
  for (const int edges : {16, 32, 64}) {
    const double by_end = -tip(under_tip_load(edges, load)).z();
    const double by_weight = -tip(under_weight(edges, load)).z();
    end.rows.push_back({edges, by_end, by_end / end.reference - 1});
    spread.rows.push_back({edges, by_weight, by_weight / spread.reference - 1});
    const double left = by_end / end.reference - 1 - 0.5 / (edges * edges);
    hinges.rows.push_back({edges, left, left});
  }
  end.limits.push_back({32, 5e-4});
  spread.limits.push_back({32, 1e-3});
  hinges.limits.push_back({32, 1e-6});
  end.order = spread.order = Order{2.0, 0.02, 32};
  out.quantities = {end, spread, hinges};
  return out;
}

Case end_moment() {
  Case out{"C4", "Cantilever with a moment at its end",
           "a circular arc: M L / E I = 2 pi closes the circle, pi puts the tip at (0, 2 / pi)", "A8"};
  const auto bent = [](int edges, double turn) {
    const Equilibrium found =
        clamped(test::unit_rod(edges), {point_load(PointLoad::Kind::torque, edges, Vec3(0, -turn, 0))});
    if (found.conservative) throw std::runtime_error("a fixed torque has no energy");
    return found;
  };
  Figure figure{"Half circle and circle, 64 edges", "x / L", "z / L", {}, true};
  Quantity circle{"gap of the circle", 0.0, "of the length"};
  Quantity half{"height of the half circle's tip", 2 / kPi, "of the length"};
  for (const int edges : {16, 32, 64}) {
    const Equilibrium whole = bent(edges, 2 * kPi), part = bent(edges, kPi);
    circle.rows.push_back({edges, tip(whole).norm(), tip(whole).norm()});
    half.rows.push_back({edges, tip(part).z(), (tip(part) - Vec3(0, 0, 2 / kPi)).norm()});
    if (edges != 64) continue;
    figure.curves.push_back({"M L / E I = 2 pi", test::side_view(whole.state), Curve::Kind::marks});
    figure.curves.push_back({"M L / E I = pi", test::side_view(part.state), Curve::Kind::marks});
  }
  circle.limits.push_back({64, 1e-12});
  half.limits.push_back({64, 1e-3});
  half.order = Order{2.0, 0.05, 32};
  out.quantities = {circle, half};
  out.figures.push_back(figure);
  return out;
}

}  // namespace tendril::accuracy
