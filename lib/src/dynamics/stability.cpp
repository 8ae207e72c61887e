#include <tendril/dynamics/stability.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace tendril {
namespace {

using Complex = std::complex<double>;

double amplification(const Complex& z) {
  return std::abs(1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6 + z * (1.0 / 24 + z * (1.0 / 120 + z / 800.0))))));
}

/// Growth a step beyond 1 of the oscillator's worse root.
double growth(double w, double alpha, double beta, double h) {
  const double half = 0.5 * (alpha + beta * w * w);
  const Complex root = std::sqrt(Complex(half * half - w * w, 0.0));
  // The larger root first; the other from the product w^2, without cancellation.
  const Complex fast = -half - root;
  const Complex slow = fast == 0.0 ? Complex(0.0) : w * w / fast;
  return std::max(amplification(h * fast), amplification(h * slow)) - 1.0;
}

bool allowed(double frequency, double alpha, double beta, const GuardLimits& limits, double h) {
  const double limit = std::min(limits.per_step, limits.whole * h / std::max(limits.duration, h));
  for (int half_octave = 0; half_octave < 24; ++half_octave)
    if (growth(frequency * std::exp2(-0.5 * half_octave), alpha, beta, h) > limit) return false;
  return true;
}

}  // namespace

double cash_karp_amplification(double re, double im) {
  return amplification(Complex(re, im));
}

double guard_step(double frequency, double alpha, double beta, const GuardLimits& limits) {
  if (!(frequency > 0.0)) return std::numeric_limits<double>::infinity();
  // Upwards from a step that is surely allowed, in steps of a tenth; then bisection of the last one.
  const double fastest = frequency + alpha + beta * frequency * frequency;
  double low = 2e-2 / fastest;
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
