#include "flat_run.h"

#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/stability.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tendril::gallery {
namespace {

constexpr long kGuardInterval = 128, kGuardCost = 32;
constexpr double kAmplification = 1e-6, kWholeAmplification = 5e-3;
constexpr double kSafety = 0.93, kShrink = 0.2, kGrow = 5.0;

using Columns = std::vector<Vec3>;

const double* numbers(const Columns& columns) {
  return columns.data()->data();
}

/// out = y + h sum_j weights[j] k[j], in one pass over plain numbers.
template <std::size_t... J>
void combine(std::index_sequence<J...>, const double* weights, const Columns& y, double h,
             const std::array<Columns, 6>& k, Columns& out) {
  const double* __restrict from = numbers(y);
  const std::array<const double*, sizeof...(J)> slopes{numbers(k[J])...};
  const std::array<double, sizeof...(J)> w{h * weights[J]...};
  double* __restrict to = out.data()->data();
  for (std::size_t i = 0; i < 3 * y.size(); ++i) to[i] = from[i] + ((w[J] * slopes[J][i]) + ...);
}

/// Largest |h sum_j (c_j - c*_j) k_j| of the entries from `first` on to `end`; infinite where one is no
/// number.
double largest_error(double h, const std::array<Columns, 6>& k, std::size_t first, std::size_t end) {
  std::array<double, 6> w;
  for (std::size_t s = 0; s < 6; ++s) w[s] = h * (CashKarpTableau::c[s] - CashKarpTableau::c_star[s]);
  std::array<const double*, 6> at;
  for (std::size_t s = 0; s < 6; ++s) at[s] = numbers(k[s]);
  double largest = 0.0;
  for (std::size_t i = 3 * first; i < 3 * end; ++i) {
    const double error =
        std::abs(w[0] * at[0][i] + w[2] * at[2][i] + w[3] * at[3][i] + w[4] * at[4][i] + w[5] * at[5][i]);
    if (!(error <= largest)) largest = std::isfinite(error) ? error : HUGE_VAL;
  }
  return largest;
}

}  // namespace

NetState at_rest(const SpringNet& net) {
  return {0.0, net.rest, std::vector<Vec3>(net.rest.size(), Vec3::Zero())};
}

FlatRun::FlatRun(const SpringNet& net, NetState start, const NetOptions& options)
    : net_(net), state_(std::move(start)), options_(options), step_(options.duration / 100) {
  y_ = state_.p;
  y_.insert(y_.end(), state_.v.begin(), state_.v.end());
  next_ = stage_ = y_;
  for (Columns& k : k_) k = y_;
  see_speed();
  rates(state_.time, y_, k_[0]);
  for (std::size_t i = 0; i < net.mass.size(); ++i)
    speed_ = std::max(speed_, std::sqrt(k_[0][net.mass.size() + i].norm() * options.size));
  if (speed_ == 0.0) speed_ = options.size / options.duration;
  measure_guard();
}

void FlatRun::see_speed() {
  const std::size_t n = net_.mass.size();
  for (std::size_t i = 0; i < n; ++i) speed_ = std::max(speed_, y_[n + i].norm());
}

void FlatRun::rates(double time, const Columns& y, Columns& dy) {
  ++report_.evaluations;
  const std::size_t n = net_.mass.size();
  const std::span<const Vec3> p(y.data(), n), v(y.data() + n, n);
  const std::span<Vec3> dp(dy.data(), n), dv(dy.data() + n, n);
  std::fill(dv.begin(), dv.end(), Vec3::Zero());
  add_forces(net_, p, dv);
  const Vec3 a = net_.acceleration ? net_.acceleration(time) : Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    dp[i] = v[i];
    dv[i] = dv[i] / net_.mass[i] + a - net_.damping * v[i];
  }
  for (const std::uint32_t i : net_.held) {
    dp[i] = net_.driven ? net_.driven(i, time) : Vec3::Zero();
    dv[i].setZero();
  }
}

template <std::size_t S>
void FlatRun::stage(double h) {
  combine(std::make_index_sequence<S>(), CashKarpTableau::b[S].data(), y_, h, k_, stage_);
  rates(state_.time + CashKarpTableau::a[S] * h, stage_, k_[S]);
}

/// The solution of order 5 into next_. Its error over the tolerance; infinite where there is no solution.
double FlatRun::try_step(double h) {
  if (!std::exchange(first_known_, true)) rates(state_.time, y_, k_[0]);
  stage<1>(h), stage<2>(h), stage<3>(h), stage<4>(h), stage<5>(h);
  combine(std::make_index_sequence<6>(), CashKarpTableau::c.data(), y_, h, k_, next_);
  const std::size_t n = net_.mass.size();
  const double by_place = largest_error(h, k_, 0, n) / options_.size;
  const double by_speed = largest_error(h, k_, n, 2 * n) / speed_;
  return std::max(by_place, by_speed) / options_.tolerance;
}

void FlatRun::measure_guard() {
  const std::span<const Vec3> p(y_.data(), net_.mass.size());
  cap_ = guard_step(largest_frequency(net_, p), net_.damping, 0.0,
                    {kAmplification, kWholeAmplification, options_.duration});
  report_.evaluations += kGuardCost;
  since_guard_ = 0;
}

const NetReport& FlatRun::run(double until) {
  while (state_.time < until) {
    if (since_guard_ >= kGuardInterval) measure_guard();
    const double left = until - state_.time;
    double h = std::min(step_, cap_);
    const bool last = h >= left * (1.0 - 1e-10);
    if (last)
      h = left;
    else if (2.0 * h > left)
      h = 0.5 * left;
    if (!(h > 1e-14 * options_.duration)) return report_.reason = "no step meets the tolerance", report_;
    const double error = try_step(h);
    const bool finite = std::isfinite(error);
    if (!(error <= 1.0)) {
      ++report_.rejected;
      step_ = h * (finite ? std::max(kShrink, kSafety * std::pow(error, -0.25)) : kShrink);
      continue;
    }
    const double factor = error > 0.0 ? std::min(kGrow, kSafety * std::pow(error, -0.2)) : kGrow;
    step_ = h < 0.99 * step_ ? std::max(step_ * std::min(factor, 1.0), h * factor) : h * factor;
    y_.swap(next_);
    state_.time = last ? until : state_.time + h;
    first_known_ = false;
    ++report_.accepted;
    ++since_guard_;
    see_speed();
  }
  const auto n = static_cast<std::ptrdiff_t>(net_.mass.size());
  state_.p.assign(y_.begin(), y_.begin() + n);
  state_.v.assign(y_.begin() + n, y_.end());
  report_.time = state_.time;
  report_.finished = true;
  return report_;
}

}  // namespace tendril::gallery
