#pragma once

#include <tendril/collision/box_tree.h>
#include <tendril/collision/hierarchy_options.h>

#include <algorithm>
#include <numeric>
#include <span>

namespace tendril::bench {

/// What one would write without the axial space: a binary tree of boxes over the triangles of the rest, eight
/// a leaf, whose boxes are made anew from all positions, leaves first. Positions are kept by the caller.
class PlainTree {
 public:
  using Box = collision::Box;
  static constexpr std::size_t kLeaf = 8;
  struct Node {
    std::size_t box, begin, end;
    std::size_t size() const { return end - begin; }
    bool leaf() const { return size() == 1; }
    Node left() const { return {box + 1, begin, begin + size() / 2}; }
    Node right() const { return {box + 2 * (size() / 2), begin + size() / 2, end}; }
  };

  PlainTree(Points rest, std::span<const collision::Triangle> triangles) : order_(triangles.size()) {
    std::vector<Vec3> middles;
    for (const auto& t : triangles) middles.emplace_back(rest[t[0]] + rest[t[1]] + rest[t[2]]);
    std::iota(order_.begin(), order_.end(), 0U);
    sort(root(), middles);
    for (const std::uint32_t i : order_) triangles_.push_back(triangles[i]);
    boxes_.resize(2 * root().size() - 1);
    refit(rest);
  }

  void refit(Points at) { refit(root(), at); }

  template <class Enter, class Visit>
  void descend(Points at, const Enter& enter, const Visit& visit) const {
    descend(root(), at, enter, visit);
  }
  template <class Visit>
  void pairs(Points at, const PlainTree& other, Points other_at, const Visit& visit) const {
    pairs(root(), at, other, other.root(), other_at, visit);
  }

 private:
  Node root() const { return {0, 0, (order_.size() + kLeaf - 1) / kLeaf}; }
  std::size_t end_of(const Node& n) const { return std::min(n.end * kLeaf, order_.size()); }

  void sort(const Node& n, const std::vector<Vec3>& middles) {
    if (n.leaf()) return;
    Vec3 low = middles[order_[n.begin * kLeaf]], high = low;
    for (std::size_t i = n.begin * kLeaf; i < end_of(n); ++i) {
      low = low.cwiseMin(middles[order_[i]]);
      high = high.cwiseMax(middles[order_[i]]);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(n.begin * kLeaf), at((n.begin + n.size() / 2) * kLeaf), at(end_of(n)),
                     [&](auto a, auto b) { return middles[a][axis] < middles[b][axis]; });
    sort(n.left(), middles);
    sort(n.right(), middles);
  }

  void refit(const Node& n, Points at) {
    if (!n.leaf()) {
      refit(n.left(), at);
      refit(n.right(), at);
      boxes_[n.box] = join(boxes_[n.left().box], boxes_[n.right().box]);
      return;
    }
    Vec3 low = at[triangles_[n.begin * kLeaf][0]], high = low;
    for (std::size_t i = n.begin * kLeaf; i < end_of(n); ++i)
      for (const std::uint32_t corner : triangles_[i]) {
        low = low.cwiseMin(at[corner]);
        high = high.cwiseMax(at[corner]);
      }
    boxes_[n.box] = {low, high};
  }

  static Box box_of(const collision::Triangle& t, Points at) {
    return {at[t[0]].cwiseMin(at[t[1]]).cwiseMin(at[t[2]]), at[t[0]].cwiseMax(at[t[1]]).cwiseMax(at[t[2]])};
  }

  template <class Enter, class Visit>
  void descend(const Node& n, Points at, const Enter& enter, const Visit& visit) const {
    if (!enter(boxes_[n.box])) return;
    if (!n.leaf()) {
      descend(n.left(), at, enter, visit);
      descend(n.right(), at, enter, visit);
      return;
    }
    for (std::size_t i = n.begin * kLeaf; i < end_of(n); ++i)
      if (enter(box_of(triangles_[i], at))) visit(triangles_[i]);
  }

  template <class Visit>
  void pairs(const Node& a, Points at, const PlainTree& other, const Node& b, Points other_at,
             const Visit& visit) const {
    if (!boxes_[a.box].meets(other.boxes_[b.box])) return;
    if (a.leaf() && b.leaf()) {
      for (std::size_t i = a.begin * kLeaf; i < end_of(a); ++i)
        for (std::size_t j = b.begin * kLeaf; j < other.end_of(b); ++j)
          if (box_of(triangles_[i], at).meets(box_of(other.triangles_[j], other_at)))
            visit(triangles_[i], other.triangles_[j]);
      return;
    }
    const bool first = !a.leaf() && (b.leaf() || a.size() >= b.size());
    pairs(first ? a.left() : a, at, other, first ? b : b.left(), other_at, visit);
    pairs(first ? a.right() : a, at, other, first ? b : b.right(), other_at, visit);
  }

  std::vector<std::uint32_t> order_;
  std::vector<collision::Triangle> triangles_;
  std::vector<Box> boxes_;
};

}  // namespace tendril::bench
