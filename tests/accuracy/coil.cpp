#include "accuracy/cases.h"
#include "support/equilibria.h"
#include "support/numbers.h"

namespace tendril::accuracy {
namespace {

using tendril::test::kPi;

// L = 100, B = 1.345, C = 0.789, the ends 3 nearer and turned by 27 turns.
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

/// Edges graded towards the middle, where the coil is: there `middle` of the mean.
Rod coiling_rod(const Coil& coil, int edges, double middle) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) {
    const double x = static_cast<double>(i) / edges - 0.5;
    p.emplace_back(coil.length * (0.5 + x * (middle + (1 - middle) * std::pow(std::abs(2 * x), 3))), 0, 0);
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

struct Coiled {
  double error, tension, seconds;
  std::vector<std::pair<double, double>> envelope;  ///< cos of the angle to the axis over s
  std::vector<std::pair<double, double>> shape;
};

/// Where along the rod the coil stands costs next to nothing: it is measured from its own middle.
double middle_of(const Equilibrium& found, const Rod& rod, double length) {
  double weight = 0.0, middle = 0.0;
  for (std::size_t i = 1; i + 1 < found.state.tangent.size(); ++i) {
    const double depth = (1 - found.state.tangent[i].x()) * (rod.p[i + 1] - rod.p[i - 1]).x();
    weight += depth;
    middle += depth * (rod.p[i].x() / length - 0.5);
  }
  return middle / weight;
}

Coiled coil_up(const Coil& coil, int edges, double middle_edge) {
  Scene scene;
  scene.rods.push_back(coiling_rod(coil, edges, middle_edge));
  const Rod& rod = scene.rods[0];
  for (const int node : {0, edges})
    scene.anchors.push_back(coiling_end(coil, rod, static_cast<std::size_t>(node)));
  const System system(scene);
  const double begin = test::cpu_seconds();
  StaticsOptions options;
  // The coil slides along the rod for next to nothing, so that rounding alone makes steps of 1e-9 to 2e-7,
  // as the compiler has it. What is measured is measured from the coil's own middle.
  options.tolerance = 1e-8;
  const double tolerances = 100.0;
  options.until = 1.0;
  Equilibrium found = test::balanced(system, options, tolerances);
  options.until = 2.0;
  found = test::balanced_from(system, std::move(found.state), options, tolerances);
  Coiled out{0.0,
             found.support[1].x() * coil.length * coil.length / coil.bending,
             test::cpu_seconds() - begin,
             {},
             {}};
  if (found.stability.unstable != 0) throw std::runtime_error("the coil is stable");
  const double middle = middle_of(found, rod, coil.length);
  for (std::size_t i = 0; i < found.state.tangent.size(); ++i) {
    const double s = rod.p[i].x() / coil.length - 0.5 - middle;
    out.error = std::max(out.error, std::abs(found.state.tangent[i].x() - coil.tangent(s)));
    out.envelope.emplace_back(s, found.state.tangent[i].x());
    const Vec3 p = test::at(found.state.y, i) / coil.length;
    out.shape.emplace_back(p.x(), p.z());
  }
  return out;
}

std::vector<Figure> figures(const Coil& coil, const Coiled& found) {
  Figure angle{"Angle to the axis", "s / L", "cos(theta)", {}};
  Figure shape{"The rod seen from the side, 100 edges", "x / L", "z / L", {{"", found.shape}}, true};
  Curve exact{"closed form", {}, Curve::Kind::reference};
  for (int i = -500; i <= 500; ++i) exact.points.emplace_back(i / 1000.0, coil.tangent(i / 1000.0));
  angle.curves = {{"100 edges", found.envelope, Curve::Kind::marks}, exact};
  return {angle, shape};
}

}  // namespace

Case helical_buckling() {
  Case out{
      "C8", "Localised helical buckling",
      "cos(theta) = 1 - (2 - M^2 / 2 B T) sech^2(pi s sqrt(4 t - m^2)) along a rod whose ends came nearer by "
      "3 % and were turned 27 times (Coyne 1990; van der Heijden and Thompson 2000)",
      "A6"};
  const Coil coil;
  // With a middle edge of 0.42 of the mean the terms of second order nearly cancel: the order is seen with
  // 0.5.
  Quantity fine{"envelope cos(theta), middle edges 0.42 of the mean", 0.0, "largest difference"};
  Quantity even{"envelope cos(theta), middle edges 0.5 of the mean", 0.0, "largest difference"};
  Quantity tension{"tension T L^2 / B", coil.tension, "relative"};
  for (const int edges : {100, 200}) {
    const Coiled found = coil_up(coil, edges, 0.42);
    fine.rows.push_back({edges, found.error, found.error});
    tension.rows.push_back({edges, found.tension, found.tension / coil.tension - 1});
    char note[96];
    std::snprintf(note, sizeof note, "%d edges: found by statics in %.2f s of CPU time", edges,
                  found.seconds);
    out.notes.push_back(note);
    if (edges == 100) out.figures = figures(coil, found);
  }
  for (const int edges : {100, 200, 400}) {
    const double error = coil_up(coil, edges, 0.5).error;
    even.rows.push_back({edges, error, error});
  }
  fine.limits = {{100, 1e-2}, {200, 2e-3}};
  even.limits.push_back({200, 1e-2});
  even.order = Order{2.0, 0.2, 200};
  tension.limits.push_back({200, 1e-2});
  out.quantities = {fine, even, tension};
  return out;
}

}  // namespace tendril::accuracy
