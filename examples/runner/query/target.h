#pragma once

#include <tendril/bind/bind_options.h>
#include <tendril/exact/bound_surface.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tendril::runner {

/// What queries are held against: the triangles of a mesh as they stand, or as they follow curve-pairs and
/// are deformed where a query comes near. Faces of more than three corners are fans about their first one.
struct Target {
  std::string file;
  std::variant<exact::Surface, exact::BoundSurface> surface;
  std::vector<std::size_t> face;  ///< of each triangle, as the mesh's file counts them
  std::vector<Vec3> parts;        ///< a point on each connected part
  std::size_t out_of_reach = 0;   ///< vertices that stay where they are

  bool closed() const {
    return std::visit([](const auto& s) { return s.closed(); }, surface);
  }
};

/// Where the mesh is posed, if at all.
struct Posing {
  std::string axis;  ///< curve file at rest, of a mesh alone
  std::string pose;  ///< curve file of the same posed, or of a scene's curve-pairs
  bind::BindMode mode = bind::BindOptions{}.mode;
};

/// A scene's mesh (JSON) or a mesh alone (OFF, PLY). InvalidInput for what is wrong with any of the files,
/// and where there are no faces.
Target read_target(const std::string& path, const Posing& posing);

/// JSON by its name or first character, not a mesh.
bool is_json(const std::string& path);

}  // namespace tendril::runner
