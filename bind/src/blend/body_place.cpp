#include <limits>
#include <numeric>

#include "body_grid.h"

namespace tendril::bind {

/// The first of a face's in a voxel; null where there is none.
const BodyGrid::Entry* BodyGrid::entry_in(std::uint32_t face, std::uint32_t cell) const {
  const auto first = by_voxel_.begin() + first_entry_[face],
             last = by_voxel_.begin() + first_entry_[face + 1];
  const auto at = std::lower_bound(
      first, last, cell, [&](std::uint32_t entry, std::uint32_t c) { return entries_[entry].cell < c; });
  return at == last || entries_[*at].cell != cell ? nullptr : &entries_[*at];
}

/// The first of a face's nearest entries.
const BodyGrid::Entry* BodyGrid::nearest_entry(std::uint32_t face, const Vec3& at) const {
  const Entry* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = first_entry_[face]; i < first_entry_[face + 1]; ++i) {
    const Cell c = cell_at(entries_[i].cell);
    const Vec3 low(c[0], c[1], c[2]);
    const double away = 1e-12 + (at - at.cwiseMax(low).cwiseMin(low + Vec3::Ones())).norm();
    if (away < least) least = away, best = &entries_[i];
  }
  return best;
}

/// By the face and not by p alone: of several sheets in a voxel only the face says which. A point on the
/// border of voxels may be rounded into one that its face was not entered in; then the nearest of the
/// face's is taken.
GridPlace BodyGrid::place(const Vec3& p, std::uint32_t face) const {
  const Vec3 at = scaled(p);
  const Entry* best = entry_in(face, index(cell_of(at)));
  if (best == nullptr) best = nearest_entry(face, at);
  const Cell c = cell_at(best->cell);
  GridPlace out{piece_nodes_[best->piece], {}};
  const Vec3 part = (at - Vec3(c[0], c[1], c[2])).cwiseMax(0.0).cwiseMin(1.0);
  for (int k = 0; k < 8; ++k)
    out.weight[static_cast<std::size_t>(k)] = (k & 1 ? part.x() : 1.0 - part.x()) *
                                              (k & 2 ? part.y() : 1.0 - part.y()) *
                                              (k & 4 ? part.z() : 1.0 - part.z());
  return out;
}

std::vector<std::uint32_t> BodyGrid::faces_of_points(const PolygonMesh& mesh) const {
  const auto faces = static_cast<std::uint32_t>(mesh.face_count());
  std::vector<std::uint32_t> out(mesh.points.size());
  std::iota(out.begin(), out.end(), faces);
  for (std::uint32_t f = faces; f-- > 0;)
    for (const std::uint32_t i : mesh.face(f)) out[i] = f;
  return out;
}

}  // namespace tendril::bind
