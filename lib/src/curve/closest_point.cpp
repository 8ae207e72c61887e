#include <tendril/base/error.h>
#include <tendril/curve/closest_point.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "capsule_tree.h"
#include "distance_search.h"

namespace tendril {

using search::Bounds;
using search::kUnit;

/// The curve and what classification needs; the search proper depends on the degree.
struct CurveProjector::Data {
  explicit Data(const BSpline& c) : curve(c) {
    Eigen::AlignedBox3d box;
    for (const Vec3& u : curve.control_points()) {
      box.extend(u);
      reach = std::max(reach, u.norm());
    }
    centre = box.center();
    diagonal = box.diagonal().norm();
  }
  virtual ~Data() = default;

  struct Found {
    double t, distance, gap;
  };
  virtual Found find(const Vec3& p, const Bounds& bounds, double upper) const = 0;

  double size(const Vec3& p) const { return diagonal + (p - centre).norm(); }
  Bounds bounds(const Vec3& p) const {
    const double blur = 12 * (curve.degree() + 1) * kUnit * reach;
    return {1e-14 * size(p), 1e-13 * size(p) + 4.0 * blur, blur};
  }

  BSpline curve;
  Vec3 centre;
  double diagonal = 0.0;
  double reach = 0.0;  ///< largest norm of a control point
};

namespace {

constexpr double kLargest = 1e150;

/// Halves a Bezier piece `times` times and appends the parts.
template <int P>
void divide(const search::Piece<P>& piece, int times, std::vector<search::Piece<P>>& out) {
  if (times == 0) {
    out.push_back(piece);
    return;
  }
  search::Interval<P> left;
  left.points = piece.points;
  left.low = 0.0;
  left.high = 1.0;
  left.depth = 0;
  const search::Interval<P> right = left.halve();
  const double middle = piece.parameter(0.5);
  divide<P>({left.points, piece.begin, middle}, times - 1, out);
  divide<P>({right.points, middle, piece.end}, times - 1, out);
}

template <int P>
std::vector<search::Piece<P>> sub_pieces(const BSpline& curve) {
  std::vector<search::Piece<P>> pieces;
  for (const BezierPiece& bezier : curve.bezier_pieces()) {
    search::Piece<P> piece{{}, bezier.begin, bezier.end};
    std::copy(bezier.points.begin(), bezier.points.end(), piece.points.begin());
    divide<P>(piece, P == 1 ? 0 : 2, pieces);
  }
  return pieces;
}

template <int P>
std::vector<Vec3> all_points(const std::vector<search::Piece<P>>& pieces) {
  std::vector<Vec3> points;
  for (const auto& piece : pieces) points.insert(points.end(), piece.points.begin(), piece.points.end());
  return points;
}

template <int P>
struct DataOfDegree final : CurveProjector::Data {
  explicit DataOfDegree(const BSpline& c)
      : Data(c), pieces(sub_pieces<P>(curve)), tree(all_points<P>(pieces), P + 1) {}

  Found find(const Vec3& p, const Bounds& bounds, double upper) const override {
    search::Search<P> search(curve, p, bounds, upper);
    tree.descend(
        p, [&] { return search.cut(); }, [&](std::size_t piece) { search.examine(pieces[piece]); });
    return {search.t(), search.distance(), search.gap()};
  }

  std::vector<search::Piece<P>> pieces;
  CapsuleTree tree;
};

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

/// Smallest angle that is told from a right one (of offset and tangent) or from none (of tangents).
constexpr double kAngle = 1e-9;

/// Speed below rounding of the control points' differences.
bool at_rest(const CurveProjector::Data& data, const Vec3& velocity, int span) {
  const auto i = static_cast<std::size_t>(span);
  const auto knots = data.curve.knots().knots();
  return velocity.norm() * (knots[i + 1] - knots[i]) <= 64.0 * kUnit * (data.diagonal + data.reach);
}

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

Projection describe(const CurveProjector::Data& data, const Vec3& p,
                    const CurveProjector::Data::Found& found) {
  const BSpline& curve = data.curve;
  const KnotVector& knots = curve.knots();
  const double t = found.t;
  const int span = knots.span(t);
  const Basis basis = knots.basis_in_span(t, span, 2);
  Projection result{t,
                    combine(basis, curve.degree(), curve.control_points()),
                    found.distance,
                    ProjectionKind::interior,
                    0.0,
                    found.gap};
  const Vec3 offset = result.point - p;
  const Vec3 d1 = combine(basis, curve.degree(), curve.control_points(), 1);
  const bool rest = at_rest(data, d1, span);
  if (!rest) {
    const Vec3 d2 = combine(basis, curve.degree(), curve.control_points(), 2);
    result.lambda = 1.0 + offset.dot(d2) / d1.squaredNorm();
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

void check(const Vec3& p) {
  if (!(p.cwiseAbs().maxCoeff() <= kLargest) || !is_finite(p))
    throw InvalidInput("CurveProjector: point", "not finite or beyond 1e150", "three finite numbers");
}

}  // namespace

CurveProjector::CurveProjector(const BSpline& curve) : data_(prepare(curve)) {}

Projection CurveProjector::nearest(const Vec3& p) const {
  check(p);
  return describe(*data_, p, data_->find(p, data_->bounds(p), std::numeric_limits<double>::infinity()));
}

Projection CurveProjector::nearest(const Vec3& p, double hint) const {
  check(p);
  if (std::isnan(hint)) throw InvalidInput("CurveProjector: hint", "not a number", "a parameter");
  return describe(*data_, p, data_->find(p, data_->bounds(p), (data_->curve.value(hint) - p).norm()));
}

const BSpline& CurveProjector::curve() const {
  return data_->curve;
}

}  // namespace tendril
