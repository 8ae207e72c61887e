#include <tendril/collision/thesis_cylinder.h>

#include <algorithm>
#include <cmath>

namespace tendril::collision {

ThesisCylinder::ThesisCylinder(std::span<const AxialPoint> vertices, const KnotVector& knots) {
  const auto regions = static_cast<std::size_t>(knots.control_points() - 1);
  const double start = knots.start(), length = knots.end() - start;
  const auto count = static_cast<double>(regions);
  t_.assign(regions + 2, start);
  r_.assign(regions + 2, 0.0);
  std::vector<bool> empty(regions, true);
  for (const AxialPoint& at : vertices) {
    const double part = std::clamp((at.t - start) / length * count, 0.0, count - 1.0);
    const auto region = static_cast<std::size_t>(part);
    const double r = std::hypot(at.u, at.v);
    if (!empty[region] && r <= r_[region + 1]) continue;
    empty[region] = false;
    t_[region + 1] = at.t;
    r_[region + 1] = r;
  }
  for (std::size_t i = 0; i < regions; ++i)
    if (empty[i]) {
      t_[i + 1] = start + length * (static_cast<double>(i) + 0.5) / count;
      r_[i + 1] = r_[i];
    }
  t_.back() = knots.end();
}

double ThesisCylinder::radius(double t) const {
  const auto after = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  const auto j = static_cast<std::size_t>(after - t_.begin()), i = j - 1;
  if (!(t_[j] > t_[i])) return r_[j];
  return (t - t_[i]) / (t_[j] - t_[i]) * (r_[j] - r_[i]) + r_[i];
}

bool ThesisCylinder::holds(const AxialPoint& e) const {
  return t_.front() < e.t && e.t < t_.back() && std::hypot(e.u, e.v) < radius(e.t);
}

}  // namespace tendril::collision
