#pragma once

#include <tendril/base/types.h>

#include <array>
#include <vector>

namespace tendril {

/// All points within `radius` of a segment. Convex, so it holds a Bezier piece when it holds its control
/// points.
struct Capsule {
  Vec3 start, axis;
  double inverse_length2;  // of the axis; 0 for a point
  double radius;

  /// Distance of p to the capsule, negative inside. Rounding: below 1e-14 (|p - start| + |axis|).
  double distance(const Vec3& p) const {
    const Vec3 q = p - start;
    const double s = q.dot(axis) * inverse_length2;
    return (q - (s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s) * axis).norm() - radius;
  }
};

/// Binary tree of capsules over consecutive pieces of a curve, stored depth first: a node's left child
/// follows it.
class CapsuleTree {
 public:
  /// \param points  control points of all pieces in order, `per_piece` each
  CapsuleTree(Points points, std::size_t per_piece);

  /// Calls visit(piece) for the pieces whose capsule is not farther from p than bound(), nearest branch
  /// first. bound() may shrink as pieces are visited.
  template <class Bound, class Visit>
  void descend(const Vec3& p, Bound&& bound, Visit&& visit) const {
    struct Entry {
      std::size_t node;
      double distance;
    };
    std::array<Entry, 64> stack;  // deeper than any tree of pieces that fits in memory
    std::size_t top = 0;
    stack[top++] = {0, -1.0};
    while (top > 0) {
      auto [index, distance] = stack[--top];
      if (distance > bound()) continue;
      while (nodes_[index].right != 0) {
        const std::size_t left = index + 1, right = nodes_[index].right;
        const double to_left = nodes_[left].capsule.distance(p);
        const double to_right = nodes_[right].capsule.distance(p);
        const bool left_first = to_left <= to_right;
        stack[top++] = left_first ? Entry{right, to_right} : Entry{left, to_left};
        index = left_first ? left : right;
        distance = left_first ? to_left : to_right;
        if (distance > bound()) break;
      }
      if (distance <= bound()) visit(nodes_[index].piece);
    }
  }

 private:
  struct Node {
    Capsule capsule;
    std::size_t right;  // index of the right child; 0 marks a leaf
    std::size_t piece;  // of a leaf
  };
  void build(Points points, std::size_t per_piece, std::size_t first);

  std::vector<Node> nodes_;
};

}  // namespace tendril
