#include "finite.h"

namespace tendril {
namespace {

TENDRIL_LANES bool finite(const double* values, std::size_t count) {
  std::int64_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) bad |= no_number(values[i]);
  return bad == 0;
}

}  // namespace

bool all_finite(const Eigen::VectorXd& values) {
  return finite(values.data(), static_cast<std::size_t>(values.size()));
}

}  // namespace tendril
