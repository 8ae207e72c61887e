#include "turn.h"

#include <cmath>

namespace tendril {
namespace {

constexpr double kSmall = 0.25;  // below which a series is as good as the closed form

/// a x, as a matrix.
Mat3 crossing(const Vec3& a) {
  Mat3 m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

/// (1 - t/2 cot(t/2)) / t^2: Bernoulli numbers over factorials.
double second_coefficient(double angle) {
  const double t2 = angle * angle;
  if (angle < kSmall)
    return 1.0 / 12 + t2 * (1.0 / 720 + t2 * (1.0 / 30240 + t2 * (1.0 / 1209600 + t2 * (1.0 / 47900160))));
  return (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / t2;
}

}  // namespace

Mat3 rotation_of(const Vec3& phi) {
  const double angle = phi.norm();
  if (angle == 0.0) return Mat3::Identity();
  const double half = std::sin(0.5 * angle) / angle;
  const Mat3 k = crossing(phi);
  return Mat3::Identity() + (std::sin(angle) / angle) * k + (2.0 * half * half) * (k * k);
}

Mat3 turning_rate(const Vec3& phi) {
  const Mat3 k = crossing(phi);
  return Mat3::Identity() - 0.5 * k + second_coefficient(phi.norm()) * (k * k);
}

}  // namespace tendril
