#include <tendril/base/types.h>

#include <algorithm>

namespace tendril {

bool all_finite(Points points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return is_finite(p); });
}

}  // namespace tendril
