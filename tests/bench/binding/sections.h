#pragma once

#include <tendril/curve/curve_pair.h>

#include <string>
#include <vector>

#include "bench/command_line.h"

namespace tendril::bench {

OrderedJson update_section(Settings& settings);
OrderedJson transpose_section(Settings& settings);
OrderedJson projection_section(Settings& settings);
OrderedJson reading_section(Settings& settings);
OrderedJson tree_section(Settings& settings);
OrderedJson judging_section(Settings& settings);

/// A cubic axis with `spans` equal spans, about 10 long, with waves; and a pose of it.
CurvePair wavy_pair(int spans, double wave);

/// About `count` vertices of a tube around the axis, ring by ring.
std::vector<Vec3> tube(const CurvePair& axis, std::size_t count);

/// Seconds a frame of CGAL's as-rigid-as-possible deformation of a mesh, five iterations; 0 with a sentence
/// when there is no such mesh.
double arap_seconds(const Settings& settings, const std::string& mesh);

}  // namespace tendril::bench
