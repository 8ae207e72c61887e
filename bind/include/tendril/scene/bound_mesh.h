#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/distortion.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/scene/scene_file.h>

#include <string>
#include <vector>

namespace tendril::scene {

/// The scene's mesh, or an empty one where it names none.
/// \param file   the scene
/// \param notes  gets what is odd about the mesh's file but not refused, and which curve-pairs it does not
///               follow where the scene does not say; or null, and what is odd is refused
/// Throws FileError or InvalidInput, "mesh:line", as bind::read_mesh, and where the mesh has no points.
TENDRIL_SCENE_API bind::PolygonMesh read_scene_mesh(const SceneFile& file,
                                                    std::vector<std::string>* notes = nullptr);

/// A mesh on the curve-pairs that its scene names: points within reach of theirs follow, the others stay.
/// A vertex is out of reach where its distance from the curve it is bound to is beyond that curve-pair's
/// `reach`, linear between the nodes.
class TENDRIL_SCENE_API BoundMesh {
 public:
  /// Bound at rest, on the knots that a Simulation of the scene uses. Cost: that of a bind::Binding.
  /// \param file     the scene; not kept
  /// \param mesh     at rest; its normals are dropped, since they would not follow
  /// \param mode     how vertices near jumps of the nearest point are bound
  /// \param threads  1 to 256; the same bits for any number
  ///
  /// Throws InvalidInput that names the mesh's file; SceneError where the frames of a curve-pair jump at
  /// rest.
  BoundMesh(const SceneFile& file, bind::PolygonMesh mesh, bind::BindMode mode, int threads = 1);

  /// Moves the mesh to the curve-pairs. Cost: that of bind::Binding::update.
  /// \param pairs    all curve-pairs of the scene, as Simulation::pairs gives them
  /// \param threads  1 to 256; the same bits for any number
  void update(std::span<const CurvePair> pairs, int threads = 1);

  /// What the last update does to the mesh's triangles (bind/distortion.h); nothing before the first. Those
  /// between vertices that follow and others out of reach count. Cost: O(points + corners), a frame a point.
  bind::Distortion distortion() const;

  /// As of the last update; at rest before the first.
  const bind::PolygonMesh& mesh() const { return mesh_; }
  /// What the mesh is bound by; to the curve-pairs of SceneFile::bound_to, in their order.
  const bind::Binding& binding() const { return binding_; }
  /// Vertices out of reach, ascending.
  std::span<const std::size_t> out_of_reach() const { return still_; }

 private:
  std::vector<Vec3> rest_;             ///< the mesh's points
  std::vector<CurvePair> rest_pairs_;  ///< that it follows
  bind::PolygonMesh mesh_;
  bind::Binding binding_;
  std::vector<std::size_t> bound_to_;
  std::vector<std::size_t> still_;
  std::vector<Vec3> still_at_;
  std::vector<CurvePair> posed_;  ///< of the last update
};

}  // namespace tendril::scene
