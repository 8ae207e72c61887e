#include <tendril/base/error.h>
#include <tendril/dynamics/section.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace tendril {
namespace {

constexpr double kPi = std::numbers::pi;

void check(const char* what, double size) {
  if (!(size > 0.0) || !std::isfinite(size))
    throw InvalidInput(what, std::to_string(size), "a positive length");
}

/// Saint-Venant's torsion of a rectangle [Timoshenko and Goodier 1970], a >= b:
/// J = a b^3 (1/3 - 64/pi^5 (b/a) sum over odd k of tanh(k pi a / 2b) / k^5).
double rectangle_torsion(double a, double b) {
  if (a < b) std::swap(a, b);
  double sum = 0.0;
  // The tail from k on is below k^-4 / 8: 1e-13 of the whole at k = 1200.
  for (int k = 1201; k >= 1; k -= 2) sum += std::tanh(k * kPi * a / (2 * b)) / std::pow(k, 5);
  return a * b * b * b * (1.0 / 3 - 64 / std::pow(kPi, 5) * (b / a) * sum);
}

}  // namespace

Section circular_section(double radius) {
  check("radius", radius);
  return elliptic_section(radius, radius);
}

Section elliptic_section(double a, double b) {
  check("semi-axis a", a);
  check("semi-axis b", b);
  const double i1 = kPi * a * a * a * b / 4;
  const double i2 = kPi * a * b * b * b / 4;
  const double torsion = kPi * a * a * a * b * b * b / (a * a + b * b);
  return {kPi * a * b, i1, i2, torsion, i1 + i2, a + b};
}

Section rectangular_section(double a, double b) {
  check("side a", a);
  check("side b", b);
  const double i1 = a * a * a * b / 12;
  const double i2 = a * b * b * b / 12;
  // Cauchy: the mean width of a convex region is its perimeter over pi.
  return {a * b, i1, i2, rectangle_torsion(a, b), i1 + i2, 2 * (a + b) / kPi};
}

}  // namespace tendril
