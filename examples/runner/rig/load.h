#pragma once

#include "rig/materials.h"
#include "rig/stance.h"

namespace tendril::runner {

inline constexpr double kGravity = 9.81;    ///< [m/s^2]
inline constexpr double kAirDensity = 1.2;  ///< [kg/m^3]

/// Nodes of a curve that are held.
struct Held {
  std::size_t curve, first, last;
};

/// What a body's weight does to it, by the formulas of straight uniform beams: enough to tell a size at which
/// it stands from one at which it lies.
struct LoadEstimate {
  double period = 0.0;  ///< of the slowest limb's first bending mode [s]
  std::string slowest;  ///< the name of its curve, or "all on its leg"
  /// Most that a limb's end comes down, over its length; small angles.
  double sag = 0.0;
  /// Least of Euler's load of a leg over its share of the weight; infinite where nothing stands on legs.
  double carries = 0.0;
  /// How far a wind of 1 m/s pushes the body aside on its legs, over its height; it goes with the square of
  /// the speed. 0 where nothing stands on legs.
  double sway = 0.0;
};

/// With the weight on all feet alike. At a unit u times as long the period is u times as long, the sag u
/// times as large, and legs carry 1 / u of what they did.
/// \param unit  length of the mesh's unit [m]
LoadEstimate estimate_load(const std::vector<RigCurve>& curves, const Body& body, const Stance& stance,
                           const std::vector<Held>& held, const NamedMaterial& material, double unit);

/// Of the rods, as elliptic cylinders between their nodes [unit^3].
double volume_of_rods(const std::vector<RigCurve>& curves, const Body& body);

/// Length of the first curve over the mean width of its sections.
double slenderness(const std::vector<RigCurve>& curves, const Body& body);

}  // namespace tendril::runner
