#pragma once

#include <tendril/base/types.h>
#include <tendril/bind/polygon_mesh.h>

#include <string>
#include <vector>

namespace tendril::gallery {

/// Where a sketch is seen from: right and up of the picture in the world, unit and across each other.
struct View {
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitZ();
};
/// From the direction `from` (towards the eye), with `up` as far up as that allows.
View seen_from(const Vec3& from, const Vec3& up = Vec3::UnitZ());

/// A picture of faces, lines and dots in space: projected straight, painted from the back to the front,
/// faces shaded by how they are turned. For small meshes.
class Sketch {
 public:
  explicit Sketch(const View& view) : view_(view) {}

  /// \param points  as many as the mesh has
  void faces(const bind::PolygonMesh& mesh, Points points, const std::string& colour, double opacity = 1.0);
  void line(Points points, const std::string& colour, double width = 1.2);
  void edge(const Vec3& a, const Vec3& b, const std::string& colour, double width = 1.0);
  void dot(const Vec3& point, const std::string& colour, double radius = 3.0);
  void words(const Vec3& point, const std::string& text);

  /// The picture of that width [px], as high as it needs to be at one scale.
  std::string svg(double width, const std::string& title) const;

 private:
  struct Item {
    enum class Kind { face, line, dot, words } kind;
    std::vector<Vec3> corners;  ///< right, up, towards the eye
    std::string colour, text;
    double size, depth, opacity = 1.0;
  };
  struct Frame;
  static std::string drawn(const Item& item, const Frame& frame);
  Vec3 project(const Vec3& point) const;
  void add(Item item);

  View view_;
  std::vector<Item> items_;
};

}  // namespace tendril::gallery
