#pragma once

#include <tendril/base/types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tendril {

/// All points within `radius` of a segment. Convex, so it holds a Bezier piece when it holds its control
/// points.
struct Capsule {
  Vec3 start, axis;
  double inverse_length2;  // of the axis; 0 for a point
  double radius;

  /// Distance of p to the capsule, negative inside. Rounding: below 1e-14 (|p - start| + |axis|).
  double distance(const Vec3& p) const { return std::sqrt(square(p)) - radius; }
  /// Of the distance to the segment.
  double square(const Vec3& p) const {
    const Vec3 q = p - start;
    const double s = q.dot(axis) * inverse_length2;
    return (q - std::min(1.0, std::max(0.0, s)) * axis).squaredNorm();
  }
};

/// The capsule about the segment from the first point to the last that holds all.
Capsule around(Points points);

/// Binary tree of capsules over consecutive pieces of a curve, stored depth first: a node's left child
/// follows it.
class CapsuleTree {
 public:
  /// \param points  control points of all pieces in order, `per_piece` each
  CapsuleTree(Points points, std::size_t per_piece);

  /// Of one piece.
  const Capsule& of(std::size_t piece) const { return nodes_[leaves_[piece]].capsule; }

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
      const Entry entry = stack[--top];
      if (entry.distance > bound()) continue;
      std::size_t index = entry.node;
      while (nodes_[index].right != 0) {
        const std::size_t left = index + 1, right = nodes_[index].right;
        const Capsule &a = nodes_[left].capsule, &b = nodes_[right].capsule;
        const double to_a = a.square(p), to_b = b.square(p), most = bound();
        const bool near_a = to_a <= square(most + a.radius), near_b = to_b <= square(most + b.radius);
        index = near_a ? left : right;
        if (near_a && near_b) {
          // Roots only where both must be visited: mostly one is too far.
          const double d_a = std::sqrt(to_a) - a.radius, d_b = std::sqrt(to_b) - b.radius;
          stack[top++] = d_a <= d_b ? Entry{right, d_b} : Entry{left, d_a};
          index = d_a <= d_b ? left : right;
        } else if (!near_a && !near_b) {
          index = nodes_.size();
          break;
        }
      }
      if (index < nodes_.size()) visit(nodes_[index].piece);
    }
  }

 private:
  struct Node {
    Capsule capsule;
    std::size_t right;  // index of the right child; 0 marks a leaf
    std::size_t piece;  // of a leaf
  };
  static double square(double a) { return a * a; }
  void build(Points points, std::size_t per_piece, std::size_t first);

  std::vector<Node> nodes_;
  std::vector<std::size_t> leaves_;
};

}  // namespace tendril
