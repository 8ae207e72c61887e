#include "draw/shape.h"

#include <array>
#include <cmath>

namespace tendril::runner {
namespace {

constexpr float kCrease = 0.766F;  // cosine of 40 degrees

/// Light from bytes.
class Linear {
 public:
  Linear() {
    for (std::size_t k = 0; k < table_.size(); ++k)
      table_[k] = std::pow(static_cast<float>(k) / 255.0F, 2.2F);
  }
  Vec3f operator()(const bind::Color& color) const {
    return {table_[color[0]], table_[color[1]], table_[color[2]]};
  }

 private:
  std::array<float, 256> table_;
};

void add_triangles(const bind::PolygonMesh& mesh, Shape& shape) {
  const Linear linear;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      for (const std::size_t corner : {std::size_t{0}, k, k + 1}) {
        shape.triangles.push_back(face[corner]);
        if (!mesh.point_colors.empty()) {
          shape.colors.push_back(linear(mesh.point_colors[face[corner]]));
        } else if (!mesh.face_colors.empty()) {
          shape.colors.push_back(linear(mesh.face_colors[f]));
        }
      }
    }
  }
}

std::vector<Vec3f> area_normals(const Shape& shape) {
  std::vector<Vec3f> out;
  for (std::size_t k = 0; k < shape.triangles.size(); k += 3) {
    const Vec3f& a = shape.points[shape.triangles[k]];
    out.push_back((shape.points[shape.triangles[k + 1]] - a).cross(shape.points[shape.triangles[k + 2]] - a));
  }
  return out;
}

/// Triangles around each point: those of point i are list[begin[i] .. begin[i + 1]).
struct Around {
  std::vector<std::size_t> begin, list;
};

Around around_points(const Shape& shape) {
  Around out;
  out.begin.assign(shape.points.size() + 1, 0);
  for (const std::uint32_t i : shape.triangles) ++out.begin[i + 1];
  for (std::size_t i = 1; i < out.begin.size(); ++i) out.begin[i] += out.begin[i - 1];
  std::vector<std::size_t> next(out.begin.begin(), out.begin.end() - 1);
  out.list.resize(shape.triangles.size());
  for (std::size_t k = 0; k < shape.triangles.size(); ++k) out.list[next[shape.triangles[k]]++] = k / 3;
  return out;
}

Vec3f corner_normal(std::size_t triangle, std::span<const std::size_t> neighbours,
                    const std::vector<Vec3f>& area, const std::vector<float>& length) {
  const Vec3f& own = area[triangle];
  Vec3f sum = Vec3f::Zero();
  for (const std::size_t other : neighbours) {
    if (area[other].dot(own) >= kCrease * length[other] * length[triangle]) sum += area[other];
  }
  const float whole = sum.norm();
  return whole > 0.0F ? Vec3f(sum / whole) : own;
}

}  // namespace

Shape make_shape(const bind::PolygonMesh& mesh, const Vec3& centre, double size) {
  Shape shape;
  for (const Vec3& p : mesh.points) shape.points.push_back(((p - centre) / size).cast<float>());
  add_triangles(mesh, shape);
  const std::vector<Vec3f> area = area_normals(shape);
  std::vector<float> length;
  for (const Vec3f& a : area) length.push_back(a.norm());
  const Around around = around_points(shape);
  for (std::size_t k = 0; k < shape.triangles.size(); ++k) {
    const std::size_t i = shape.triangles[k];
    const auto neighbours =
        std::span(around.list).subspan(around.begin[i], around.begin[i + 1] - around.begin[i]);
    shape.normals.push_back(corner_normal(k / 3, neighbours, area, length));
  }
  return shape;
}

}  // namespace tendril::runner
