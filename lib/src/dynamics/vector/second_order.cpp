#include "second_order.h"

#include "finite.h"
#include "lanes.h"

namespace tendril {
namespace {

/// Accelerations and their weights.
template <std::size_t N>
struct Accelerations {
  Accelerations(const SecondOrder& sum, std::size_t n) {
    for (std::size_t j = 0; j < N; ++j) {
      k[j] = sum.k[j]->data() + n;
      place[j] = sum.place[j];
      rate[j] = sum.rate[j];
    }
  }
  std::array<const double*, N> k;
  std::array<double, N> place, rate;
};

template <std::size_t N>
TENDRIL_INLINE void move_on(std::size_t n, const double* __restrict y, const double* __restrict first,
                            const SecondOrder& sum, double* __restrict to) {
  const auto [k, place, rate] = Accelerations<N>(sum, n);
  const double time = sum.time;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < n; ++i) {
    double x = place[0] * k[0][i], v = rate[0] * k[0][i];
    for (std::size_t j = 1; j < N; ++j) {
      x += place[j] * k[j][i];
      v += rate[j] * k[j][i];
    }
    to[i] = y[i] + (time * first[i] + x);
    to[n + i] = y[n + i] + v;
  }
}

TENDRIL_LANES void move_on(std::size_t n, const double* y, const double* first, const SecondOrder& sum,
                           double* to) {
  switch (sum.count) {
    case 1:
      return move_on<1>(n, y, first, sum, to);
    case 2:
      return move_on<2>(n, y, first, sum, to);
    default:
      return move_on<3>(n, y, first, sum, to);
  }
}

TENDRIL_LANES bool move_both(std::size_t n, const double* __restrict y, const double* __restrict first,
                             const SecondOrder& sum, const SecondOrder& off, double* __restrict to,
                             double* __restrict error) {
  const auto [k, place, rate] = Accelerations<4>(sum, n);
  const auto [same, place_off, rate_off] = Accelerations<4>(off, n);
  const double time = sum.time;
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < n; ++i) {
    double x = 0.0, v = 0.0, dx = 0.0, dv = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
      const double a = k[j][i];
      x += place[j] * a;
      v += rate[j] * a;
      dx += place_off[j] * a;
      dv += rate_off[j] * a;
    }
    const double at = y[i] + (time * first[i] + x), then = y[n + i] + v;
    to[i] = at;
    to[n + i] = then;
    error[i] = dx;
    error[n + i] = dv;
    bad |= no_number(at) | no_number(then) | no_number(dx) | no_number(dv);
  }
  return bad == 0;
}

}  // namespace

void second_order(const Eigen::VectorXd& y, const Eigen::VectorXd& first, const SecondOrder& sum,
                  Eigen::Index n, Eigen::VectorXd& to) {
  move_on(static_cast<std::size_t>(n), y.data(), first.data(), sum, to.data());
}

bool second_order_both(const Eigen::VectorXd& y, const Eigen::VectorXd& first, const SecondOrder& sum,
                       const SecondOrder& off, Eigen::Index n, Eigen::VectorXd& to, Eigen::VectorXd& error) {
  return move_both(static_cast<std::size_t>(n), y.data(), first.data(), sum, off, to.data(), error.data());
}

}  // namespace tendril
