#pragma once

#include <tendril/exact/shape.h>

#include "exact/number.h"

/// The narrow phase for callers that have looked at the numbers' range before.
namespace tendril::exact {

/// Not finite for a negative radius, too.
Range range_of(const Shape& shape);

/// Of finite shapes; `range` is the larger of theirs.
Relation relation(Range range, const Shape& a, const Shape& b);
Relation relation(Range range, const Triangle& a, const Triangle& b);

}  // namespace tendril::exact
