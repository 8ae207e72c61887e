#include "target.h"

#include <algorithm>
#include <cmath>

namespace tendril {

double Aim::seen(double now) const {
  return at_break ? std::nextafter(time, now) - now : h;
}

Breaks::Breaks(const Scene& scene) {
  for (const auto& force : scene.forces)
    for (const double time : force->breaks()) times_.push_back(time);
  std::sort(times_.begin(), times_.end());
}

Stretch Breaks::from(double now, double target) const {
  const auto next = std::upper_bound(times_.begin(), times_.end(), now);
  if (next != times_.end() && *next <= target) return {*next, true};
  return {target, false};
}

}  // namespace tendril
