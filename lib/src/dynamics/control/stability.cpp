#include <tendril/dynamics/stability.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril {
namespace {

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

/// Growth a step beyond 1 of the oscillator's worse root.
double growth(double w, double alpha, double beta, double h) {
  const double half = 0.5 * (alpha + beta * w * w);
  const double discriminant = half * half - w * w;
  if (discriminant < 0.0) return amplification(-h * half, h * std::sqrt(-discriminant)) - 1.0;
  // The larger root first; the other from the product w^2, without cancellation.
  const double fast = -half - std::sqrt(discriminant);
  const double slow = fast == 0.0 ? 0.0 : w * w / fast;
  return std::max(amplification(h * fast, 0.0), amplification(h * slow, 0.0)) - 1.0;
}

bool allowed(double frequency, double alpha, double beta, const GuardLimits& limits, double h) {
  const double limit = std::min(limits.per_step, limits.whole * h / std::max(limits.duration, h));
  // Slower motions than those grow by less than rounding.
  constexpr double kSlow = 0.01;
  for (double w = frequency;; w *= std::numbers::sqrt2 / 2) {
    if (growth(w, alpha, beta, h) > limit) return false;
    if (w * h < kSlow) return true;
  }
}

}  // namespace

double cash_karp_amplification(double re, double im) {
  return amplification(re, im);
}

double guard_step(double frequency, double alpha, double beta, const GuardLimits& limits) {
  if (!(frequency > 0.0)) return std::numeric_limits<double>::infinity();
  // Upwards from a step that is surely allowed, in steps of a tenth; then bisection of the last one.
  const double fastest = frequency + alpha + beta * frequency * frequency;
  if (!std::isfinite(fastest)) return 0.0;
  double low = 0.1 / fastest;
  while (!allowed(frequency, alpha, beta, limits, low) && low > 1e-9 / fastest) low *= 0.25;
  double high = low;
  while (high * frequency < 10.0 && allowed(frequency, alpha, beta, limits, high)) {
    low = high;
    high *= 1.1;
  }
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (allowed(frequency, alpha, beta, limits, middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace tendril
