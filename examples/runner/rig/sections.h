#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <optional>
#include <string>

namespace tendril::runner {

/// Where a curve starts: at a node of an earlier one.
struct RigJoint {
  std::size_t parent, node;
};

/// An axis of the mesh, before anything is known of what is around it.
struct RigCurve {
  std::string name;
  std::vector<Vec3> points;         ///< its nodes, at least 2
  std::vector<Vec3> orientation;    ///< beside them
  std::vector<double> radius = {};  ///< distance to the surface at the nodes; may be empty
  std::optional<RigJoint> joint = {};
};

/// The ellipse with a section's area and second moments: semi-axes along l and m of the node's frame.
struct RigSection {
  double a, b;
  bool seen;  ///< false where the mesh shows no section of its own there, within a joint say
};

/// What is around the axes of a mesh.
struct Body {
  std::vector<std::vector<RigSection>> sections;  ///< per curve and node
  double volume = 0.0;                            ///< of the mesh; 0 where it is not closed
  /// Skin of the last edge and a half at a curve's first and at its last node: the mesh's points there.
  std::vector<std::vector<Vec3>> first_skin, last_skin;
};

/// Measures a mesh about its axes, and turns the orientation of each curve about it by one angle, at
/// most 45 degrees, so that l and m are the principal directions of its sections on the whole.
///
/// Each triangle of the mesh, long ones split first, is taken to the axial space of the axis that its corners
/// are nearest to and cut there at four planes an edge. A cut adds the wedges from the axis to its pieces to
/// the plane's area and moments, with the sign that the way round it has; what lies outside the skin cancels.
/// Where a limb leaves the skin of another, part of the way round is missing: the rest stands for all of it
/// down to a third of the way, below that the nearest sections do. Within the body that a limb is joined to,
/// its sections go over into that body's.
///
/// InvalidInput naming a curve that has no skin and no radius of its own, or whose frames do not carry on.
/// Cost: a projection a point.
/// \param threads  1 to 256; the same bits for any number
Body measure_body(const bind::PolygonMesh& mesh, std::vector<RigCurve>& curves, int threads = 1);

}  // namespace tendril::runner
