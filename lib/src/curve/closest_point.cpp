#include <tendril/base/error.h>
#include <tendril/curve/closest_point.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "capsule_tree.h"
#include "distance_search.h"
#include "minima_sweep.h"

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
    double t;
    double least;  ///< proven: no distance is smaller
  };
  /// \param hint  a parameter, NaN for none: its sub-piece is examined first
  virtual Found find(const Vec3& p, const Bounds& bounds, double hint) const = 0;
  /// Local minima up to the distance `cut`, in the order of t.
  virtual std::vector<search::Minimum> sweep(const Vec3& p, double cut, double blur) const = 0;

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
      : Data(c),
        pieces(sub_pieces<P>(curve)),
        fine(search::fine_pieces<P>(curve)),
        tree(all_points<P>(pieces), P + 1) {}

  Found find(const Vec3& p, const Bounds& bounds, double hint) const override {
    search::Search<P> search(curve, p, bounds);
    const std::size_t first = std::isnan(hint) ? pieces.size() : piece_at(hint);
    if (first < pieces.size()) search.examine(pieces[first]);
    tree.descend(
        p, [&] { return search.cut(); },
        [&](std::size_t piece) {
          if (piece != first) search.examine(pieces[piece]);
        });
    search.finish();
    return {search.t(), search.least()};
  }

  std::size_t piece_at(double t) const {
    const auto after =
        std::upper_bound(pieces.begin(), pieces.end(), t,
                         [](double at, const search::Piece<P>& piece) { return at < piece.begin; });
    return after == pieces.begin() ? 0 : static_cast<std::size_t>(after - pieces.begin()) - 1;
  }

  std::vector<search::Minimum> sweep(const Vec3& p, double cut, double blur) const override {
    std::vector<std::size_t> near;
    tree.descend(
        p, [&] { return cut; }, [&](std::size_t piece) { near.push_back(piece); });
    std::sort(near.begin(), near.end());
    search::Ridge ridge(curve, p, cut, blur);
    search::Sweep<P> examiner(p, cut, blur, ridge);
    const std::size_t parts = pieces.size() / fine.size();
    std::size_t expected = 0;
    for (const std::size_t i : near) {
      if (i != expected) ridge.far(pieces[i].begin);
      examiner.examine(pieces[i], fine[i / parts], static_cast<int>(i % parts), static_cast<int>(parts));
      expected = i + 1;
    }
    if (expected == pieces.size()) {
      ridge.trend(1, curve.knots().end());
    } else {
      ridge.far(curve.knots().end());
    }
    return ridge.take_all();
  }

  std::vector<search::Piece<P>> pieces;
  std::vector<search::FinePiece<P>> fine;
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
  Projection result{
      t, combine(basis, curve.degree(), curve.control_points()), 0.0, ProjectionKind::interior, 0.0, 0.0};
  const Vec3 offset = result.point - p;
  result.distance = offset.norm();
  result.gap = std::max(0.0, result.distance - std::max(0.0, found.least));
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

/// What a side of a joint says: lambda there, and the cosine between the offset and the way out.
struct Side {
  double lambda, cosine;
};

Side side(const BSpline& curve, double t, int span, const Vec3& offset, double way) {
  const Basis basis = curve.knots().basis_in_span(t, span, 2);
  const Vec3 d1 = combine(basis, curve.degree(), curve.control_points(), 1);
  const double speed = d1.norm(), distance = offset.norm();
  if (!(speed > 0.0)) return {0.0, 0.0};
  const Vec3 d2 = combine(basis, curve.degree(), curve.control_points(), 2);
  const double cosine = distance > 0.0 ? way * offset.dot(d1) / (speed * distance) : 0.0;
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
std::size_t same_place(const std::vector<search::Minimum>& minima, const Projection& nearest, double slack) {
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
  const std::size_t first = same_place(minima, nearest, bounds.slack);
  const bool known = first < minima.size();
  const double domain = data.curve.knots().end() - data.curve.knots().start();
  // Where the distance is flat to rounding the sweep places its minimum better.
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

void check(const Vec3& p) {
  if (!(p.cwiseAbs().maxCoeff() <= kLargest) || !is_finite(p))
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
