#pragma once

#include "rig/rig.h"

namespace tendril::runner {

/// Where the axes of a mesh come from.
struct RigAxes {
  std::string file;  ///< of curves; empty: found
  bool close = false, largest_part = false;
  std::optional<double> spacing;  ///< of nodes
};

/// The axes that `tendril axis` finds; InvalidInput where it finds none.
/// \param path  the mesh's, for messages
/// \param doubt  says what speaks against them, if anything
std::vector<RigCurve> find_curves(const bind::PolygonMesh& mesh, const std::string& path, const RigAxes& how,
                                  std::string& doubt);

/// A mesh on its axes.
Rig rig_mesh(const bind::PolygonMesh& mesh, const std::string& path, const RigAxes& axes,
             const RigOptions& options);

/// Writes the scene; the mesh is named by its path as seen from there.
void write_rig(const Rig& rig, const std::string& mesh, const std::string& out, const std::string& command);

/// What was guessed, in lines.
void tell(const Rig& rig);

}  // namespace tendril::runner
