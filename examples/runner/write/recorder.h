#pragma once

#include "draw/camera.h"
#include "read/scene_reader.h"
#include "write/phases.h"

#include <tendril/bind/mesh_follower.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/dynamics/simulation.h>

namespace tendril::runner {

/// A moment kept for the pictures.
struct Moment {
  double time = 0.0;
  std::vector<Vec3> points;  ///< of the mesh
  std::vector<CurvePair> pairs;
  std::vector<std::vector<Vec3>> masses;  ///< per curve-pair
};

struct RecorderOptions {
  std::string folder;
  bool frames = true;  ///< write a PLY file per output
  bool double_precision = false;
  int threads = 1;
};

/// A mesh point out of reach of the curve-pair, and where it stays.
struct StillPoint {
  std::size_t index;
  Vec3 position;
};

/// How far a curve-pair reaches at its nodes, whose parameters on the curve ascend; empty for everywhere.
struct Reach {
  std::span<const double> distance, parameters;
};

/// The points of the mesh whose distance from the curve they are nearest to is beyond its reach there.
/// \param reach  of each of the binding's curve-pairs
std::vector<StillPoint> still_points(const bind::Binding& binding, Points rest, std::span<const Reach> reach);

/// Follows a run at its outputs: brings the mesh up to date, writes it as a frame, notes the trajectory, and
/// keeps the moments that the pictures show. Every file it writes is whole.
class Recorder : public Follower {
 public:
  /// All kept by reference. \param binding  null when there is no mesh
  Recorder(const SceneFile& file, const System& system, const Simulation& simulation, bind::PolygonMesh& mesh,
           const bind::Binding* binding, RecorderOptions options, Phases& phases);

  void follow(double time, std::span<const CurvePair> pairs) override;

  std::size_t outputs() const { return count_; }
  std::size_t still() const { return still_.size(); }
  const std::vector<std::string>& files() const { return files_; }
  const std::vector<Moment>& moments() const { return moments_; }
  const Moment& last() const { return last_; }
  const Simulation& simulation() const { return simulation_; }
  Camera camera() const { return fit_.camera(); }

  /// Writes trajectory.csv: time,rod,node,px,py,pz,qx,qy,qz, numbers in their shortest exact form.
  void write_trajectory();
  void write(const std::string& name, const std::string& bytes);

 private:
  void update_mesh(double time, std::span<const CurvePair> pairs);
  void note_trajectory(double time);
  void look(const Moment& moment);

  const SceneFile& file_;
  const System& system_;
  const Simulation& simulation_;
  bind::PolygonMesh& mesh_;
  std::optional<bind::MeshFollower> follower_;
  std::vector<StillPoint> still_;
  RecorderOptions options_;
  Phases& phases_;
  System::WorkspacePtr work_;
  CameraFit fit_;
  std::vector<std::size_t> panels_;  ///< numbers of the outputs to keep
  std::size_t count_ = 0;
  std::string trajectory_ = "time,rod,node,px,py,pz,qx,qy,qz\n";
  std::vector<std::string> files_;
  std::vector<Moment> moments_;
  Moment last_;
};

}  // namespace tendril::runner
