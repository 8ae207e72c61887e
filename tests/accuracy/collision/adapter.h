#pragma once

#include <tendril/collision/continuous.h>
#include <tendril/collision/hierarchy_options.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// What a library is asked by the collision accuracy suite. An adapter is one file in peers/ that fills in
/// what its library has, and a line in adapters.cpp.
namespace tendril::suite {

using Corners = std::array<Vec3, 3>;
using Ends = std::array<Vec3, 2>;
using Triangles = std::span<const collision::Triangle>;
/// Whether two closed sets meet; nothing where the library cannot say.
using Said = std::optional<bool>;

/// A mesh as a library has taken it in.
class MeshPeer {
 public:
  virtual ~MeshPeer() = default;
  /// The point is within what the mesh encloses, or on it.
  virtual Said holds(const Vec3&) { return {}; }
  /// The solid ball meets the surface.
  virtual Said meets(const Vec3& /*centre*/, double /*radius*/) { return {}; }
};

/// For Adapter::mesh.
template <class Mesh>
std::unique_ptr<MeshPeer> mesh_of(Points points, Triangles triangles) {
  return std::make_unique<Mesh>(points, triangles);
}

/// Null where the library has no such test. All sets are closed.
struct Adapter {
  std::string name;
  bool proper = false;  ///< asks for triangles with an area and segments with a length
  Said (*triangles)(const Corners&, const Corners&) = nullptr;
  Said (*segment)(const Corners&, const Ends&) = nullptr;
  double (*distance)(const Corners&, const Corners&) = nullptr;  ///< NaN where it cannot say
  std::unique_ptr<MeshPeer> (*mesh)(Points, Triangles) = nullptr;
  bool holds = false, meets = false;  ///< which questions its meshes answer
  Said (*straight)(collision::Features, const collision::Paths<1>&) = nullptr;
  Said (*cubic)(collision::Features, const collision::Paths<3>&) = nullptr;
};

/// tendril's own, a plain solver in doubles, and those of the libraries that were found when this was built.
std::vector<Adapter> adapters();

}  // namespace tendril::suite
