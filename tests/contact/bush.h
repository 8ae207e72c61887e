#pragma once

#include <tendril/collision/box_tree.h>
#include <tendril/exact/shape.h>

#include "leaf.h"

namespace tendril::test {

/// Leaves about a stem, each clamped at its foot and bound to a rod of its own, none nearer to another than
/// `apart` at the start, which has to be more than points of a leaf are from each other.
class Bush {
 public:
  Sheets sheets;
  std::size_t points_each = 0;

  /// \param stiffer  times as stiff as a plant's
  Bush(Random& random, std::size_t leaves, std::uint32_t along, std::uint32_t across, double apart,
       double stiffer = 1.0)
      : apart_(apart), one_(leaf(kLength, kHalf, along, across)) {
    const std::vector<Vec3> p = straight(4, kLength);
    Rod rod = make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.01),
                       {stiffer * 5e5, stiffer * 1.7e5, 400.0}, circular_section(0.003));
    for (double& width : rod.width) width = 0.03;
    // Of a blade as wide as that, not of the thin rod.
    for (std::size_t i = 0; i < rod.mass.size(); ++i) rod.inertia[i] = rod.mass[i] * 0.03 * 0.03 / 12.0;
    points_each = one_.points.size();
    // Up a spiral as plants have it; where one finds no room it goes higher.
    for (double height = 0.0; sheets.rods.size() < leaves; height += 0.0015) {
      const double round = 2.39996 * static_cast<double>(sheets.rods.size());
      const Placed at{(Eigen::AngleAxisd(round, Vec3::UnitZ()) *
                       Eigen::AngleAxisd(-random.uniform(0.3, 0.9), Vec3::UnitY()) *
                       Eigen::AngleAxisd(random.uniform(-0.4, 0.4), Vec3::UnitX()))
                          .toRotationMatrix(),
                      Vec3(0.02 * std::cos(round), 0.02 * std::sin(round), height)};
      bool free = true;
      for (std::size_t k = 0; k < placed_.size() && free; ++k)
        free = (placed_[k].by - at.by).norm() > 2.3 * kLength ||
               (!meets(at, placed_[k]) && !meets(placed_[k], at));
      if (!free) continue;
      placed_.push_back(at);
      sheets.add(one_, rod, at.by, at.turned);
    }
  }

 private:
  static constexpr double kLength = 0.1, kHalf = 0.02;
  struct Placed {
    Mat3 turned;
    Vec3 by;
  };
  /// A point of the first is near the flat outline of the second.
  bool meets(const Placed& first, const Placed& second) const {
    for (const Vec3& x : one_.points) {
      const Vec3 y = second.turned.transpose() * (first.turned * x + first.by - second.by);
      const double s = std::clamp(y.x() / kLength, 0.0, 1.0);
      const double half = 2 * kHalf * std::sqrt(0.02 + s * (1 - s)) + apart_;
      if (std::abs(y.z()) < apart_ && y.x() > -apart_ && y.x() < kLength + apart_ && std::abs(y.y()) < half)
        return true;
    }
    return false;
  }

  double apart_;
  Leaf one_;
  std::vector<Placed> placed_;
};

/// Pairs of triangles of different parts that meet, exactly.
inline long meeting_pairs(const Bush& bush, std::span<const Vec3> at) {
  std::vector<collision::Box> boxes;
  for (const auto& t : bush.sheets.mesh.triangles) {
    const std::array<Vec3, 3> corners{at[t[0]], at[t[1]], at[t[2]]};
    boxes.push_back(collision::box_of(corners));
  }
  const collision::BoxTree tree(boxes);
  long met = 0;
  tree.pairs(tree, [&](std::size_t a, std::size_t b) {
    const auto &s = bush.sheets.mesh.triangles[a], &t = bush.sheets.mesh.triangles[b];
    if (a >= b || s[0] / bush.points_each == t[0] / bush.points_each) return;
    const exact::Shape first = exact::triangle({at[s[0]], at[s[1]], at[s[2]]});
    met += exact::relation(first, exact::triangle({at[t[0]], at[t[1]], at[t[2]]})).relation !=
           exact::Relation::free;
  });
  return met;
}

}  // namespace tendril::test
