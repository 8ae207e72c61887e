#pragma once

#include <tendril/dynamics/system.h>

namespace tendril::bench {

/// A scene, where it starts, and how long it moves.
struct Problem {
  std::string name;
  System system;
  State start;
  double length = 1.0;    ///< errors are relative to it
  double duration = 1.0;  ///< [s]
};

/// What varies of the clamped rod.
struct Cantilever {
  int nodes = 32;
  double young = 1e6;
  double viscosity = 0.0;   ///< Kelvin-Voigt beta [s]
  double mass_ratio = 1.0;  ///< every second mass is lighter by this
  bool twist = false;       ///< keep a twist state that nothing asks for
};

/// Rod of length 1 m, radius 5 mm, density 1000, horizontal and clamped, with drag 0.5 / s, gravity, and a
/// small velocity out of the plane. It keeps a twist state only when it is viscous.
Problem cantilever(const Cantilever& what);

/// Free rods of that section side by side, without twist state or with all of stretch, three angular springs
/// and twist, slightly bent and turned so that nothing is zero.
Problem stirred_rods(int rods, int nodes, bool full);

/// A clamped chain whose edges keep their length whatever the number of nodes.
Problem long_chain(int nodes);

/// A stem clamped at its foot, with leaves of 6 nodes joined along it, under gravity.
struct Plant {
  int leaves = 200;
  int stem_nodes = 41;
  double young = 1e8;
};
Problem plant(const Plant& what);

/// That tree bent and stirred, its springs viscous, in gusty wind or in none.
Problem swaying(const Plant& what, bool wind);

}  // namespace tendril::bench
