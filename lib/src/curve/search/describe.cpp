#include "describe.h"

#include <cmath>

namespace tendril {
namespace {

/// Smallest angle that is told from a right one (of offset and tangent) or from none (of tangents).
constexpr double kAngle = 1e-9;

/// Whether the distance has a kink at the interior knot t: c' jumps there, and the offset is orthogonal to
/// neither of its sides.
bool is_kink(const BSpline& curve, double t, int span, const Vec3& offset, const Vec3& right, double size) {
  int before = span - 1;
  const auto knots = curve.knots().knots();
  while (knots[static_cast<std::size_t>(before)] == t) --before;
  const Vec3 left =
      combine(curve.knots().basis_in_span(t, before, 1), curve.degree(), curve.control_points(), 1);
  if (!(left.cross(right).norm() > kAngle * left.norm() * right.norm()) && left.dot(right) > 0.0)
    return false;
  if (offset.norm() <= 1e-14 * size) return true;
  return std::abs(offset.dot(left)) > kAngle * offset.norm() * left.norm() &&
         std::abs(offset.dot(right)) > kAngle * offset.norm() * right.norm();
}

}  // namespace

Projection describe(const CurveProjector::Data& data, const Vec3& p,
                    const CurveProjector::Data::Found& found) {
  const BSpline& curve = data.curve;
  const KnotVector& knots = curve.knots();
  const double t = found.t;
  const int span = knots.span(t);
  const Basis basis = knots.basis_in_span(t, span, 2);
  Projection result{
      t, combine(basis, curve.degree(), curve.control_points()), 0.0, ProjectionKind::interior, 0.0, 0.0};
  const Vec3 offset = result.point - p;
  const lanes::V3 away = search::plain(offset);
  result.distance = lanes::norm(away);
  result.gap = std::max(0.0, result.distance - std::max(0.0, found.least));
  const Vec3 d1 = combine(basis, curve.degree(), curve.control_points(), 1);
  const auto at = static_cast<std::size_t>(span);
  const lanes::V3 velocity = search::plain(d1);
  const bool rest = data.at_rest(lanes::norm(velocity), knots.knots()[at + 1] - knots.knots()[at]);
  if (!rest) {
    const Vec3 d2 = combine(basis, curve.degree(), curve.control_points(), 2);
    result.lambda = 1.0 + lanes::dot(away, search::plain(d2)) / lanes::dot(velocity, velocity);
  }
  if (t == knots.start()) {
    result.kind = ProjectionKind::start;
  } else if (t == knots.end()) {
    result.kind = ProjectionKind::end;
  } else if (rest || (t == knots.knots()[static_cast<std::size_t>(span)] &&
                      is_kink(curve, t, span, offset, d1, data.size(p)))) {
    result.kind = ProjectionKind::joint;
  }
  return result;
}

}  // namespace tendril
