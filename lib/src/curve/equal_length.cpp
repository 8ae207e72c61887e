#include <tendril/curve/equal_length.h>

namespace tendril {

AxialPoint at_equal_length(const ArcLength& rest, const ArcLength& posed, const AxialPoint& record) {
  const double length = rest.length_to(record.t);
  AxialPoint moved = record;
  moved.t = posed.parameter_at(length);
  if (length > posed.total()) moved.w += length - posed.total();
  return moved;
}

}  // namespace tendril
