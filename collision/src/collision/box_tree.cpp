#include <tendril/base/error.h>
#include <tendril/collision/box_tree.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace tendril::collision {

namespace {

void check(std::span<const Box> items) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool finite = is_finite(items[i].low) && is_finite(items[i].high);
    if (finite && (items[i].low.array() <= items[i].high.array()).all()) continue;
    throw InvalidInput("BoxTree: items[" + std::to_string(i) + "]",
                       finite ? "a low corner above the high one" : "a corner that is not finite",
                       "finite corners, low <= high in each coordinate");
  }
}

/// Halves first: the sum of two finite numbers may not be one.
double middle(const Box& box, int axis) {
  return 0.5 * box.low[axis] + 0.5 * box.high[axis];
}

}  // namespace

Box box_of(Points points) {
  Box box{points[0], points[0]};
  for (const Vec3& x : points.subspan(1)) box = join(box, {x, x});
  return box;
}

Box join(const Box& a, const Box& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

BoxTree::BoxTree(std::span<const Box> items) {
  check(items);
  order_.resize(items.size());
  std::iota(order_.begin(), order_.end(), 0u);
  if (items.empty()) return;
  boxes_.resize(2 * items.size() - 1);
  order({0, 0, size()}, items);
  fill({0, 0, size()}, items);
}

void BoxTree::refit(std::span<const Box> items) {
  if (items.size() != size())
    throw InvalidInput("BoxTree: items", std::to_string(items.size()), std::to_string(size()) + " as before");
  check(items);
  if (size() > 0) fill({0, 0, size()}, items);
}

void BoxTree::order(Node node, std::span<const Box> items) {
  if (node.count() == 1) return;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  Vec3 low = Vec3::Constant(middle(items[order_[node.begin]], 0)), high = low;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = high[axis] = middle(items[order_[node.begin]], axis);
    for (auto i = at(node.begin); i != at(node.end); ++i) {
      low[axis] = std::min(low[axis], middle(items[*i], axis));
      high[axis] = std::max(high[axis], middle(items[*i], axis));
    }
  }
  int axis = 0;
  (0.5 * high - 0.5 * low).maxCoeff(&axis);
  // Ties by the item's number: the tree is the same for every way a library may select.
  std::nth_element(at(node.begin), at(node.left().end), at(node.end), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(middle(items[a], axis), a) < std::pair(middle(items[b], axis), b);
  });
  order(node.left(), items);
  order(node.right(), items);
}

void BoxTree::fill(Node node, std::span<const Box> items) {
  Box& box = boxes_[node.box];
  if (node.count() == 1) {
    box = items[order_[node.begin]];
    return;
  }
  fill(node.left(), items);
  fill(node.right(), items);
  box = join(boxes_[node.left().box], boxes_[node.right().box]);
}

}  // namespace tendril::collision
