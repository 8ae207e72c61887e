#include "pivot_layout.h"

#include "dynamics/vector/pack.h"

namespace tendril {
namespace {

using lanes::load;
using lanes::Pack;
using lanes::store;

/// Three numbers and a fourth. What stands behind the three is read, too: y ends with the work.
TENDRIL_INLINE Pack with_angle(const double* y, Eigen::Index place, const double* angles,
                               Eigen::Index angle) {
  Pack a = load<Pack>(y + place);
  a[3] = angle < 0 ? 0.0 : angles[angle];
  return a;
}

TENDRIL_LANES void put(const PivotLayout& at, double s, const double* r, double* x, double* b) {
  for (std::size_t k = 0; k < at.place.size(); ++k) {
    const Pack rx = with_angle(r, at.place[k], r + at.theta_begin, at.angle[k]);
    const Pack ru = with_angle(r, at.rate[k], r + at.spin_begin, at.angle[k]);
    store<Pack>(rx, x + 4 * k);
    store<Pack>(load<Pack>(&at.mass[4 * k]) * (ru + s * rx) + load<Pack>(&at.damping[4 * k]) * rx, b + 4 * k);
  }
}

TENDRIL_INLINE void put_three(const Pack& a, double* to) {
  for (std::size_t c = 0; c < 3; ++c) to[c] = a[c];
}

TENDRIL_LANES void take(const PivotLayout& at, double s, const double* u, const double* x, double* to) {
  for (std::size_t k = 0; k < at.place.size(); ++k) {
    const Pack solved = load<Pack>(u + 4 * k);
    const Pack rate = s * solved - load<Pack>(x + 4 * k);
    put_three(solved, to + at.place[k]);
    put_three(rate, to + at.rate[k]);
    if (at.angle[k] < 0) continue;
    to[at.theta_begin + at.angle[k]] = solved[3];
    to[at.spin_begin + at.angle[k]] = rate[3];
  }
}

}  // namespace

void put_right(const PivotLayout& at, double s, const Eigen::VectorXd& r, double* x, double* b) {
  put(at, s, r.data(), x, b);
}

void take_solution(const PivotLayout& at, double s, const double* u, const double* x, Eigen::Index size,
                   Eigen::VectorXd& result) {
  result.resize(size);
  result[size - 1] = 0.0;
  take(at, s, u, x, result.data());
}

}  // namespace tendril
