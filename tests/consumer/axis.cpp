#include <tendril/axis/find_axis.h>

#include <cmath>
#include <iostream>

using namespace tendril;

namespace {

/// A box of eight corners and twelve triangles, five times as long as it is wide.
bind::PolygonMesh box() {
  bind::PolygonMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.emplace_back(k & 1 ? 5.0 : 0.0, k & 2 ? 1.0 : 0.0, k & 4 ? 1.0 : 0.0);
  mesh.corners = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  for (std::uint32_t f = 1; f <= 12; ++f) mesh.face_begin.push_back(3 * f);
  return mesh;
}

}  // namespace

int main() {
  axis::AxisOptions options;
  options.least_points = 500;
  const axis::AxisTree tree = axis::find_axis(box(), options);
  if (tree.status != axis::AxisStatus::found || tree.curves.size() != 1) return 1;
  const Vec3 middle = axis::pair_of(tree.curves[0]).primary().value(0.5);
  if (std::abs(middle.y() - 0.5) > 0.2 || std::abs(middle.z() - 0.5) > 0.2) return 2;
  std::cout << "axis works\n";
}
