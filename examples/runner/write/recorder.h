#pragma once

#include "draw/camera.h"
#include "write/contact_tables.h"
#include "write/phases.h"

#include <tendril/scene/scene_run.h>
#include <tendril/scene/summary.h>
#include <tendril/scene/support_table.h>
#include <tendril/scene/trajectory.h>

namespace tendril::runner {

struct RecorderOptions {
  std::string folder;
  bool frames = true;  ///< write a PLY file per output
  bool double_precision = false;
};

/// Takes a run's snapshots: writes the mesh as a frame, notes the trajectory, keeps those that the pictures
/// show, and sees whether these spoil the mesh. Every file it writes is whole.
class Recorder {
 public:
  /// The scene's file and the time spent are kept by reference.
  Recorder(const scene::SceneFile& file, RecorderOptions options, Phases& phases);

  /// \param mesh  up to date with the snapshot; or null
  void take(const scene::Snapshot& snapshot, const scene::BoundMesh* mesh);

  std::size_t taken() const { return count_; }
  /// The first frame in the folder beyond those of this run, which another has left there; empty for none.
  std::string left_over() const;
  const std::vector<std::string>& files() const { return files_; }
  /// Those of the contact sheet.
  const std::vector<scene::Snapshot>& panels() const { return panels_; }
  const scene::Snapshot& last() const { return last_; }
  /// What spoils the mesh most, of the contact sheet's moments; none without a mesh.
  const std::optional<scene::SpoiltMoment>& spoilt() const { return spoilt_; }
  /// Says so on standard error where it is more than a verdict of `right` allows.
  /// \param what  that does it: "the motion"
  void warn_of_spoilt(const std::string& what) const;
  Camera camera() const { return fit_.camera(); }

  /// And the tables of solids, contacts and supports, where the scene has any or asks for them.
  void write_trajectory();
  void write(const std::string& name, const std::string& bytes);
  /// Files that another wrote into the folder.
  void note(const std::vector<std::string>& files) {
    files_.insert(files_.end(), files.begin(), files.end());
  }

 private:
  void look(const scene::Snapshot& snapshot);
  void judge(double time, const scene::BoundMesh& mesh);

  const scene::SceneFile& file_;
  RecorderOptions options_;
  Phases& phases_;
  CameraFit fit_;
  std::vector<std::size_t> numbers_;  ///< of the outputs to keep
  std::size_t count_ = 0;
  scene::Trajectory trajectory_;
  ContactTables contact_;
  scene::SupportTable supports_;
  std::vector<std::string> files_;
  std::vector<scene::Snapshot> panels_;
  scene::Snapshot last_;
  std::optional<scene::SpoiltMoment> spoilt_;
};

}  // namespace tendril::runner
