#include <tendril/scene/output_times.h>

#include <algorithm>
#include <cmath>

namespace tendril::scene {

std::vector<double> output_times(double duration, std::size_t frames) {
  std::vector<double> out;
  const auto last = static_cast<double>(frames - 1);
  // duration k / last rounds twice: at k = last, that may come out above the duration.
  for (std::size_t k = 0; k + 1 < frames; ++k) {
    const double product = duration * static_cast<double>(k);
    out.push_back(std::isfinite(product) ? product / last : duration * (static_cast<double>(k) / last));
  }
  out.push_back(duration);
  return out;
}

std::vector<double> output_times_every(double duration, double step) {
  constexpr double kRounding = 1e-12;
  const auto count = static_cast<std::size_t>(std::floor(duration / step * (1.0 + kRounding)));
  std::vector<double> out;
  for (std::size_t k = 0; k <= count; ++k) out.push_back(std::min(static_cast<double>(k) * step, duration));
  if (count > 0 && duration - out.back() <= kRounding * duration) out.back() = duration;
  return out;
}

}  // namespace tendril::scene
