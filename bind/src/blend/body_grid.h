#pragma once

#include <tendril/bind/polygon_mesh.h>
#include <tendril/curve/bspline.h>

#include "mesh/neighbours.h"

namespace tendril::bind {

/// A point of the surface among the grid's nodes: trilinear weights, which sum to 1.
struct GridPlace {
  std::array<std::uint32_t, 8> node;
  std::array<double, 8> weight;

  /// \param value  of a node
  template <class Value>
  double mean(const Value& value) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < 8; ++k)
      if (weight[k] > 0.0) sum += weight[k] * value(node[k]);
    return sum;
  }
};

/// A body on a grid of voxels, after [Dionne and de Lasa 2013]: the voxels that a surface meets, and all that
/// cannot be reached from outside but through these. So holes narrower than a voxel are closed, and open,
/// self-crossing and several surfaces make one body.
///
/// Where several sheets of the surface pass through a voxel unconnected, as those of two fingers side by
/// side do, each is a piece of its own, with nodes of its own at the corners of the voxel. What is known at
/// the nodes and interpolated in between is continuous along the surface, and does not leap over a gap,
/// however narrow. All this depends on the surface as a set of points and what it joins alone, not on how
/// it is cut into faces.
class BodyGrid {
 public:
  /// \param mesh    valid; faces of more than three corners are fans
  /// \param voxels  along the longest side of its bounding box
  BodyGrid(const PolygonMesh& mesh, int voxels);

  /// Of each, the mean by area of the surface in the voxels beside it: the place that stands for it.
  Points nodes() const { return nodes_; }
  const Neighbours& neighbours() const {
    return neighbours_;
  }                                      ///< of nodes, along edges and diagonals of voxels
  double spacing() const { return h_; }  ///< edge of a voxel [length]

  /// \param p     on the surface
  /// \param face  of the mesh, that p is on; number of faces + i for the mesh's point i that is on none
  GridPlace place(const Vec3& p, std::uint32_t face) const;
  /// A face for each point of the mesh, as place() asks for it.
  std::vector<std::uint32_t> faces_of_points(const PolygonMesh& mesh) const;

  /// Gaps between limbs that nearly touch, closed off by a grid too coarse for them, are no part of the
  /// body: all that is closed off and lies on the other side of the faces than what the curves run in.
  void empty_pockets(std::span<const BSpline* const> curves);

  /// Where the curve runs outside of the body, as in a tube whose ends are open, the largest balls about
  /// its points that no surface meets are added to the body.
  void fill_about(const BSpline& curve);

  /// Lengths of the shortest ways through the body, along edges and diagonals of voxels (up to 1.08 times
  /// the straight way), from the curve to each node; infinity where there is none. From a piece to another
  /// in the same voxel that it is not joined to, a way counts 20 voxels more. Dijkstra's algorithm,
  /// O(voxels of the body).
  std::vector<float> ways_from(const BSpline& curve) const;

 private:
  enum : std::uint8_t { kInside, kSurface, kOutside, kFilled };
  using Cell = std::array<int, 3>;
  struct Entry {  ///< a triangle in a voxel
    std::uint32_t cell, face, triangle, piece;
  };

  struct
      Lot {  ///< of voxels inside: which side of the faces it is on, faces beside it, samples of curves in it
    double side = 0.0, faces = 0.0;
    std::size_t samples = 0;
  };
  Lot look_at_lot(std::uint32_t cell, std::uint32_t number, std::vector<std::uint32_t>& lot) const;

  Vec3 scaled(const Vec3& p) const { return (p - origin_) / h_; }
  std::uint32_t index(const Cell& c) const {
    return static_cast<std::uint32_t>((c[2] * count_[1] + c[1]) * count_[0] + c[0]);
  }
  Cell cell_at(std::uint32_t index) const;
  bool holds(const Cell& c) const;
  Cell cell_of(const Vec3& p) const;  ///< clamped to the grid
  void rasterise(const std::array<Vec3, 3>& triangle, const Cell& low, const Cell& high, const Entry& entry);
  void enter_faces(const PolygonMesh& mesh);
  void sort_entries();
  const Entry* entry_in(std::uint32_t face, std::uint32_t cell) const;
  const Entry* nearest_entry(std::uint32_t face, const Vec3& scaled) const;
  void split_into_pieces(const PolygonMesh& mesh);
  void find_centres(const PolygonMesh& mesh);
  void join_pieces();
  void flood_outside();
  void number_nodes();
  Cell nearest_surface(const Vec3& scaled) const;
  void fill_ball(const Cell& centre);
  std::vector<Vec3> samples(const BSpline& curve) const;
  std::uint32_t piece_before(std::uint32_t cell, const Vec3& scaled) const;
  template <class Step>
  void around(std::uint32_t cell, const Step& step) const;
  template <class Enter>
  void leave_voxel(std::uint32_t cell, float length, const Enter& enter) const;
  template <class Enter>
  void leave_piece(std::uint32_t piece, float length, const Enter& enter) const;

  double h_ = 1.0, outward_ = 1.0;  ///< -1 for faces that look inward
  Vec3 origin_;
  Cell count_;
  std::vector<std::uint8_t> state_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;  ///< corners, points at one place as one
  std::vector<Entry> entries_;                           ///< by face, then triangle
  std::vector<std::uint32_t> first_entry_;               ///< of each face
  std::vector<std::uint32_t> by_voxel_;                  ///< entries, by face, then voxel
  std::vector<std::uint32_t> piece_cell_;                ///< of each piece, ascending
  std::vector<std::uint32_t> first_piece_;               ///< of each voxel
  std::vector<Vec3> piece_centre_, piece_normal_;        ///< scaled; unit
  std::vector<double> piece_area_;
  std::vector<std::array<std::uint32_t, 2>> joined_;  ///< pieces in neighbouring voxels that share a triangle
  std::vector<std::array<std::uint32_t, 8>> piece_nodes_;
  std::vector<Vec3> nodes_;
  Neighbours neighbours_, joins_;
};

}  // namespace tendril::bind
