#include <tendril/base/error.h>
#include <tendril/curve/reference_frames.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace tendril {
namespace {

/// A derivative, or zero when it is not told from its rounding error.
Vec3 derivative_or_zero(const BSpline& curve, const Basis& basis, int order) {
  const auto& weight = basis.value[static_cast<std::size_t>(order)];
  double terms = 0.0;
  for (int j = 0; j <= curve.degree(); ++j)
    terms += std::abs(weight[static_cast<std::size_t>(j)]) *
             curve.control_points()[static_cast<std::size_t>(basis.first + j)].norm();
  const Vec3 derivative = combine(basis, curve.degree(), curve.control_points(), order);
  if (derivative.norm() <= 32.0 * std::numeric_limits<double>::epsilon() * terms) return Vec3::Zero();
  return derivative;
}

struct Derivatives {
  Vec3 d1, d2, d3;
  Vec3 tangent;  // unit
  bool moving;
};

Derivatives derivatives(const BSpline& curve, double t) {
  const Basis basis = curve.knots().basis(t, 3);
  Derivatives d{derivative_or_zero(curve, basis, 1), derivative_or_zero(curve, basis, 2),
                derivative_or_zero(curve, basis, 3), Vec3::UnitZ(), true};
  // c'(t + h) = c'' h + c''' h^2 / 2 with h of either sign.
  const double side = t < curve.knots().end() ? 1.0 : -1.0;
  d.moving = !d.d1.isZero(0.0);
  for (const Vec3& v : {d.d1, Vec3(side * d.d2), d.d3})
    if (!v.isZero(0.0)) {
      d.tangent = v.stableNormalized();
      break;
    }
  return d;
}

void check_direction(const Vec3& d) {
  if (!is_finite(d) || d.isZero(0.0))
    throw InvalidInput("direction", "zero or not finite", "a finite vector that is not zero");
}

void check_parameters(std::span<const double> parameters) {
  if (parameters.empty()) throw InvalidInput("parameters", "none", "at least one");
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (std::isnan(parameters[i]) || (i > 0 && parameters[i] < parameters[i - 1]))
      throw InvalidInput("parameters[" + std::to_string(i) + "]", "not a number or decreasing",
                         "a sequence that does not decrease");
}

/// v mirrored in the plane across `normal`, which need not be a unit vector.
Vec3 mirror(const Vec3& v, const Vec3& normal) {
  return v - (2.0 * normal.dot(v) / normal.squaredNorm()) * normal;
}

struct Step {
  Vec3 y;
  FrameStatus status;
};

/// The reference direction y carried from one point and tangent to the next.
Step carry(const Vec3& edge, const Vec3& from, const Vec3& to, const Vec3& y, double resolution) {
  if (edge.norm() <= resolution) return {rotate_smallest(from, to, y), FrameStatus::zero_edge};
  const Vec3 e = edge.normalized();
  const Vec3 tangent = mirror(from, e);
  const Vec3 carried = mirror(y, e);
  const Vec3 turn = to - tangent;
  if (turn.norm() <= 1e-12) return {carried, FrameStatus::fold_back};
  return {mirror(carried, turn), FrameStatus::ok};
}

}  // namespace

FrenetFrame frenet_frame(const BSpline& curve, double t) {
  const Derivatives d = derivatives(curve, t);
  const FrameChoice choice = frame_towards(d.tangent, d.d2);
  FrenetFrame result{choice.frame, d.moving ? choice.status : FrameStatus::zero_speed, 0.0, 0.0};
  if (result.status != FrameStatus::ok) return result;
  const Vec3 area = d.d1.cross(d.d2);
  const double speed = d.d1.norm();
  result.curvature = area.norm() / speed / speed / speed;
  result.torsion = area.dot(d.d3) / area.squaredNorm();
  return result;
}

FrameChoice directional_frame(const BSpline& curve, double t, const Vec3& d) {
  check_direction(d);
  const Derivatives at = derivatives(curve, t);
  FrameChoice choice = frame_towards(at.tangent, d);
  if (!at.moving) choice.status = FrameStatus::zero_speed;
  return choice;
}

NodeFrames rotation_minimising_frames(const BSpline& curve, std::span<const double> parameters,
                                      const Vec3& y) {
  check_parameters(parameters);
  const FrameChoice first = directional_frame(curve, parameters.front(), y);
  NodeFrames result{{first.frame}, {first.status}};
  double reach = 0.0;
  for (const Vec3& u : curve.control_points()) reach = std::max(reach, u.norm());
  const double resolution = 32.0 * std::numeric_limits<double>::epsilon() * reach;
  Vec3 before = curve.value(parameters.front());
  for (const double t : parameters.subspan(1)) {
    const Vec3 point = curve.value(t);
    const Derivatives at = derivatives(curve, t);
    const Frame& last = result.frame.back();
    const Step step = carry(point - before, last.z, at.tangent, last.y, resolution);
    // Rounding aside, y is across the tangent already.
    result.frame.push_back(frame_towards(at.tangent, step.y).frame);
    result.status.push_back(at.moving ? step.status : FrameStatus::zero_speed);
    before = point;
  }
  return result;
}

}  // namespace tendril
