#pragma once

#include <Eigen/Core>

namespace tendril {

/// Whether no number is infinite or NaN.
bool all_finite(const Eigen::VectorXd& values);

}  // namespace tendril
