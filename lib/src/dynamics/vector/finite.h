#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <limits>

#include "base/vector_loops.h"

namespace tendril {

/// Whether no number is infinite or NaN.
bool all_finite(const Eigen::VectorXd& values);

/// 0 where a number is finite, else 1: an or of integers, for a loop over truth values is no vector code.
TENDRIL_INLINE std::int64_t no_number(double x) {
  return std::fabs(x) <= std::numeric_limits<double>::max() ? 0 : 1;
}

}  // namespace tendril
