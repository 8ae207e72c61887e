// Extension point: a mesh type of one's own. What binding needs of a FaceGraph is its vertices and a vertex
// point map with points that can be indexed and made from three numbers.
#include <boost/iterator/counting_iterator.hpp>
#include <boost/property_map/property_map.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

namespace mine {

struct Point {
  Point(double x, double y, double z) : at{x, y, z} {}
  double operator[](int axis) const { return at[axis]; }
  double at[3];
};
struct Mesh {
  std::vector<Point> point;
};

std::size_t num_vertices(const Mesh& mesh) {
  return mesh.point.size();
}
auto vertices(const Mesh& mesh) {
  using Each = boost::counting_iterator<std::size_t>;
  return std::pair<Each, Each>(Each(0), Each(mesh.point.size()));
}

struct PointMap {
  using key_type = std::size_t;
  using value_type = Point;
  using reference = const Point&;
  using category = boost::read_write_property_map_tag;
  Mesh* mesh;
};
const Point& get(const PointMap& map, std::size_t i) {
  return map.mesh->point[i];
}
void put(const PointMap& map, std::size_t i, const Point& p) {
  map.mesh->point[i] = p;
}

}  // namespace mine

#include <tendril/bind/face_graph.h>
#include <tendril/curve/fit.h>
#include <tendril/dynamics/rod.h>

using namespace tendril;

/// Curve-pair through the masses p on the parameters of `fit`, its orientation towards `side`.
CurvePair pair_through(const Interpolator& fit, const std::vector<Vec3>& p, const Vec3& side) {
  return CurvePair(fit.knots(), fit.solve(p), fit.solve(orientation_towards(p, side, 1.0)));
}

int main() {
  mine::Mesh tube;
  for (int i = 0; i <= 100; ++i)
    for (int j = 0; j < 16; ++j)
      tube.point.emplace_back(0.1 * i, 0.5 * std::cos(j * M_PI / 8), 0.5 * std::sin(j * M_PI / 8));

  // Bend the tube's axis to a quarter circle of the same length.
  const double radius = 10 / (M_PI / 2);
  std::vector<Vec3> straight;
  std::vector<Vec3> bent;
  for (int i = 0; i <= 20; ++i) {
    straight.emplace_back(0.5 * i, 0, 0);
    bent.emplace_back(radius * std::sin(0.5 * i / radius), radius * (1 - std::cos(0.5 * i / radius)), 0);
  }
  const Interpolator fit(3, straight);  // parameters and knots of the rest shape, for every pose
  bind::FaceGraphFollower<mine::Mesh, mine::PointMap> follower(tube, mine::PointMap{&tube},
                                                               pair_through(fit, straight, Vec3::UnitZ()));
  follower.follow(0.0, std::vector<CurvePair>{pair_through(fit, bent, Vec3::UnitZ())});

  // Every vertex now lies at 0.5 from the quarter circle.
  double worst = 0.0;
  for (const mine::Point& p : tube.point) {
    const double from_axis = std::hypot(p[0], p[1] - radius) - radius;
    worst = std::max(worst, std::abs(std::hypot(from_axis, p[2]) - 0.5));
  }
  std::printf("the bent tube is off its torus by %.1e\n", worst);
  return worst < 1e-3 ? 0 : 1;
}
