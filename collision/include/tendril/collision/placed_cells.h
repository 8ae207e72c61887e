#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/box_tree.h>
#include <tendril/collision/hierarchy_options.h>
#include <tendril/curve/bound_points.h>

#include <array>

/// What AxialHierarchy stands on: cells of triangles, and the boxes above and within them.
namespace tendril::collision {

/// A triangle as a query sees it.
struct PlacedTriangle {
  std::uint32_t index;          ///< among the triangles given
  std::array<Vec3, 3> corners;  ///< the very doubles of the updated mesh
  Box box;                      ///< of the corners, exact
};

/// Made, posed and asked as AxialHierarchy is; a node's children may be looked at once it is no cell, or
/// opened.
class TENDRIL_COLLISION_API PlacedCells {
 public:
  static constexpr std::size_t kLeaf = 8;  ///< triangles a leaf
  static constexpr std::size_t kCell = 8;  ///< leaves a cell

  /// A box of the tree and the leaves it is about. Binary: whole cells are split by their number, then
  /// leaves.
  struct Node {
    std::size_t box;    ///< its index
    std::size_t meta;   ///< index among the nodes above cells, counted depth first; kNone within a cell
    std::size_t begin;  ///< first leaf
    std::size_t end;    ///< behind the last leaf
    static constexpr std::size_t kNone = ~std::size_t{0};           ///< no index
    std::size_t size() const { return end - begin; }                ///< in leaves
    bool leaf() const { return size() == 1; }                       ///< holds triangles
    bool cell() const { return meta != kNone && size() <= kCell; }  ///< is deformed as a whole
    /// Leaves of the left child.
    std::size_t half() const {
      return size() > kCell ? kCell * (((size() + kCell - 1) / kCell) / 2) : size() / 2;
    }
    /// First child.
    Node left() const { return {box + 1, size() > kCell ? meta + 1 : kNone, begin, begin + half()}; }
    /// Second child.
    Node right() const {
      return {box + 2 * half(), size() > kCell ? meta + 2 * (half() / kCell) : kNone, begin + half(), end};
    }
  };

  /// As AxialHierarchy.
  PlacedCells(std::span<const CurvePair> rest, const BoundPoints& points, std::span<const Triangle> triangles,
              const HierarchyOptions& options);
  PlacedCells(PlacedCells&&) noexcept;             ///< leaves an object to be destroyed or assigned to
  PlacedCells& operator=(PlacedCells&&) noexcept;  ///< the same
  ~PlacedCells();

  void pose(std::span<const CurvePair> posed);                  ///< as AxialHierarchy::pose
  void refit();                                                 ///< as AxialHierarchy::refit
  HierarchyWork work() const;                                   ///< since the last pose
  std::size_t triangle_count() const { return order_.size(); }  ///< in all

  /// The node of all triangles.
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
