#include <tendril/contact/rod_rod_contact.h>
#include <tendril/dynamics/forces.h>

#include "accuracy/contact/cases.h"
#include "accuracy/contact/runs.h"
#include "support/numbers.h"
#include "support/rods.h"

/// An overhand knot in a long rod, drawn so loose that it is a loop closed by a short braid.
namespace tendril::contact {
namespace {

using tendril::test::kPi;

/// Points of a curve, apart by about `step`: a tail, a braid of three half turns, a loop of radius 1, the
/// braid again and the other tail.
std::vector<Vec3> knotted(double radius, double tail, double step) {
  const double half = 0.8, apart = 1.6 * radius;
  const auto braid = [&](double x, double side) {
    const double loop = 1.0 - std::sqrt(1.0 - x * x), off = std::hypot(0.5 * loop, apart),
                 turn = 1.5 * kPi * (x / half + 1.0);
    return Vec3(x, 0.5 * loop - side * off * std::cos(turn), -side * off * std::sin(turn));
  };
  std::vector<Vec3> dense;
  const int n = 4000;
  for (int i = 0; i < n; ++i)
    dense.emplace_back(-half - tail * (1.0 - static_cast<double>(i) / n), braid(-half, 1).y(), 0);
  for (int i = 0; i <= n; ++i) dense.push_back(braid(half * (2.0 * i / n - 1.0), 1));
  const double from = std::asin(half);
  // The loop, which the braid leaves and meets a little off.
  const double miss = braid(half, 1).y() - (1.0 - std::sqrt(1.0 - half * half));
  for (int i = 1; i < n; ++i) {
    const double at = from + (2 * kPi - 2 * from) * i / n;
    dense.emplace_back(std::sin(at), 1.0 - std::cos(at) + miss, 0);
  }
  for (int i = 0; i <= n; ++i) dense.push_back(braid(half * (2.0 * i / n - 1.0), -1));
  for (int i = 1; i <= n; ++i) dense.emplace_back(half + tail * i / n, braid(half, -1).y(), 0);
  std::vector<Vec3> points{dense.front()};
  for (const Vec3& p : dense) {
    const bool braided = std::abs(p.x()) < 0.6 && p.y() < 0.6;
    if ((p - points.back()).norm() >= (braided ? step : 0.05)) points.push_back(p);
  }
  return points;
}

/// That curve as a state of a rod that rests straight: tangents turn all the way round, so that the
/// references go along, directors carried from one to the next.
State start_of(const System& system, const std::vector<Vec3>& points) {
  State start = system.rest_state();
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    start.y.segment<3>(3 * static_cast<Eigen::Index>(i)) = points[i];
    const Vec3 before = i > 0 ? (points[i] - points[i - 1]).normalized() : Vec3::Zero(),
               after = i < last ? (points[i + 1] - points[i]).normalized() : Vec3::Zero();
    start.tangent[i] = (before + after).normalized();
    if (i > 0)
      start.director[i] =
          Eigen::Quaterniond::FromTwoVectors(start.tangent[i - 1], start.tangent[i]) * start.director[i - 1];
  }
  return start;
}

/// Mean of eleven nodes about the one that is farthest from the axis of the tails.
double curvature_opposite(const State& state, std::size_t last) {
  const auto off = [&](std::size_t i) { return tendril::test::at(state.y, i).tail<2>().norm(); };
  std::size_t top = 6;
  for (std::size_t i = 6; i + 6 <= last; ++i)
    if (off(i) > off(top)) top = i;
  double sum = 0.0;
  for (std::size_t i = top - 5; i <= top + 5; ++i) {
    const Vec3 a = tendril::test::at(state.y, i) - tendril::test::at(state.y, i - 1),
               b = tendril::test::at(state.y, i + 1) - tendril::test::at(state.y, i);
    sum += std::atan2(a.cross(b).norm(), a.dot(b)) / (0.5 * (a.norm() + b.norm()));
  }
  return sum / 11;
}

/// r / R and F R^2 / B, R that of the loop opposite the braid, for one radius after the other.
std::vector<std::array<double, 2>> drawn_knot(const std::vector<double>& radii, double step) {
  const double tail = 6.0, pull = 0.5;
  const std::vector<Vec3> points = knotted(radii[0], tail, step);
  std::vector<Vec3> p{Vec3::Zero()}, q;
  for (std::size_t i = 1; i < points.size(); ++i)
    p.push_back(p.back() + (points[i] - points[i - 1]).norm() * Vec3::UnitX());
  for (const Vec3& x : p) q.push_back(x + 0.1 * Vec3::UnitY());
  const double section = 0.01, inertia = kPi * std::pow(section, 4) / 4, area = kPi * section * section;
  Rod rod = make_rod(p, q, {1.0 / inertia, 1.0 / inertia / 3, 1.0 / area}, circular_section(section));
  rod.mass_damping = 20.0;
  rod.viscosity = 0.01;
  Scene scene;
  scene.rods = {rod};
  const std::size_t last = p.size() - 1;
  State at;
  std::vector<std::array<double, 2>> out;
  for (const double radius : radii) {
    const double range = 0.1 * radius;
    Law law{.stiffness = 1.0, .range = range};
    law.stiffness = 3000.0 / -potential(law, 0.5 * range).slope;
    scene.forces = {
        std::make_shared<RodRodContact>(std::vector<ContactRod>{{0, radius, p}}, std::vector<RodJoint>{},
                                        law),
        std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 0, Vec3(-pull, 0, 0), Signal::constant(1.0)),
        std::make_shared<PointLoad>(PointLoad::Kind::force, 0, last, Vec3(pull, 0, 0),
                                    Signal::constant(1.0))};
    const System system(scene);
    if (out.empty()) at = start_of(system, points);
    at.memory.clear();
    const double begin = at.time;
    Simulation simulation(system, at, {.tolerance = 1e-4});
    run_to(simulation, begin + 60.0);
    const Equilibrium found = found_from(system, simulation.state(), {.first_load = 1.0});
    at = found.state;
    const double curvature = curvature_opposite(at, last);
    out.push_back({radius * curvature, pull / (curvature * curvature)});
  }
  return out;
}

}  // namespace

Case overhand_knot() {
  Case out{"K13", "Open overhand knot without friction", "F R^2 / B -> 1/2 as r / R -> 0", "", "R over r"};
  const std::vector<std::array<double, 2>> found = drawn_knot({0.01, 0.005, 0.0025}, 0.02);
  Quantity force{"F R^2 / B", 0.5, "relative"}, limit{"extrapolated in the root of r / R", 0.5, "relative"};
  std::vector<double> root, value;
  for (const auto& [thin, drawn] : found) {
    const int n = static_cast<int>(std::lround(1.0 / thin));
    force.rows.push_back(relative(n, drawn, 0.5));
    root.push_back(std::sqrt(thin));
    value.push_back(drawn);
  }
  force.limits = {{force.rows.back().n, 0.15}};
  for (std::size_t step = 1; step < value.size(); ++step)
    for (std::size_t i = value.size() - 1; i >= step; --i)
      value[i] = (value[i] * root[i - step] - value[i - 1] * root[i]) / (root[i - step] - root[i]);
  limit.rows = {relative(force.rows.back().n, value.back(), 0.5)};
  limit.limits = {{force.rows.back().n, 0.02}};
  out.quantities = {force, limit};
  return out;
}

}  // namespace tendril::contact
