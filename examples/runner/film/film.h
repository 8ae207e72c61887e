#pragma once

#include <tendril/scene/scene_run.h>

namespace tendril::runner {

/// A point where things meet, and the force there.
struct Meeting {
  Vec3 point, force;
};

/// What moves, at one output of a run.
struct Moment {
  double time;                            ///< of the scene
  std::vector<CurvePair> pairs;           ///< all of them
  std::vector<std::vector<Vec3>> masses;  ///< on them
  Energies energies;                      ///< of the scene
  std::vector<scene::SolidPose> bodies;   ///< of its solids
  std::vector<Meeting> meetings;          ///< of all kinds
};

/// An accepted step.
struct Step {
  double end, size;  ///< [time]
};

/// A run kept for what is made of all its outputs together. The mesh's points are not kept, since they
/// follow from the curve-pairs: memory is that of the control points.
class Film {
 public:
  /// \param run  not begun yet; kept by reference
  explicit Film(const scene::SceneRun& run);

  void take(const scene::Snapshot& snapshot);
  /// To be called after every accepted step.
  void note_step();

  const scene::SceneFile& file() const { return run_.file(); }
  const std::vector<Moment>& moments() const { return moments_; }

  /// The moment as it was taken, but for what is known of contacts.
  scene::Snapshot snapshot(std::size_t moment) const;
  /// The time of the scene that goes by in a second of watching: 1, where the run is neither too short nor
  /// too long for that.
  double pace() const;
  /// How long each moment is watched, at that pace.
  std::vector<double> seconds() const;

  const std::vector<Step>& steps() const { return steps_; }
  /// All curve-pairs at rest.
  const std::vector<CurvePair>& rest_of_all() const { return rest_of_all_; }
  /// Of the masses on a curve-pair.
  std::span<const double> parameters(std::size_t pair) const { return run_.simulation().parameters(pair); }

  /// The mesh at rest; none of it without a mesh, and the same of what follows.
  const bind::PolygonMesh& mesh() const { return mesh_; }
  const bind::Binding& binding() const { return run_.mesh()->binding(); }
  /// Points beyond reach, which stay, ascending.
  std::span<const std::size_t> still() const { return run_.mesh()->out_of_reach(); }
  /// The curve-pairs that the mesh is bound to, at rest, in the order of the binding.
  const std::vector<CurvePair>& rest() const { return rest_; }
  /// The same at a moment.
  std::vector<CurvePair> posed(std::size_t moment) const;
  /// The mesh's points at a moment: to the last bit those of the run.
  std::vector<Vec3> points(std::size_t moment) const;

 private:
  const scene::SceneRun& run_;
  System::WorkspacePtr work_;
  bind::PolygonMesh mesh_;
  std::vector<CurvePair> rest_of_all_, rest_;
  std::vector<Moment> moments_;
  std::vector<Step> steps_;
};

}  // namespace tendril::runner
