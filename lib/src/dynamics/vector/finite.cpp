#include "finite.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "base/vector_loops.h"

namespace tendril {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();

// An or of integers, for a loop over truth values is no vector code.
TENDRIL_LANES bool finite(const double* values, std::size_t count) {
  std::int64_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) bad |= std::fabs(values[i]) <= kLargest ? 0 : 1;
  return bad == 0;
}

}  // namespace

bool all_finite(const Eigen::VectorXd& values) {
  return finite(values.data(), static_cast<std::size_t>(values.size()));
}

}  // namespace tendril
