#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/supports.h>
#include <tendril/scene/bound_mesh.h>

#include <functional>
#include <memory>
#include <optional>

namespace tendril::scene {

/// How a scene is run. What it computes, the file says.
struct RunOptions {
  bind::BindMode mode = bind::BindOptions{}.mode;  ///< how the mesh is bound
  std::optional<State> start = {};                 ///< default: at rest, at time 0
  int threads = 1;  ///< of binding and updates, 1 to 256; the same bits for any number
};

/// A scene at one moment, all of it a copy. Positions are in the scene's units.
struct Snapshot {
  double time = 0.0;                                 ///< of the scene
  std::vector<Vec3> points;                          ///< of the mesh, in its order; empty without a mesh
  std::vector<CurvePair> pairs;                      ///< the curve-pairs
  std::vector<std::vector<Vec3>> masses;             ///< per curve-pair and node
  std::vector<std::vector<Vec3>> orientation;        ///< the orientation masses beside them
  std::vector<SolidPose> bodies = {};                ///< of the scene's solids
  std::vector<ContactPoint> contacts = {};           ///< of rods with them
  std::vector<MeshContactPoint> mesh_contacts = {};  ///< of the mesh with them
  std::vector<MeshSelfContactPoint> mesh_self_contacts = {};  ///< and with itself
  std::vector<RodContactPoint> rod_contacts = {};             ///< of rods with each other and themselves
  std::vector<Support> supports = {};  ///< per anchor of the scene; empty unless SceneFile::supports
};

/// Seconds of wall time, outputs not counted.
struct RunSeconds {
  double bind = 0.0;      ///< the mesh to the curve-pairs, once
  double simulate = 0.0;  ///< the rods
  double update = 0.0;    ///< of the mesh, at outputs
};

/// A scene ready to run, and run. Whatever is wrong with the input has been refused once it stands.
class TENDRIL_SCENE_API SceneRun {
 public:
  /// Called at each of the scene's output times.
  using Output = std::function<void(const Snapshot&)>;
  /// Called after every accepted step with the part of the duration that is done; false cancels the run.
  using Progress = std::function<bool(double part)>;

  /// Reads the mesh that the scene names.
  /// Throws SceneError where the library refuses what the scene says, FileError or InvalidInput for the mesh.
  explicit SceneRun(SceneFile file, const RunOptions& options = {});
  /// Runs with a mesh that was read, or made, before.
  /// \param file     the scene
  /// \param mesh     in place of the scene's; empty for none
  /// \param options  how it is run
  SceneRun(SceneFile file, bind::PolygonMesh mesh, const RunOptions& options = {});
  ~SceneRun();
  SceneRun(SceneRun&&) noexcept;             ///< what was moved from may only be destroyed or assigned to
  SceneRun& operator=(SceneRun&&) noexcept;  ///< the same

  /// Runs to the end of the scene's duration, once. Anything but Stop::finished is no success; the state is
  /// then that of the last good step. The same scene gives the same bits.
  Report run(const Output& output = {}, const Progress& progress = {});

  /// The present moment; the mesh is brought up to date.
  Snapshot snapshot();

  const SceneFile& file() const;         ///< the scene
  const System& system() const;          ///< it flattened
  const Simulation& simulation() const;  ///< with the present state
  const BoundMesh* mesh() const;         ///< null without a mesh
  std::size_t outputs() const;           ///< snapshots handed out so far
  const RunSeconds& seconds() const;     ///< spent so far

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril::scene
