#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/curve_pair.h>
#include <tendril/curve/fit.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tendril::scene {

/// Where a curve of a file starts.
struct CurveJoint {
  std::size_t parent;  ///< which of the file's curves, an earlier one
  std::size_t node;    ///< of its points
};

/// A curve-pair as its file gives it.
struct CurveFile {
  CurvePair pair;                        ///< the curves, clamped on [0, 1] where they go through points
  std::vector<Vec3> masses;              ///< the points of a chain; empty where the file gives control points
  std::optional<Interpolator> through;   ///< what put the curves through them; nothing with control points
  std::string place;                     ///< "file#/pointer", for messages
  std::string name = {};                 ///< as the file calls it; empty where it does not
  std::optional<CurveJoint> joint = {};  ///< none for a curve of its own
};

/// Reads a curve file: JSON with comments, held against curve.schema.json and then built. It gives either
/// `control_points` and `orientation_control_points` on `knots`, or a chain of `points` that the curves are
/// to pass through, with an `orientation`: one direction for all, or a point beside each.
///
/// \param path  also the name in messages
/// \param rest  where the file and `rest` are both chains of as many points, the curves get the parameters
///   and knots of `rest`, as when the rest shape moves; otherwise those of the file's own points
///
/// Throws SceneError for what the file says, FileError when it cannot be read. O(file).
TENDRIL_SCENE_API CurveFile read_curve(const std::string& path, const CurveFile* rest = nullptr);

/// The same for a file that may hold a list of curve-pairs, as `tendril axis` writes them.
/// \param path  also the name in messages
/// \param rest  one for each of the file's curve-pairs, else SceneError; or empty
TENDRIL_SCENE_API std::vector<CurveFile> read_curves(const std::string& path,
                                                     std::span<const CurveFile> rest = {});

}  // namespace tendril::scene
