#pragma once

#include <cstddef>
#include <vector>

#include "curve/distance/capsule_tree.h"
#include "projection_lanes.h"

/// Which pieces a group of points must examine: bounds in vector lanes, over the points or over the pieces.
namespace tendril::search {

/// A piece that may be the nearest, and its capsule on plain numbers.
struct NearPiece {
  std::size_t piece;
  V3 start, axis;
  double inverse_length2, radius;
};

/// The points of a group, and which of the pieces met has the nearest segment.
struct alignas(64) GroupLanes {
  Lanes x, y, z, cut;
  Lanes square, radius, nearest;
};

/// Squared distance of every point to the segment of a piece.
/// \param number  of the piece among those met
void measure_piece(GroupLanes& group, const NearPiece& piece, double number, double* square);

/// Marks the points that the capsule is not too far from.
void mark_near(const GroupLanes& group, double radius, const double* square, unsigned char* near);

/// Balls around pieces, and what is found out about them.
struct Balls {
  std::vector<double> x, y, z, radius;
  std::vector<double> distance;       ///< of the centre
  std::vector<unsigned char> beyond;  ///< too far away to count

  std::size_t size() const { return x.size(); }
  void clear() {
    for (auto* row : {&x, &y, &z, &radius}) row->clear();
  }
  void add(const Capsule& capsule) {
    const Vec3 centre = capsule.start + 0.5 * capsule.axis;
    x.push_back(centre.x());
    y.push_back(centre.y());
    z.push_back(centre.z());
    radius.push_back(0.5 * capsule.axis.norm() + capsule.radius);
  }
};

/// Distances of the balls' centres to c.
void measure_balls(Balls& balls, const V3& c);

/// A box, and a ball that may hold the nearest point to any of its points.
struct Reference {
  V3 half, centre;        ///< half the box's sides; the ball's centre
  double distance;        ///< from the box's centre to the ball's
  double margin, across;  ///< the ball's radius and a slack; the box's diagonal
};

/// Marks the balls that are farther than the reference from every point p of the box. With d, d0 the
/// distances of p to the centres, d^2 - d0^2 is linear in p, so its minimum m over the box is known; where it
/// is positive, d - d0 >= m / max(d + d0).
void mark_beyond(Balls& balls, const Reference& to);

}  // namespace tendril::search
