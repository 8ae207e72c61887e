#include <tendril/bind/mesh_follower.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/curve/fit.h>
#include <tendril/dynamics/rod.h>

#include <iostream>

using namespace tendril;

namespace {

/// Three points bound to a chain go with it when it is turned and moved as a whole.
bool points_follow_their_axis() {
  const auto moved = [](const Vec3& x) { return Vec3(3 - x.y(), x.x(), x.z() - 1); };
  std::vector<Vec3> p;
  for (int i = 0; i < 5; ++i) p.emplace_back(i, 0.1 * i * i, 0);
  std::vector<Vec3> q = orientation_towards(p, Vec3::UnitZ(), 1.0);
  const Interpolator fit(3, p);
  const CurvePair rest(fit.knots(), fit.solve(p), fit.solve(q));
  const std::vector<Vec3> points{{0.5, 0.5, 0}, {2, 0, 0.7}, {5, 2, -0.3}};
  const bind::Binding binding(rest, points);

  for (Vec3& x : p) x = moved(x);
  for (Vec3& x : q) x = moved(x);
  const std::vector<CurvePair> posed{{fit.knots(), fit.solve(p), fit.solve(q)}};
  std::vector<Vec3> out(points.size());
  bind::MeshFollower(binding, 0, out).follow(0.0, posed);
  for (std::size_t i = 0; i < points.size(); ++i)
    if ((out[i] - moved(points[i])).norm() > 1e-12) return false;
  return true;
}

}  // namespace

int main() {
  const std::vector<Vec3> corners{{0, 0, 0}, {3, 4, 12}};
  if (bind::bounding_diagonal(corners) != 13.0) return 1;
  if (!points_follow_their_axis()) return 2;
  std::cout << "bind works\n";
}
