#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/inspect.h>

namespace tendril::bind {

/// What is mended, in this order. Nothing else is touched: holes stay, edges of more than two faces stay.
struct RepairOptions {
  bool merge_points = true;     ///< points with the coordinates of an earlier one become it
  bool drop_degenerate = true;  ///< faces without area, or that name a point twice (see inspect.h)
  bool drop_duplicates = true;  ///< faces of the same points as an earlier one
  bool orient = true;           ///< turns faces over so that neighbours across an edge of two faces agree
  bool drop_isolated = true;    ///< points in no face
};

/// The id of what is no longer there.
inline constexpr std::uint32_t kDropped = 0xffffffff;

/// A mended mesh, and what became of every point and face of the one before.
struct TENDRIL_BIND_API Repaired {
  PolygonMesh mesh;                  ///< mended
  std::vector<std::uint32_t> point;  ///< per point before, its id now; of merged points that of the one kept
  std::vector<std::uint32_t> face;   ///< per face before, its id now
  std::vector<std::uint32_t> shortened;  ///< faces now that lost corners which merged with the one before
  std::vector<std::uint32_t> turned;     ///< faces now that were turned over
  /// Edges of two faces whose faces could not be made to agree: the surface has one side only (Moebius).
  std::vector<Edge> one_sided;

  bool changed() const;  ///< whether anything was mended
};

/// Mends a copy of the mesh. What is kept keeps its order, its coordinates to the last bit and its
/// attributes; the normal of a point all of whose faces were turned is turned too. Of the two ways to orient
/// a part, the one that turns fewer faces is taken, and on a tie the one that keeps its first face; parts
/// meet in edges of two faces. Dropping a face without area may open a slit between its neighbours: inspect()
/// says so afterwards.
///
/// Deterministic; time O(n log n), memory O(n). Throws InvalidInput when require_valid(mesh) does.
TENDRIL_BIND_API Repaired repair(const PolygonMesh& mesh, const RepairOptions& options = {});

}  // namespace tendril::bind
