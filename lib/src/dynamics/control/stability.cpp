#include <tendril/dynamics/nystrom.h>
#include <tendril/dynamics/stability.h>
#include <tendril/dynamics/stepper.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril {
namespace {

constexpr double kUncertain = 1.08;  // of a largest frequency

/// |R(re + i im)|, by Horner's rule on pairs of real numbers.
double amplification(double re, double im) {
  constexpr double kCoefficients[] = {1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0};
  double x = 1.0 / 800;
  double y = 0.0;
  for (const double c : kCoefficients) {
    const double real = x * re - y * im + c;
    y = x * im + y * re;
    x = real;
  }
  return std::sqrt(x * x + y * y);
}

}  // namespace

/// Of the oscillator's worse root.
double cash_karp_growth(double w, double alpha, double beta, double h) {
  const double half = 0.5 * (alpha + beta * w * w);
  const double discriminant = half * half - w * w;
  if (discriminant < 0.0) return amplification(-h * half, h * std::sqrt(-discriminant)) - 1.0;
  // The larger root first; the other from the product w^2, without cancellation.
  const double fast = -half - std::sqrt(discriminant);
  const double slow = fast == 0.0 ? 0.0 : w * w / fast;
  return std::max(amplification(h * fast, 0.0), amplification(h * slow, 0.0)) - 1.0;
}

/// Of x'' = -w^2 x - d x' a step takes (x, h x') to M (x, h x'): a motion is multiplied by its eigenvalues.
double nystrom_growth(double w, double alpha, double beta, double h) {
  using T = NystromTableau;
  constexpr std::size_t kStages = T::c.size();
  w *= kUncertain;
  const double square = h * w * h * w, damping = h * (alpha + beta * w * w);
  double m[2][2];
  for (int from = 0; from < 2; ++from) {
    const double x = from == 0 ? 1.0 : 0.0, v = 1.0 - x;
    double f[kStages];
    double x_end = x + v, v_end = v;
    for (std::size_t i = 0; i < kStages; ++i) {
      double at = x + T::c[i] * v, rate = v;
      for (std::size_t j = 0; j < i; ++j) {
        at += T::place[i][j] * f[j];
        rate += T::rate[i][j] * f[j];
      }
      f[i] = -square * at - damping * rate;
      x_end += T::b[i] * (1.0 - T::c[i]) * f[i];
      v_end += T::b[i] * f[i];
    }
    m[0][from] = x_end;
    m[1][from] = v_end;
  }
  const double half = 0.5 * (m[0][0] + m[1][1]), det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const double discriminant = half * half - det;
  if (discriminant < 0.0) return std::sqrt(det) - 1.0;
  return std::abs(half) + std::sqrt(discriminant) - 1.0;
}

namespace {

using Growth = std::function<double(double, double, double, double)>;

/// Whether steps h are allowed.
struct Allowed {
  double alpha, beta;
  const GuardLimits& limits;
  const Growth& growth;

  /// By the motion of one frequency.
  bool by(double w, double h) const {
    const double limit = std::min(limits.per_step, limits.whole * h / std::max(limits.duration, h));
    return !(growth(w, alpha, beta, h) > limit);
  }
  /// By those of all up to one.
  bool up_to(double frequency, double h) const {
    // Slower motions than those grow by less than rounding.
    constexpr double kSlow = 0.01;
    for (double w = frequency;; w *= std::numbers::sqrt2 / 2) {
      if (!by(w, h)) return false;
      if (w * h < kSlow) return true;
    }
  }
};

/// Upwards from a step that is surely allowed, in steps of a tenth; then bisection of the last one.
template <class Test>
double largest_allowed(double frequency, double fastest, Test&& allowed) {
  double low = 0.1 / fastest;
  while (!allowed(low) && low > 1e-9 / fastest) low *= 0.25;
  double high = low;
  while (high * frequency < 10.0 && allowed(high)) {
    low = high;
    high *= 1.1;
  }
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (allowed(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

double EmbeddedStepper::growth(double w, double alpha, double beta, double h) const {
  return cash_karp_growth(w, alpha, beta, h);
}

double cash_karp_amplification(double re, double im) {
  return amplification(re, im);
}

double guard_step(double frequency, double alpha, double beta, const GuardLimits& limits) {
  return guard_step(frequency, alpha, beta, limits, cash_karp_growth);
}

double guard_step(double frequency, double alpha, double beta, const GuardLimits& limits,
                  const Growth& growth) {
  if (!(frequency > 0.0)) return std::numeric_limits<double>::infinity();
  const double fastest = frequency + alpha + beta * frequency * frequency;
  if (!std::isfinite(fastest)) return 0.0;
  const Allowed allowed{alpha, beta, limits, growth};
  // Nearly always the fastest motion decides.
  const double step = largest_allowed(frequency, fastest, [&](double h) { return allowed.by(frequency, h); });
  if (allowed.up_to(frequency, step)) return step;
  return largest_allowed(frequency, fastest, [&](double h) { return allowed.up_to(frequency, h); });
}

}  // namespace tendril
