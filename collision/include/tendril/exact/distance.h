#pragma once

#include <tendril/base/export.h>
#include <tendril/exact/shape.h>

namespace tendril::exact {

/// The distance of two closed sets, between bounds that are proven and not estimated: above by a point of
/// each, below by a plane that parts them, both with the roundings counted.
struct Distance {
  /// free with lower > 0; touching or hit, as relation() says, with lower = upper = 0; undecidable with 0 and
  /// infinity.
  Answer answer;
  /// [length] lower <= distance <= upper. Of points, segments and triangles upper - lower <= 2^-40 upper,
  /// however near they are; of balls and capsules it is as little of the distance of their centres or axes,
  /// whatever the radii leave. Beyond 2^-960 to 2^1020 the bounds hold, but may be wider.
  double lower = 0.0;
  double upper = 0.0;  ///< [length] as above
  /// Points of the two sets about that near to each other, rounded; where they are free, and for balls and
  /// capsules on their centres or axes.
  Vec3 on_a;
  Vec3 on_b;  ///< as above
};

/// Doubles first (most pairs: below a microsecond), numbers of any length where these leave a wider gap.
TENDRIL_EXACT_API Distance distance(const Shape& a, const Shape& b);

}  // namespace tendril::exact
