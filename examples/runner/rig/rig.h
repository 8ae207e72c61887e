#pragma once

#include "rig/load.h"

#include <optional>

namespace tendril::runner {

/// What `tendril rig` is asked for.
struct RigOptions {
  /// A name among materials(); empty: rubber, or foam where something of rubber would have to be smaller than
  /// 0.15 m to stand.
  std::string material;
  /// The mesh's largest extent [m]; by default one metre, or what it takes for legs of the material to carry
  /// three times their share of the weight and for no limb to sag by more than 15 %.
  std::optional<double> size;
  /// feet (legs, or else what lies on the ground), middle, root, lowest, or a curve's name; empty: feet, or
  /// else middle
  std::string hold;
  std::string up;  ///< x, y, z, -x, -y, -z; empty: guessed
  /// Mean speed [m/s]; by default 8, or what pushes it aside by 2 % of its height. 0 for none.
  std::optional<double> wind;
  int threads = 1;  ///< 1 to 256; the same rig for any number
};

/// A mesh on its axes, ready to be written as a scene. Lengths are in the mesh's own unit, which is `unit`
/// metres.
struct Rig {
  std::vector<RigCurve> curves;
  std::string doubt;  ///< what speaks against the curves, if anything
  Body body{};
  Stance stance{};
  bool up_guessed = false;
  std::vector<Held> held;
  std::string held_as;  ///< as RigOptions::hold has it
  NamedMaterial material{};
  double size = 1.0;  ///< largest extent [m]
  bool size_given = false;
  double unit = 1.0;     ///< [m]
  double density = 0.0;  ///< of the rods, so that they weigh what the mesh holds [kg / unit^3]
  double overlap = 1.0;  ///< volume of the rods over that of the mesh
  double mass = 0.0;     ///< [kg]
  LoadEstimate load{};
  Vec3 wind = Vec3::Zero();  ///< [unit/s]
  double wind_speed = 0.0;   ///< [m/s]
};

/// InvalidInput naming an option that is out of range; a curve's name to hold is looked up by make_rig.
void check(const RigOptions& options);

/// \param mesh     with faces; what is open weighs what the rods do
/// \param curves   parents first
/// \param options  InvalidInput naming an option that is out of range
/// InvalidInput("mesh", ...) where the first curve is less than three times as long as its sections are wide.
Rig make_rig(const bind::PolygonMesh& mesh, std::vector<RigCurve> curves, const RigOptions& options);

/// The scene as a file: JSON with comments that say what was measured, guessed and how to change it.
/// \param mesh_path  as the scene is to name it
/// \param command    what to say that made it
std::string scene_text(const Rig& rig, const std::string& mesh_path, const std::string& command);

}  // namespace tendril::runner
