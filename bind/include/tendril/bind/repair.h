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
  /// Points as near as this to an earlier one become it too: a share of the bounding box's diagonal in
  /// [0, 0.01].
  double merge_distance = 0.0;
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
  MeshReport left;  ///< of the mended mesh

  bool changed() const;  ///< whether anything was mended
};

/// Mends a copy of the mesh. What is kept keeps its order, its coordinates to the last bit and its
/// attributes; the normal of a point all of whose faces were turned is turned too. Of the two ways to orient
/// a part, a closed one that lies in no other gets the one that encloses a positive volume; others that which
/// turns fewer faces, and on a tie keeps their first. Parts meet in edges of two faces.
///
/// No count of inspect() grows: points whose merging would make a non-manifold point or edge stay apart, and
/// so do those on edges whose faces then could not agree; a face stays whose loss would open the surface.
/// `left` says what is still odd.
///
/// Deterministic; time O(n log n), memory O(n). Throws InvalidInput when require_valid(mesh) does.
TENDRIL_BIND_API Repaired repair(const PolygonMesh& mesh, const RepairOptions& options = {});

}  // namespace tendril::bind
