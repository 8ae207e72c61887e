#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/hierarchy_options.h>
#include <tendril/collision/placed_triangle.h>
#include <tendril/curve/bound_points.h>

/// What AxialHierarchy stands on: cells of triangles, and the boxes above and within them.
namespace tendril::collision {

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
  std::size_t triangle_count() const { return items_.size(); }  ///< in all

  /// The node of all triangles.
  Node root() const { return {0, 0, 0, (items_.size() + kLeaf - 1) / kLeaf}; }
  /// About all of the node's triangles in this pose.
  const Box& box(const Node& n) {
    if (n.meta == Node::kNone) return boxes_[n.box];
    return kept_[n.meta].made == frame_ ? kept_[n.meta].box : make(n);
  }
  /// Deforms a cell; true when its box is another one now. Nothing on other nodes.
  bool open(const Node& n) { return n.cell() && enter(n); }

  /// Calls visit for the triangles of an opened leaf.
  template <class Visit>
  void triangles(const Node& leaf, Visit&& visit) const {
    const std::size_t begin = leaf.begin * kLeaf, end = std::min(begin + kLeaf, items_.size());
    const Vec3* at = placed_.data() + cells_[leaf.begin / kCell].first;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = items_[i].corner;
      PlacedTriangle t{items_[i].triangle, {at[a], at[b], at[c]}, {}};
      t.box = {t.corners[0].cwiseMin(t.corners[1]).cwiseMin(t.corners[2]),
               t.corners[0].cwiseMax(t.corners[1]).cwiseMax(t.corners[2])};
      visit(t);
    }
  }

 private:
  struct Lazy;
  /// Of a node above cells, or a cell: what a query comes for first lies together.
  struct alignas(64) Kept {
    Box box;
    std::uint32_t made = 0;                      ///< frame of the box
    std::uint32_t more_begin = 0, more_end = 0;  ///< its patches besides the first, see Lazy
  };
  struct Cell {
    std::uint32_t first;                    ///< of its points, which end where the next cell's begin
    std::uint32_t placed = 0, touched = 0;  ///< frames in which it was last
  };
  struct Item {
    std::uint32_t triangle;
    std::array<std::uint8_t, 3> corner;  ///< among the points of the cell
  };
  Box& kept_box(const Node& n) { return n.meta == Node::kNone ? boxes_[n.box] : kept_[n.meta].box; }
  const Box& make(const Node& n);
  bool enter(const Node& n);
  void place(const Node& n);
  void fit(const Node& n);
  void refit(const Node& n);

  std::vector<Kept> kept_;   ///< by Node::meta
  std::vector<Box> boxes_;   ///< within cells, by Node::box
  std::vector<Item> items_;  ///< cell by cell
  std::vector<Cell> cells_;  ///< and one behind the last
  std::vector<Vec3> placed_;
  std::uint32_t frame_ = 0;
  std::unique_ptr<Lazy> lazy_;
};

}  // namespace tendril::collision
