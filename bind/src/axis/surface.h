#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <memory>

namespace tendril::axis {

/// The door to CGAL's queries of a closed triangle mesh.
class Surface {
 public:
  explicit Surface(const bind::PolygonMesh& mesh);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  double distance(const Vec3& p) const;
  bool holds(const Vec3& p) const;  ///< p lies inside, decided exactly

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril::axis
