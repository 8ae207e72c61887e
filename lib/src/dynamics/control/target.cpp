#include "target.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tendril {

double Aim::seen(double now) const {
  return at_break ? std::nextafter(time, now) - now : h;
}

Breaks::Breaks(const Scene& scene) {
  for (const auto& force : scene.forces)
    for (const double time : force->breaks()) times_.push_back(time);
  for (const Anchor& anchor : scene.anchors)
    times_.insert(times_.end(), anchor.breaks.begin(), anchor.breaks.end());
  std::sort(times_.begin(), times_.end());
}

Stretch Breaks::from(double now, double target) const {
  const auto next = std::upper_bound(times_.begin(), times_.end(), now);
  if (next != times_.end() && *next <= target) return {*next, true};
  return {target, false};
}

double shortest_period(const Scene& scene) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& force : scene.forces) shortest = std::min(shortest, force->period());
  for (const Anchor& anchor : scene.anchors) shortest = std::min(shortest, anchor.period);
  return shortest;
}

}  // namespace tendril
