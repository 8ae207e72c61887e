#include <tendril/base/error.h>
#include <tendril/curve/curve_pair.h>

#include <cmath>
#include <string>

namespace tendril {
namespace {

constexpr double kZeroSpeed = 1e-14;

/// About z, so that the side y goes towards -x.
Frame turned(const Frame& f, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * f.x + s * f.y, c * f.y - s * f.x, f.z};
}

}  // namespace

CurvePair::CurvePair(const KnotVector& knots, std::vector<Vec3> primary, std::vector<Vec3> orientation)
    : primary_(knots, std::move(primary)), orientation_(knots, std::move(orientation)) {
  measure();
}

void CurvePair::set_control_points(Points primary, Points orientation) {
  primary_.set_control_points(primary);
  orientation_.set_control_points(orientation);
  measure();
}

void CurvePair::set_turn(std::vector<double> turn) {
  const std::size_t count = primary_.control_points().size();
  if (!turn.empty() && turn.size() != count)
    throw InvalidInput("turn", std::to_string(turn.size()) + " values", std::to_string(count) + ", or none");
  for (std::size_t i = 0; i < turn.size(); ++i)
    if (!std::isfinite(turn[i]))
      throw InvalidInput("turn[" + std::to_string(i) + "]", "not finite", "a finite angle");
  turn_ = std::move(turn);
}

void CurvePair::measure() {
  Vec3 low = primary_.control_points().front();
  Vec3 high = low;
  for (const Vec3& u : primary_.control_points()) {
    low = low.cwiseMin(u);
    high = high.cwiseMax(u);
  }
  scale_of_speed_ = (high - low).norm() / (knots().end() - knots().start());
}

CurveFrame CurvePair::frame(double t) const {
  return frame(knots().basis(t, 1), t);
}

CurveFrame CurvePair::frame(const Basis& basis, double t) const {
  const int p = primary_.degree();
  CurveFrame result;
  result.origin = combine(basis, p, primary_.control_points());
  const Vec3 velocity = combine(basis, p, primary_.control_points(), 1);
  const double speed = velocity.norm();
  const bool moving = speed > kZeroSpeed * scale_of_speed_;
  const Vec3 tangent = moving ? Vec3(velocity / speed) : tangent_at_zero_speed(t);
  const FrameChoice choice =
      frame_towards(tangent, combine(basis, p, orientation_.control_points()) - result.origin);
  result.frame = choice.frame;
  if (!turn_.empty()) {
    double angle = 0.0;
    for (int j = 0; j <= p; ++j)
      angle += basis.value[0][static_cast<std::size_t>(j)] * turn_[static_cast<std::size_t>(basis.first + j)];
    result.frame = turned(choice.frame, angle);
  }
  result.sine = choice.sine;
  result.status = moving ? choice.status : FrameStatus::zero_speed;
  return result;
}

Vec3 CurvePair::tangent_at_zero_speed(double t) const {
  // c'(t + h) = c'' h + c''' h^2 / 2: looking forward except at the end, where the curve arrives from behind.
  const double side = t < knots().end() ? 1.0 : -1.0;
  const double length = knots().end() - knots().start();
  double scale = length * side;
  for (int order = 2; order <= kMaxDerivative; ++order, scale *= length * side) {
    const Vec3 derivative = primary_.derivative(t, order) * scale;
    if (derivative.norm() > kZeroSpeed * scale_of_speed_ * length) return derivative.normalized();
  }
  const Vec3 chord = primary_.control_points().back() - primary_.control_points().front();
  return chord.norm() > 0.0 ? Vec3(chord.normalized()) : Vec3(Vec3::UnitZ());
}

}  // namespace tendril
