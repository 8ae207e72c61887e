#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/box_tree.h>
#include <tendril/collision/hierarchy_options.h>
#include <tendril/curve/bound_points.h>

#include <array>

/// What AxialHierarchy stands on: cells of triangles, and the boxes above and within them.
namespace tendril::collision {

struct PlacedTriangle {
  std::uint32_t index;
  std::array<Vec3, 3> corners;  ///< the very doubles of the updated mesh
  Box box;
};

/// Made, posed and asked as AxialHierarchy is; a node's children may be looked at once it is no cell, or
/// opened.
class TENDRIL_COLLISION_API PlacedCells {
 public:
  static constexpr std::size_t kLeaf = 8, kCell = 8;  ///< triangles a leaf, leaves a cell

  /// A box of the tree and the leaves it is about. Binary: whole cells are split by their number, then
  /// leaves.
  struct Node {
    std::size_t box, meta, begin, end;  ///< meta: above cells, counted depth first; kNone within one
    static constexpr std::size_t kNone = ~std::size_t{0};
    std::size_t size() const { return end - begin; }
    bool leaf() const { return size() == 1; }
    bool cell() const { return meta != kNone && size() <= kCell; }
    std::size_t half() const {
      return size() > kCell ? kCell * (((size() + kCell - 1) / kCell) / 2) : size() / 2;
    }
    Node left() const { return {box + 1, size() > kCell ? meta + 1 : kNone, begin, begin + half()}; }
    Node right() const {
      return {box + 2 * half(), size() > kCell ? meta + 2 * (half() / kCell) : kNone, begin + half(), end};
    }
  };

  PlacedCells(std::span<const CurvePair> rest, const BoundPoints& points, std::span<const Triangle> triangles,
              const HierarchyOptions& options);
  PlacedCells(PlacedCells&&) noexcept;
  PlacedCells& operator=(PlacedCells&&) noexcept;
  ~PlacedCells();

  void pose(std::span<const CurvePair> posed);
  void refit();
  const HierarchyWork& work() const;
  std::size_t triangle_count() const { return order_.size(); }

  Node root() const { return {0, 0, 0, (order_.size() + kLeaf - 1) / kLeaf}; }
  /// About all of the node's triangles in this pose.
  const Box& box(const Node& n) { return n.meta == Node::kNone || current(n.meta) ? boxes_[n.box] : make(n); }
  /// Deforms a cell; true when its box is another one now. Nothing on other nodes.
  bool open(const Node& n) { return n.cell() && enter(n); }

  /// Calls visit for the triangles of an opened leaf.
  template <class Visit>
  void triangles(const Node& leaf, Visit&& visit) const {
    const std::size_t begin = leaf.begin * kLeaf, end = std::min(begin + kLeaf, order_.size());
    const Vec3* at = placed_.data() + first_[leaf.begin / kCell];
    for (std::size_t i = begin; i < end; ++i) {
      PlacedTriangle t{order_[i], {at[corner_[i][0]], at[corner_[i][1]], at[corner_[i][2]]}, {}};
      t.box = {t.corners[0].cwiseMin(t.corners[1]).cwiseMin(t.corners[2]),
               t.corners[0].cwiseMax(t.corners[1]).cwiseMax(t.corners[2])};
      visit(t);
    }
  }

 private:
  struct Lazy;
  bool current(std::size_t meta) const { return made_[meta] == frame_; }
  const Box& make(const Node& n);
  bool enter(const Node& n);
  void place(const Node& n);
  void fit(const Node& n);
  void refit(const Node& n);

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> made_;                  ///< frame of each box above cells
  std::vector<std::uint32_t> order_;                 ///< triangles, cell by cell
  std::vector<std::array<std::uint8_t, 3>> corner_;  ///< among the points of the cell
  std::vector<std::uint32_t> first_;                 ///< of each cell, among placed_
  std::vector<Vec3> placed_;
  std::uint32_t frame_ = 0;
  std::unique_ptr<Lazy> lazy_;
};

}  // namespace tendril::collision
