#pragma once

#include <tendril/scene/queries.h>

#include <optional>

#include "query/target.h"

namespace tendril::runner {

/// Answers to one shape.
struct Finding {
  std::string query;       ///< "points/3": the list and place in the file
  exact::Answer answer;    ///< points and balls: with what the surface encloses, too; else as `surface`
  exact::Answer surface;   ///< with the surface alone
  exact::Inside side;      ///< where all of the shape is, unless it meets the surface: then `touching`
  exact::Nearest nearest;  ///< on the surface
  std::vector<exact::Meeting> meetings;  ///< triangles that it meets
};

/// In the order of points, balls, segments, triangles.
std::vector<Finding> ask(Target& target, const scene::Queries& queries);

/// Where the parts of a mesh that meets the other nowhere are to what that encloses.
struct Parts {
  std::size_t within = 0, outside = 0, undecidable = 0;
};

/// Answers to a second mesh: of the two surfaces, and of their parts where these meet nowhere.
struct MeshFinding {
  exact::Answer surfaces;
  std::vector<exact::Meeting> pairs;  ///< triangle of the target, triangle of the other
  exact::Nearest nearest;             ///< of the target
  std::uint32_t nearest_other = 0;    ///< triangle of the other mesh
  std::optional<Parts> parts_of_other, parts_of_target;
};
MeshFinding ask(Target& target, Target& other);

}  // namespace tendril::runner
