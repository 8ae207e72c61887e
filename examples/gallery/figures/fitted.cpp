#include <tendril/curve/arc_length.h>
#include <tendril/curve/closest_point.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/dynamics/statics.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "figures.h"
#include "page/sketch.h"
#include "spared.h"

namespace tendril::gallery {
namespace {

constexpr double kFittedYoung = 1e6, kRadius = 0.01;

Vec3 node(const State& state, std::size_t i) {
  return state.y.segment<3>(3 * static_cast<Eigen::Index>(i));
}

/// Masses of a rod of unit length, clamped at one end, whose other end is drawn down by so heavy a load that
/// it bends through some 80 degrees.
Scene loaded_rod(int edges) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.emplace_back(double(i) / edges, 0, 0);
  Scene scene;
  const Section section = circular_section(kRadius);
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1),
                                {kFittedYoung, kFittedYoung / 3, 1000}, section));
  scene.anchors.push_back({.rod = 0, .node = 0});
  const double load = 8 * kFittedYoung * section.bending1;
  scene.forces.push_back(std::make_shared<PointLoad>(
      PointLoad::Kind::force, 0, static_cast<std::size_t>(edges), Vec3(0, 0, -load), Signal::constant(1.0)));
  return scene;
}
std::vector<Vec3> bent_rod(int edges) {
  const System system(loaded_rod(edges));
  const Equilibrium found = find_equilibrium(system, system.rest_state());
  if (found.balance != Balance::converged) throw std::runtime_error(found.reason);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < system.node_count(); ++i) out.push_back(node(found.state, i));
  return out;
}

/// The curve through the masses, as tendril has it, and the curve whose control points they are.
struct Curves {
  BSpline through, under;
};
Curves curves_of(int edges, const std::vector<Vec3>& p) {
  std::vector<Vec3> rest;
  for (int i = 0; i <= edges; ++i) rest.emplace_back(double(i) / edges, 0, 0);
  const Interpolator fit(3, rest);
  return {BSpline(fit.knots(), fit.solve(p)),
          BSpline(Interpolator(3, rest, Parametrisation::universal).knots(), p)};
}

double farthest(const BSpline& curve, const std::vector<Vec3>& points) {
  double most = 0.0;
  for (const Projection& one : CurveProjector(curve).nearest(points)) most = std::max(most, one.distance);
  return most;
}

std::vector<Vec3> drawn_points(const BSpline& curve) {
  std::vector<Vec3> out;
  for (int k = 0; k <= 120; ++k) out.push_back(curve.value(k / 120.0));
  return out;
}

std::string drawn(const std::vector<Vec3>& fine, const std::vector<Vec3>& p, const Curves& curves,
                  const std::string& title) {
  Sketch sketch({Vec3::UnitX(), Vec3::UnitZ()});
  sketch.line(fine, "#bbbbbb", 4);
  sketch.line(drawn_points(curves.through), "#0072b2", 1.6);
  sketch.line(drawn_points(curves.under), "#d55e00", 1.6);
  sketch.line(p, "#555555", 0.6);
  for (const Vec3& one : p) sketch.dot(one, "#222222", 3);
  return sketch.svg(330, title);
}

}  // namespace

Figure curve_through_the_masses() {
  const std::vector<Vec3> fine = bent_rod(512);
  Figure out{"3.12", "A curve through the masses, and a curve whose control points they are",
             "The thesis fits its curve through the masses and says that dynamics on the control points, the "
             "way of dynamic "
             "NURBS, does not show the deformation fully. Here both curves, cubic, have the same masses: "
             "those of a clamped "
             "rod whose end a heavy load bends down, of 4 to 16 edges, beside the same rod of 512 edges."};
  double worst_through = 0.0, worst_ratio = HUGE_VAL, at_six = 0.0, fine_through = 0.0, fine_under = 0.0;
  for (const int edges : {4, 6, 8, 16}) {
    const std::vector<Vec3> p = bent_rod(edges);
    const Curves curves = curves_of(edges, p);
    const double through = farthest(curves.through, fine), under = farthest(curves.under, fine);
    worst_through = std::max(worst_through, farthest(curves.through, p));
    worst_ratio = std::min(worst_ratio, under / through);
    const std::string at = text(", %.0f edges", edges);
    if (edges == 6) at_six = farthest(curves.under, p), fine_through = through, fine_under = under;
    if (edges <= 6)
      out.pictures.push_back(
          {drawn(fine, p, curves, text("%.0f edges", edges)),
           "grey: the rod of 512 edges; blue: through the masses; orange: with them as control points"});
    // Both fall with the square of an edge.
    const auto falls = [edges](double low, double high) {
      return Bounds{low / (edges * edges), high / (edges * edges)};
    };
    out.numbers.push_back({"through the masses" + at + ": farthest of the fine rod, of the length", through,
                           falls(0.23, 0.29)});
    out.numbers.push_back({"masses as control points" + at + ": farthest of the fine rod, of the length",
                           under, falls(0.65, 0.9)});
    out.numbers.push_back({"length of the curve with masses as control points" + at,
                           ArcLength(curves.under).total(), Bounds{0.98, 0.9995}});
  }
  out.numbers.push_back(
      {"through the masses: farthest mass, of the length", worst_through, Bounds{0, 1e-14}});
  out.numbers.push_back(
      {"masses as control points, 6 edges: farthest mass, of the length", at_six, Bounds{0.013, 0.019}});
  out.numbers.push_back({"how many times farther from the fine rod with masses as control points, at least",
                         worst_ratio, Bounds{2.2, 4}});
  out.claims = {
      {"with dynamics on the control points the curve does not fully reflect the deformation; fitted through "
       "the masses it does",
       "6 edges: control points lie up to " + text("%.1f %%", 100 * at_six) +
           " of the length off their curve, masses " + text("%.0e", worst_through) +
           "; the fine rod is up to " + text("%.2f %%", 100 * fine_through) + " off the fitted curve, " +
           text("%.2f %%", 100 * fine_under) + " off the other",
       worst_ratio > 1.5 && worst_through < 1e-12 ? Verdict::holds : Verdict::fails,
       "both converge as edges are added"}};
  out.notes = {
      "Dynamic NURBS have a mass matrix of their own; here only the last step differs, what the masses do to "
      "the curve."};
  say_left_out(loaded_rod(12), Parts::rods, out);
  return out;
}

}  // namespace tendril::gallery
