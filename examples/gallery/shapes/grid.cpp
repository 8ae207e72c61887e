#include "grid.h"

namespace tendril::gallery {

bind::PolygonMesh hanging_sheet(int columns, int rows, double width, double height) {
  bind::PolygonMesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      mesh.points.emplace_back(width * (i / (columns - 1.0) - 0.5), 0.0, -height * j / (rows - 1.0));
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const auto at = [&](int c, int r) { return static_cast<std::uint32_t>(r * columns + c); };
      for (const std::uint32_t k : {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)})
        mesh.corners.push_back(k);
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  return mesh;
}

std::vector<Vec3> middle_of_sheet(int rows, double height) {
  std::vector<Vec3> out;
  for (int j = 0; j < rows; ++j) out.emplace_back(0.0, 0.0, -height * j / (rows - 1.0));
  return out;
}

}  // namespace tendril::gallery
