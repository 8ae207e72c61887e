#include <tendril/base/error.h>
#include <tendril/curve/fit.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>
#include <iostream>
#include <limits>

using namespace tendril;

namespace {

std::vector<Vec3> straight_chain() {
  std::vector<Vec3> p;
  for (int i = 0; i < 5; ++i) p.emplace_back(0.25 * i, 0, 0);
  return p;
}

bool errors_name_their_place() {
  std::vector<Vec3> points = straight_chain();
  const bool before = all_finite(points);
  points[1].z() = std::numeric_limits<double>::infinity();
  const InvalidInput error("points[1]", "infinite", "finite coordinates");
  return before && !all_finite(points) && error.place() == "points[1]";
}

/// A chain bent into a circular arc of one radian, and its side with it: the frame at the end turns by as
/// much.
bool frames_turn_with_the_bend() {
  std::vector<Vec3> p = straight_chain();
  std::vector<Vec3> q = orientation_towards(p, Vec3::UnitY(), 0.1);
  const Interpolator fit(3, p);
  CurvePair pair(fit.knots(), fit.solve(p), fit.solve(q));
  for (std::vector<Vec3>* points : {&p, &q})
    for (Vec3& x : *points) x = Vec3(std::sin(x.x()), x.y(), 1 - std::cos(x.x()));
  pair.set_control_points(fit.solve(p), fit.solve(q));
  const CurveFrame end = pair.frame(1.0);
  return (end.origin - p.back()).norm() < 1e-12 && (end.frame.y - Vec3::UnitY()).norm() < 1e-12 &&
         (end.frame.z - Vec3(std::cos(1.0), 0, std::sin(1.0))).norm() < 1e-2;
}

/// A clamped rod sinks under its weight, its tip less far than in free fall.
bool a_rod_sinks() {
  const std::vector<Vec3> p = straight_chain();
  Scene scene;
  scene.rods.push_back(
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e6, 4e5, 1000}, circular_section(0.02)));
  scene.anchors.push_back({});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  const System system(scene);
  Simulation simulation(system, system.rest_state());
  const Report report = simulation.run(0.1);
  const double sunk = -simulation.pairs()[0].frame(1.0).origin.z();
  return report.stop == Stop::finished && std::abs(report.imbalance) < 1e-4 && sunk > 0.01 &&
         sunk < 0.5 * 9.81 * 0.1 * 0.1;
}

}  // namespace

int main() {
  if (!errors_name_their_place()) return 1;
  if (!frames_turn_with_the_bend()) return 2;
  if (!a_rod_sinks()) return 3;
  std::cout << "core works\n";
}
