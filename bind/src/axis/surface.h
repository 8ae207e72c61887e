#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <memory>
#include <optional>

namespace tendril::axis {

/// The only use of CGAL's queries of a closed triangle mesh.
class Surface {
 public:
  explicit Surface(const bind::PolygonMesh& mesh);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  Vec3 nearest(const Vec3& p) const;
  double distance(const Vec3& p) const;
  /// Where the ray from p along the unit vector d first meets the surface: p + result * d.
  std::optional<double> first_hit(const Vec3& p, const Vec3& d) const;
  bool holds(const Vec3& p) const;  ///< p lies inside, decided exactly

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril::axis
