#pragma once

#include <tendril/contact/surface_contact.h>

#include <cstdint>

#include "span_motion.h"

namespace tendril::contact {

/// A triangle of a patch, cut into parts^2, and its points: rows from near corner 0 towards corner 2, the
/// first of parts - 1 points along that side, then of parts, parts - 1, ... 2; behind them those at its
/// corners that no triangle of the patch had before.
struct LaidTriangle {
  std::uint32_t index;                  ///< of the surface's
  std::array<std::uint32_t, 3> corner;  ///< among the vertices of the patch
  std::uint32_t parts;
  std::uint32_t first, end;  ///< of SurfacePoints::points

  std::uint32_t rows() const { return parts; }
  std::uint32_t in_row(std::uint32_t row) const { return row == 0 ? parts - 1 : parts - row + 1; }
};

/// A place on a triangle that is followed.
struct SurfacePoint {
  std::array<double, 3> share;
  double weight;  ///< its share of the area at rest
  double side;    ///< the longest between it and its neighbours at rest
};

/// Triangles that depend on the same spans of curve-pairs, and their vertices.
struct Patch {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> spans;  ///< of SurfacePoints::spans, ascending
  std::vector<LaidTriangle> triangles;
};

/// Throws InvalidInput for a surface that is none.
ContactSurface checked(ContactSurface surface);

/// A surface as points on its triangles, so close that what happens between them is known.
struct SurfacePoints {
  /// Throws InvalidInput where they would be more than 10^7.
  /// \param surface  checked
  /// \param apart    sides of triangles between points may be this long at rest
  SurfacePoints(const ContactSurface& surface, double apart);

  std::vector<UsedSpan> spans;
  std::vector<Patch> patches;
  std::vector<SurfacePoint> points;

 private:
  void fill(const ContactSurface& surface, double apart);
};

/// The point of a triangle.
inline Vec3 mix(const std::array<double, 3>& share, const Vec3& a, const Vec3& b, const Vec3& c) {
  return share[0] * a + share[1] * b + share[2] * c;
}

}  // namespace tendril::contact
