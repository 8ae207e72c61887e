#include <tendril/base/error.h>
#include <tendril/curve/arc_length.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tendril {
namespace {

constexpr int kMaxDepth = 48;
constexpr double kAgreement = 1e-14;  // of a cell with its halves, relative to the total
constexpr double kRounding = 1e-14;   // of the length of a span, relative to its coordinates

/// Positive abscissae and weights of the ten-point Gauss-Legendre rule on [-1, 1].
struct Node {
  double x, weight;
};
constexpr std::array<Node, 5> kGauss{{{0.14887433898163121, 0.29552422471475287},
                                      {0.43339539412924719, 0.26926671930999636},
                                      {0.67940956829902441, 0.21908636251598204},
                                      {0.86506336668898451, 0.14945134915058059},
                                      {0.97390652851717172, 0.06667134430868814}}};

double gauss_length(const BSpline& curve, double a, double b) {
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  double sum = 0.0;
  for (const Node& node : kGauss) {
    const double x = half * node.x;
    sum += node.weight * (curve.derivative(middle - x).norm() + curve.derivative(middle + x).norm());
  }
  return half * sum;
}

/// The ten-point rule is exact to degree 19; |c'|, the root of a polynomial of degree 2 p - 2, is analytic
/// but where the speed vanishes, so halving a cell divides the error of the rule by up to 2^20 away from
/// there, and the difference of a cell and its two halves exceeds the error of the halves. Next to a
/// point of zero speed |c'| has a kink, and cells shrink towards it until they contribute less than the
/// tolerance.
///
/// Splits spans into cells; `cell(b, length)` is called for each in order, with its right end.
template <class Cell>
class Adaptive {
 public:
  Adaptive(const BSpline& curve, double tolerance, Cell cell)
      : curve_(curve), tolerance_(tolerance), cell_(cell) {}

  void split(double a, double b, double whole, int depth) {
    const double middle = 0.5 * (a + b);
    const double left = gauss_length(curve_, a, middle);
    const double right = gauss_length(curve_, middle, b);
    if (std::abs(left + right - whole) <= tolerance_ || depth == kMaxDepth || middle <= a || middle >= b) {
      cell_(middle, left);
      cell_(b, right);
      return;
    }
    split(a, middle, left, depth + 1);
    split(middle, b, right, depth + 1);
  }

 private:
  const BSpline& curve_;
  double tolerance_;
  Cell cell_;
};

}  // namespace

ArcLength::ArcLength(const BSpline& curve)
    : curve_(curve), parameters_{curve.knots().start()}, lengths_{0.0} {
  std::vector<double> knots(curve.knots().knots().begin(), curve.knots().knots().end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  std::vector<double> rough;
  double estimate = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    rough.push_back(gauss_length(curve, knots[i], knots[i + 1]));
    estimate += rough.back();
  }
  if (!std::isfinite(estimate))
    throw InvalidInput("ArcLength: control points", "a speed beyond 1e154", "squares within range");
  double reach = 0.0;
  for (const Vec3& u : curve.control_points()) reach = std::max(reach, u.norm());
  // Two results cannot agree better than c' is evaluated, which counts for a curve far from the origin or at
  // rest.
  const double tolerance = kAgreement * estimate + kRounding * reach;
  Adaptive adaptive(curve, tolerance, [this](double b, double length) {
    if (!(b > parameters_.back())) return;
    parameters_.push_back(b);
    lengths_.push_back(lengths_.back() + length);
  });
  for (std::size_t i = 0; i < rough.size(); ++i) adaptive.split(knots[i], knots[i + 1], rough[i], 0);
}

double ArcLength::speed(double t) const {
  return curve_.derivative(t).norm();
}

/// Length up to t in a cell, from whichever end of the cell is nearer, so that both are met exactly.
double ArcLength::from_cell(std::size_t cell, double t) const {
  const double a = parameters_[cell], b = parameters_[cell + 1];
  const double s = t - a <= b - t ? lengths_[cell] + gauss_length(curve_, a, t)
                                  : lengths_[cell + 1] - gauss_length(curve_, t, b);
  return std::clamp(s, lengths_[cell], lengths_[cell + 1]);
}

double ArcLength::length_to(double t) const {
  if (std::isnan(t)) throw InvalidInput("ArcLength: t", "not a number", "a parameter");
  if (t <= parameters_.front()) return 0.0;
  if (t >= parameters_.back()) return total();
  const auto after = std::upper_bound(parameters_.begin(), parameters_.end(), t);
  return from_cell(static_cast<std::size_t>(after - parameters_.begin()) - 1, t);
}

double ArcLength::parameter_at(double s) const {
  if (std::isnan(s)) throw InvalidInput("ArcLength: s", "not a number", "a length");
  s = std::clamp(s, 0.0, total());
  // A boundary counts as reached within rounding of the sum, so that a rest is entered at its start.
  const double rounding = 1e-15 * total();
  const auto at = std::lower_bound(lengths_.begin(), lengths_.end(), s - rounding);
  const auto index = static_cast<std::size_t>(at - lengths_.begin());
  if (*at <= s + rounding) return parameters_[index];
  const std::size_t cell = index - 1;
  double low = parameters_[cell], high = parameters_[cell + 1];
  double t = low + (high - low) * ((s - lengths_[cell]) / (lengths_[index] - lengths_[cell]));
  for (int i = 0; i < 100; ++i) {
    const double excess = from_cell(cell, t) - s;
    if (std::abs(excess) <= 1e-16 * total()) break;
    (excess < 0.0 ? low : high) = t;
    const double rate = speed(t);
    double next = rate > 0.0 ? t - excess / rate : low;
    if (next == t) break;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next <= low || next >= high) break;
    t = next;
  }
  return t;
}

}  // namespace tendril
