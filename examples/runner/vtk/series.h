#pragma once

#include "vtk/vtu.h"

#include <tendril/scene/scene_run.h>

namespace tendril::runner {

/// A run as a time series for ParaView: `run.pvd`, and for each output `mesh_NNNN.vtu` (part 0),
/// `rods_NNNN.vtu` (part 1) and, where the scene has contact, `contacts_NNNN.vtu` (part 2). Each file has the
/// time (TimeValue) and the energies of the scene as fields of the whole.
///
/// Fields of the mesh's points: displacement from rest, shares (places of the axes that a point is bound to:
/// more than one beside a jump of the nearest), curve_pair, follows (0 beyond reach). Of the rods' masses:
/// curve_pair, director (unit, towards the orientation mass), width. Of contacts: gap, normal, force, sticks.
class VtkSeries {
 public:
  /// \param run  kept by reference
  VtkSeries(const scene::SceneRun& run, std::string folder);

  void take(const scene::Snapshot& snapshot);
  /// Writes the list of what was taken. The names of all files, in the order they were written.
  std::vector<std::string> finish();

 private:
  void write(const std::string& kind, int part, const Energies& energies, VtkGrid grid);
  void add_mesh_fields(VtkGrid& grid, const scene::Snapshot& snapshot) const;

  const scene::SceneRun& run_;
  std::string folder_;
  System::WorkspacePtr work_;
  std::vector<Vec3> rest_;
  std::vector<std::int32_t> shares_, pair_, follows_;
  std::size_t count_ = 0;
  double time_ = 0.0;
  std::vector<PvdEntry> entries_;
};

}  // namespace tendril::runner
