#include <tendril/base/error.h>
#include <tendril/curve/closest_point.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "degree_data.h"
#include "describe.h"
#include "spatial_order.h"

namespace tendril {

using search::Bounds;

namespace {

constexpr double kLargest = 1e150;
/// Points that go down the tree together.
constexpr std::size_t kTogether = 512;

std::shared_ptr<const CurveProjector::Data> prepare(const BSpline& curve) {
  for (const Vec3& u : curve.control_points())
    if (!(u.cwiseAbs().maxCoeff() <= kLargest))
      throw InvalidInput("CurveProjector: control points", "a coordinate beyond 1e150",
                         "squares within range");
  switch (curve.degree()) {
    case 1:
      return std::make_shared<DataOfDegree<1>>(curve);
    case 2:
      return std::make_shared<DataOfDegree<2>>(curve);
    case 3:
      return std::make_shared<DataOfDegree<3>>(curve);
    case 4:
      return std::make_shared<DataOfDegree<4>>(curve);
    default:
      return std::make_shared<DataOfDegree<5>>(curve);
  }
}

/// What a side of a joint says: lambda there, and the cosine between the offset and the outward tangent
/// (sign: 1 on the right, -1 on the left).
struct Side {
  double lambda, cosine;
};

Side side(const BSpline& curve, double t, int span, const Vec3& offset, double sign) {
  const Basis basis = curve.knots().basis_in_span(t, span, 2);
  const Vec3 d1 = combine(basis, curve.degree(), curve.control_points(), 1);
  const double speed = d1.norm(), distance = offset.norm();
  if (!(speed > 0.0)) return {0.0, 0.0};
  const Vec3 d2 = combine(basis, curve.degree(), curve.control_points(), 2);
  const double cosine = distance > 0.0 ? sign * offset.dot(d1) / (speed * distance) : 0.0;
  return {std::max(0.0, 1.0 + offset.dot(d2) / (speed * speed)), std::clamp(cosine, 0.0, 1.0)};
}

double strength(const BSpline& curve, const Projection& at, const Vec3& p) {
  if (at.kind == ProjectionKind::interior) return std::max(0.0, at.lambda);
  const KnotVector& knots = curve.knots();
  const int span = knots.span(at.t);
  const Side right = side(curve, at.t, span, at.point - p, 1.0);
  if (at.kind == ProjectionKind::start) return right.lambda + right.cosine;
  int before = span;
  if (at.kind == ProjectionKind::joint)
    while (before > knots.degree() && knots.knots()[static_cast<std::size_t>(before)] >= at.t) --before;
  const Side left = side(curve, at.t, before, at.point - p, -1.0);
  if (at.kind == ProjectionKind::end) return left.lambda + left.cosine;
  const double both = left.cosine + right.cosine;
  if (!(both > 0.0)) return 0.0;
  return (left.cosine * (right.lambda + right.cosine) + right.cosine * (left.lambda + left.cosine)) / both;
}

/// The minimum that the nearest point is, or the end of the list.
std::size_t same_minimum(const std::vector<search::Minimum>& minima, const Projection& nearest,
                         double slack) {
  std::size_t best = minima.size();
  for (std::size_t i = 0; i < minima.size(); ++i)
    if (minima[i].distance <= nearest.distance + slack &&
        (best == minima.size() || std::abs(minima[i].t - nearest.t) < std::abs(minima[best].t - nearest.t)))
      best = i;
  return best;
}

std::vector<LocalMinimum> list(const CurveProjector::Data& data, const Vec3& p, const Projection& nearest,
                               double band) {
  if (!(band >= 0.0)) throw InvalidInput("CurveProjector: band", std::to_string(band), "0 or more");
  const Bounds bounds = data.bounds(p);
  const double cut =
      std::min(std::numeric_limits<double>::max(), (1.0 + band) * nearest.distance + bounds.slack);
  const std::vector<search::Minimum> minima = data.sweep(p, std::min(cut, 1e153), bounds.blur);
  const std::size_t first = same_minimum(minima, nearest, bounds.slack);
  const bool known = first < minima.size();
  const double domain = data.curve.knots().end() - data.curve.knots().start();
  // Where the distance is flat to rounding the sweep locates its minimum better.
  const bool same = !known || std::abs(minima[first].t - nearest.t) <= 1e-7 * domain;
  const Projection front =
      same ? nearest : describe(data, p, {minima[first].t, minima[first].distance - minima[first].gap});
  std::vector<LocalMinimum> result;
  result.push_back({front, strength(data.curve, front, p), !known || minima[first].cluster,
                    known ? minima[first].multiplicity : 1});
  for (std::size_t i = 0; i < minima.size(); ++i) {
    if (i == first) continue;
    const Projection at = describe(data, p, {minima[i].t, minima[i].distance - minima[i].gap});
    result.push_back({at, strength(data.curve, at, p), minima[i].cluster, minima[i].multiplicity});
  }
  return result;
}

bool within_reach(const Vec3& p) {
  return is_finite(p) && p.cwiseAbs().maxCoeff() <= kLargest;
}

void check(const Vec3& p) {
  if (!within_reach(p))
    throw InvalidInput("CurveProjector: point", "not finite or beyond 1e150", "three finite numbers");
}

}  // namespace

CurveProjector::CurveProjector(const BSpline& curve) : data_(prepare(curve)) {}

Projection CurveProjector::nearest(const Vec3& p) const {
  check(p);
  return describe(*data_, p, data_->find(p, data_->bounds(p), std::numeric_limits<double>::quiet_NaN()));
}

Projection CurveProjector::nearest(const Vec3& p, double hint) const {
  check(p);
  if (std::isnan(hint)) throw InvalidInput("CurveProjector: hint", "not a number", "a parameter");
  return describe(*data_, p, data_->find(p, data_->bounds(p), hint));
}

std::vector<Projection> CurveProjector::nearest(Points points) const {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!within_reach(points[i]))
      throw InvalidInput("CurveProjector: points[" + std::to_string(i) + "]", "not finite or beyond 1e150",
                         "three finite numbers");
  std::vector<Data::Found> found(points.size());
  const std::vector<std::uint32_t> order = spatial_order(points);
  const auto batch = data_->batch();
  for (std::size_t begin = 0; begin < points.size(); begin += kTogether)
    batch->find(points, std::span(order).subspan(begin, std::min(kTogether, points.size() - begin)), found);
  return data_->describe(points, found);
}

std::vector<LocalMinimum> CurveProjector::all(const Vec3& p, double band) const {
  return list(*data_, p, nearest(p), band);
}

std::vector<LocalMinimum> CurveProjector::all(const Vec3& p, double band, double hint) const {
  return list(*data_, p, nearest(p, hint), band);
}

const BSpline& CurveProjector::curve() const {
  return data_->curve;
}

}  // namespace tendril
