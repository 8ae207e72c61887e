#include <tendril/base/error.h>
#include <tendril/curve/bspline.h>

#include <cassert>
#include <string>

namespace tendril {
namespace {

void check(const KnotVector& knots, Points control_points) {
  const auto expected = static_cast<std::size_t>(knots.control_points());
  if (control_points.size() != expected)
    throw InvalidInput("control points", std::to_string(control_points.size()) + " of them",
                       std::to_string(expected) + " (knots - degree - 1)");
  for (std::size_t i = 0; i < control_points.size(); ++i)
    if (!is_finite(control_points[i]))
      throw InvalidInput("control_points[" + std::to_string(i) + "]", "not finite", "three finite numbers");
}

/// The blossom (polar form) of the piece in `span`: de Boor's triangle with its own argument on each level.
Vec3 blossom(const BSpline& curve, int span, std::span<const double> arguments) {
  const int p = curve.degree();
  const double* knot = curve.knots().knots().data() + span;
  std::array<Vec3, kMaxDegree + 1> d;
  for (int j = 0; j <= p; ++j)
    d[static_cast<std::size_t>(j)] = curve.control_points()[static_cast<std::size_t>(span - p + j)];
  for (int level = 1; level <= p; ++level) {
    const double t = arguments[static_cast<std::size_t>(level - 1)];
    for (int j = p; j >= level; --j) {
      const double left = knot[j - p];
      const double right = knot[j + 1 - level];
      const double w = (t - left) / (right - left);
      auto& to = d[static_cast<std::size_t>(j)];
      to = (1.0 - w) * d[static_cast<std::size_t>(j - 1)] + w * to;
    }
  }
  return d[static_cast<std::size_t>(p)];
}

}  // namespace

Vec3 combine(const Basis& basis, int degree, Points control_points, int order) {
  const auto& weight = basis.value[static_cast<std::size_t>(order)];
  const Vec3* u = control_points.data() + basis.first;
  Vec3 sum = weight[0] * u[0];
  for (int j = 1; j <= degree; ++j) sum += weight[static_cast<std::size_t>(j)] * u[j];
  return sum;
}

BSpline::BSpline(KnotVector knots, std::vector<Vec3> control_points)
    : knots_(std::move(knots)), control_points_(std::move(control_points)) {
  check(knots_, control_points_);
}

void BSpline::set_control_points(Points control_points) {
  check(knots_, control_points);
  control_points_.assign(control_points.begin(), control_points.end());
}

Vec3 BSpline::value(double t) const {
  return combine(knots_.basis(t), degree(), control_points_);
}

Vec3 BSpline::derivative(double t, int order) const {
  assert(order >= 1 && order <= kMaxDerivative);
  return combine(knots_.basis(t, order), degree(), control_points_, order);
}

std::vector<BezierPiece> BSpline::bezier_pieces() const {
  std::vector<BezierPiece> pieces;
  const auto p = static_cast<std::size_t>(degree());
  std::array<double, kMaxDegree> arguments{};
  for (const int span : knots_.nonempty_spans()) {
    const double a = knots_.knots()[static_cast<std::size_t>(span)];
    const double b = knots_.knots()[static_cast<std::size_t>(span) + 1];
    BezierPiece piece{a, b, {}};
    for (std::size_t j = 0; j <= p; ++j) {
      for (std::size_t i = 0; i < p; ++i) arguments[i] = i < p - j ? a : b;
      piece.points.push_back(blossom(*this, span, std::span(arguments).first(p)));
    }
    pieces.push_back(std::move(piece));
  }
  // Neighbours share their joint to the last bit.
  for (std::size_t i = 1; i < pieces.size(); ++i) pieces[i].points.front() = pieces[i - 1].points.back();
  return pieces;
}

}  // namespace tendril
