#pragma once

#include <sstream>
#include <string>

/// A scene and a mesh for it.
namespace tendril::test {

/// An upright square tube of height 1 about the y axis, open at its ends.
inline std::string tube_off(int rings = 9) {
  std::ostringstream text;
  text << "OFF\n" << 4 * rings << ' ' << 4 * (rings - 1) << " 0\n";
  for (int i = 0; i < rings; ++i) {
    const double y = static_cast<double>(i) / (rings - 1);
    for (const char* corner : {"0.1 ", "-0.1 "}) {
      const bool first = corner[0] != '-';
      text << corner << y << (first ? " 0.1\n" : " -0.1\n") << corner << y << (first ? " -0.1\n" : " 0.1\n");
    }
  }
  for (int i = 0; i + 1 < rings; ++i) {
    for (int k = 0; k < 4; ++k) {
      const int a = 4 * i + k, b = 4 * i + (k + 1) % 4;
      text << "4 " << a << ' ' << b << ' ' << b + 4 << ' ' << a + 4 << '\n';
    }
  }
  return text.str();
}

/// A scene with a part of every kind in it; fits tube_off().
inline std::string full_scene() {
  return R"({
  "version": 1,
  "units": {"length": "m", "mass": "kg", "time": "s"},
  "mesh": "tube.off",
  "bound_to": "stem",
  "curve_pairs": [
    {"name": "stem", "points": [[0, 0, 0], [0, 0.5, 0], [0, 1, 0]], "nodes": 6, "orientation": [1, 0, 0],
     "material": {"young": 2e5, "poisson": 0.4, "density": 1000},
     "section": {"type": "circular", "radius": [0.1, 0.09, 0.08]},
     "reach": 1.0, "mass_damping": 0.5, "viscosity": 0.001,
     "anchors": [{"node": 0}]},
    {"name": "chain", "points": [[1, 1, 0], [1.2, 1, 0], [1.4, 1, 0], [1.6, 1, 0]],
     "orientation": [[1, 1, 1], [1.2, 1, 1], [1.4, 1, 1], [1.6, 1, 1]],
     "springs": {"stretch": 400, "bend_l": 0.01, "bend_m": 0.01, "twist": 0.01, "mass": 0.02, "inertia": 1e-5},
     "anchors": [{"nodes": [0, 1], "hold": "position",
                  "rotation": {"axis": [0, 0, 1], "amplitude": 0.1, "frequency": 1, "about": [1, 1, 0]},
                  "translation": {"amplitude": [0, 0.1, 0], "frequency": 2, "phase": 0}}]}
  ],
  "forces": [
    {"type": "gravity", "acceleration": [0, -9.81, 0]},
    {"type": "wind", "mean": [2, 0, 0], "gust": 0.5, "switched": {"table": [[0, 0], [0.1, 1]]}},
    {"type": "force", "curve_pair": "stem", "node": -1, "direction": [0, 0, 1],
     "signal": {"sinusoid": {"amplitude": 2, "frequency": 3}}},
    {"type": "torque", "curve_pair": "stem", "node": 3, "direction": [0, 1, 0], "signal": 0.1},
    {"type": "pull", "curve_pair": "chain", "node": 3, "target": [1.6, 1.2, 0], "stiffness": 3}
  ],
  "simulation": {"duration": 0.1, "tolerance": 1e-4, "frames": 6},
  "picture": {"size": [96, 64], "samples": 2, "panels": 3, "axis": true}
})";
}

}  // namespace tendril::test
