#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

/// A hierarchy of axis-aligned boxes over items (triangles, vertices with their way, cells). It only leaves
/// out what cannot meet: who visits decides. Comparisons of doubles alone, so nothing is lost to rounding.
namespace tendril::collision {

/// Closed: all x with low <= x <= high in each coordinate.
struct Box {
  Vec3 low;   ///< least coordinates
  Vec3 high;  ///< largest coordinates

  /// A common point, one of the boundaries included.
  bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  /// x lies inside or on the boundary.
  bool holds(const Vec3& x) const { return (low.array() <= x.array() && x.array() <= high.array()).all(); }
};

/// The smallest box about at least one point.
TENDRIL_COLLISION_API Box box_of(Points points);
/// The smallest box about two.
TENDRIL_COLLISION_API Box join(const Box& a, const Box& b);

/// Binary, balanced, one item a leaf; split at the median of the items' middles along the axis of the largest
/// spread. The same items give the same tree. 2 n - 1 boxes, stored depth first: the left child follows its
/// parent, the right one follows the left one's subtree.
class TENDRIL_COLLISION_API BoxTree {
 public:
  /// Of no items.
  BoxTree() = default;
  /// O(n log n). Throws InvalidInput for a box that is not finite or has low > high.
  explicit BoxTree(std::span<const Box> items);

  /// The same items elsewhere, in the old order of the tree: O(n), no allocation. Throws InvalidInput for
  /// another number of items or as above; then the tree is as it was.
  void refit(std::span<const Box> items);

  std::size_t size() const { return order_.size(); }  ///< number of items
  /// Of all items; only where size() > 0.
  const Box& box() const { return boxes_[0]; }

  /// Calls visit(item) for the items of which enter(box) holds, and held for every box above. O(log n +
  /// found).
  template <class Enter, class Visit>
  void descend(Enter&& enter, Visit&& visit) const {
    if (size() > 0) descend({0, 0, size()}, enter, visit);
  }

  /// Calls visit(item, other's item) for all pairs whose boxes meet.
  template <class Visit>
  void pairs(const BoxTree& other, Visit&& visit) const {
    if (size() > 0 && other.size() > 0) pairs({0, 0, size()}, other, {0, 0, other.size()}, visit);
  }

  /// As descend, the child with the smaller distance(box) first, and only while that is not more than
  /// bound(), which may shrink as items are visited.
  template <class Distance, class Bound, class Visit>
  void nearest(Distance&& distance, Bound&& bound, Visit&& visit) const {
    if (size() > 0) nearest({0, 0, size()}, distance, bound, visit);
  }

 private:
  /// A box and the places in order_ it is about.
  struct Node {
    std::size_t box, begin, end;
    std::size_t count() const { return end - begin; }
    Node left() const { return {box + 1, begin, begin + count() / 2}; }
    Node right() const { return {box + 2 * (count() / 2), begin + count() / 2, end}; }
  };
  void order(Node node, std::span<const Box> items);
  void fill(Node node, std::span<const Box> items);

  template <class Enter, class Visit>
  void descend(Node n, Enter& enter, Visit& visit) const {
    if (!enter(boxes_[n.box])) return;
    if (n.count() == 1) return visit(std::size_t{order_[n.begin]});
    descend(n.left(), enter, visit);
    descend(n.right(), enter, visit);
  }
  template <class Visit>
  void pairs(Node a, const BoxTree& other, Node b, Visit& visit) const {
    if (!boxes_[a.box].meets(other.boxes_[b.box])) return;
    if (a.count() == 1 && b.count() == 1)
      return visit(std::size_t{order_[a.begin]}, std::size_t{other.order_[b.begin]});
    const bool first = a.count() >= b.count();
    pairs(first ? a.left() : a, other, first ? b : b.left(), visit);
    pairs(first ? a.right() : a, other, first ? b : b.right(), visit);
  }
  template <class Distance, class Bound, class Visit>
  void nearest(Node n, Distance& distance, Bound& bound, Visit& visit) const {
    if (!(distance(boxes_[n.box]) <= bound())) return;
    if (n.count() == 1) return visit(std::size_t{order_[n.begin]});
    const bool swap = distance(boxes_[n.right().box]) < distance(boxes_[n.left().box]);
    nearest(swap ? n.right() : n.left(), distance, bound, visit);
    nearest(swap ? n.left() : n.right(), distance, bound, visit);
  }

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace tendril::collision
