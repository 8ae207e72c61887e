#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/scene.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics_options.h>
#include <tendril/dynamics/system.h>
#include <tendril/scene/contact.h>
#include <tendril/scene/scene_error.h>
#include <tendril/scene/view.h>

#include <map>
#include <optional>
#include <string_view>

namespace tendril::scene {

/// How some curve-pairs move at the start: as one rigid body, added to what else moves them. What is held
/// moves as its anchor says.
struct StartMotion {
  std::vector<std::size_t> curve_pairs;  ///< at least one
  Vec3 velocity = Vec3::Zero();          ///< [length / time]
  Vec3 spin = Vec3::Zero();              ///< angular velocity [rad / time]
  std::optional<Vec3> about;  ///< a point that the spin leaves in place; none: their centre of mass
};

/// Everything a scene file says, checked, with the library's own types filled in. All numbers are in the
/// scene's units. May be changed before it is run.
struct SceneFile {
  std::string path;                          ///< as given to the reader; the name in messages
  std::string text;                          ///< the file itself, so that errors found later can name a line
  Scene scene;                               ///< rods in the order of `curve_pairs`
  std::map<std::string, std::string> units;  ///< words for "length", "mass" and "time", where given
  std::vector<std::string> names;            ///< of the curve-pairs
  std::vector<double> thickness;             ///< of the curve-pairs: twice the largest radius
  std::vector<std::vector<double>> reach;    ///< per curve-pair and node: how far from it a mesh follows;
                                             ///< empty where everything does
  std::vector<std::string> joint_places;     ///< JSON pointer of each joint of the scene,
  std::vector<std::string> anchor_places;    ///< of each anchor (a range of nodes has one for each)
  std::vector<std::string> force_places;     ///< and of each force
  std::vector<SceneBody> bodies;             ///< solids that rods meet
  std::optional<std::size_t> contact;        ///< index of their contact among the scene's forces
  MeshForce mesh_contact;                    ///< where the mesh, not its rods, meets the solids
  MeshForce mesh_self_contact;               ///< where it meets itself
  std::optional<std::size_t> self_contact;   ///< of that of rods with each other and themselves
  std::string mesh;                          ///< path relative to the working folder; empty for none
  std::vector<std::size_t> bound_to;         ///< curve-pairs that the mesh follows, at least one
  bool bound_by_default = false;             ///< the file does not say which
  std::vector<StartMotion> start_motions;    ///< see start_state
  bool start_at_equilibrium = false;         ///< of all forces, at time 0; else at rest, unstressed
  std::string start_place;                   ///< JSON pointer of what says so
  SimulationOptions options;                 ///< method, tolerance, limits, degree of the curves
  StaticsOptions statics;                    ///< the load from which its equilibrium is followed
  double duration = 0.0;                     ///< positive
  std::vector<double> outputs;               ///< times, ascending from 0, none beyond the duration
  bool supports = false;                     ///< whether outputs say what anchors do: Snapshot::supports
  ViewOptions view;                          ///< how to draw it
  int panels = 12;                           ///< pictures of a contact sheet, 1 to 100
  bool draw_axis = false;                    ///< whether curve-pairs are drawn over the mesh
};

/// Reads and checks a scene file: JSON with comments, held against scene.schema.json, then beyond what a
/// schema can say. Rods whose section varies along their points have it taken at the nodes for bending and
/// halfway along the edges for stretch, twist and mass. The mesh is not opened.
///
/// Throws SceneError for what the file says, FileError when it cannot be read. O(file).
TENDRIL_SCENE_API SceneFile read_scene(const std::string& path);

/// The same of a text in memory.
/// \param text  what the file would hold
/// \param name  stands for the file: in messages, and relative to it the scene's mesh is found
TENDRIL_SCENE_API SceneFile parse_scene(std::string_view text, const std::string& name);

/// What the library says of `rods[i]`, `joints[i]`, `anchors[i]` or `forces[i]`, said of that part of the
/// scene file; anything else is said of the file as a whole. A SceneError is passed on as it is.
TENDRIL_SCENE_API SceneError in_scene(const SceneFile& file, const InvalidInput& error);

/// The scene flattened, ready for a Simulation or a search for its equilibrium.
/// Throws SceneError where the library refuses the scene or its rest state.
TENDRIL_SCENE_API System make_system(const SceneFile& file);

/// Where and how the scene starts, at time 0.
/// \param file    the scene
/// \param system  of make_system
/// Throws SceneError where there is no equilibrium to start from. Cost: that of find_equilibrium where asked
/// for.
TENDRIL_SCENE_API State start_state(const SceneFile& file, const System& system);

}  // namespace tendril::scene
