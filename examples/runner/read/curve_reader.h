#pragma once

#include "read/json_reader.h"

#include <tendril/curve/curve_pair.h>
#include <tendril/curve/fit.h>

#include <optional>

namespace tendril::runner {

/// A curve-pair as its file gives it.
struct CurveFile {
  CurvePair pair;
  std::vector<Vec3> masses;  ///< the points of a chain; empty when the file gives control points
  std::optional<Interpolator> through;
  std::string place;  ///< in the file, for messages
};

/// Reads a curve file: held against curve.schema.json, then built. Throws InvalidInput with file and JSON
/// pointer (or line:column), FileError when it cannot be read.
///
/// \param rest  when the file and `rest` are both chains of as many masses, the curves get the parameters and
///   knots of `rest`, as when the rest shape moves; otherwise those of the file's own points
CurveFile read_curve(const std::string& path, const CurveFile* rest = nullptr);

/// The same for a file that may hold a list of curve-pairs, as `tendril axis` writes them.
/// \param rest  as many as the file holds, else refused; or null
std::vector<CurveFile> read_curves(const std::string& path, std::span<const CurveFile> rest = {});

/// The curve-pairs of the files of axes at rest and, one file for each or none, of their poses. Each posed one
/// is on the knots of its rest, else refused.
struct Axes {
  std::vector<CurvePair> rest, posed;
};
Axes read_axes(const std::vector<std::string>& rest, const std::vector<std::string>& posed);

Parametrisation read_parametrisation(const JsonNode& parent);

/// Orientation points for `p`: `orientation` is one direction for all, or a list of as many points.
std::vector<Vec3> read_orientation(const JsonNode& orientation, const std::vector<Vec3>& p, double offset);

/// Mean edge length of a chain; InvalidInput at a point equal to the one before it.
double mean_edge(const JsonNode& points, const std::vector<Vec3>& p);

}  // namespace tendril::runner
