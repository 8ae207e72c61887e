#include <tendril/curve/equal_length.h>

namespace tendril {

// Past the end of a shorter pose the curve goes on along its last tangent, which is the frame's z there: the
// length that is missing becomes w.
AxialPoint at_equal_length(const ArcLength& rest, const ArcLength& posed, const AxialPoint& record) {
  const double length = rest.length_to(record.t);
  AxialPoint moved = record;
  moved.t = posed.parameter_at(length);
  if (length > posed.total()) moved.w += length - posed.total();
  return moved;
}

}  // namespace tendril
