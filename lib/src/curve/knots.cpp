#include <tendril/base/error.h>
#include <tendril/curve/knots.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "basis_rows.h"

namespace tendril {
namespace {

std::string at(std::size_t i) {
  return "knots[" + std::to_string(i) + "]";
}

void check_degree(int degree) {
  if (degree < 1 || degree > kMaxDegree)
    throw InvalidInput("degree", std::to_string(degree), "1 to " + std::to_string(kMaxDegree));
}

void check_order(std::span<const double> knots) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i])) throw InvalidInput(at(i), "not finite", "a finite number");
    if (i > 0 && knots[i] < knots[i - 1])
      throw InvalidInput(at(i), std::to_string(knots[i]) + " is less than the knot before it",
                         "a non-decreasing sequence");
  }
}

void check_multiplicity(std::span<const double> knots, int degree) {
  const std::size_t p = static_cast<std::size_t>(degree);
  const std::size_t m = knots.size() - 1;
  if (!(knots.front() < knots.back()))
    throw InvalidInput("knots", "all equal", "a domain of positive length");
  for (std::size_t i = 1; i <= p; ++i) {
    if (knots[i] != knots.front())
      throw InvalidInput(at(i), "differs from the first", "a clamped start (degree + 1 equal knots)");
    if (knots[m - i] != knots.back())
      throw InvalidInput(at(m - i), "differs from the last", "a clamped end (degree + 1 equal knots)");
  }
  for (std::size_t i = 1; i + p < m; ++i)
    if (knots[i] == knots[i + p])
      throw InvalidInput(at(i), "repeated more than degree times", "a continuous curve");
}

template <int P>
void fill(const double* knot, double t, int derivatives, Basis& basis) {
  basis::Rows rows;
  rows[0] = basis::Row{1.0};
  basis::fill_values<P>(rows, knot, t);
  basis.value[0] = rows[P];
  if constexpr (P >= 1)
    if (derivatives >= 1) basis.value[1] = basis::differentiate<P, P - 1>(rows[P - 1], knot);
  if constexpr (P >= 2)
    if (derivatives >= 2) basis.value[2] = basis::differentiate<P, P - 2>(rows[P - 2], knot);
  if constexpr (P >= 3)
    if (derivatives >= 3) basis.value[3] = basis::differentiate<P, P - 3>(rows[P - 3], knot);
}

}  // namespace

KnotVector::KnotVector(int degree, std::vector<double> knots) : degree_(degree), knots_(std::move(knots)) {
  check_degree(degree);
  const std::size_t least = 2 * (static_cast<std::size_t>(degree) + 1);
  if (knots_.size() < least)
    throw InvalidInput("knots", std::to_string(knots_.size()) + " of them",
                       "at least 2 (degree + 1) = " + std::to_string(least));
  check_order(knots_);
  check_multiplicity(knots_, degree);
}

KnotVector KnotVector::uniform(int degree, int control_points) {
  check_degree(degree);
  if (control_points <= degree)
    throw InvalidInput("control points", std::to_string(control_points) + " of them",
                       "more than the degree " + std::to_string(degree));
  const int spans = control_points - degree;
  std::vector<double> knots;
  for (int i = -degree; i <= spans + degree; ++i)
    knots.push_back(static_cast<double>(std::clamp(i, 0, spans)) / static_cast<double>(spans));
  return KnotVector(degree, std::move(knots));
}

int KnotVector::span(double t) const {
  const auto first = knots_.begin() + degree_;
  const auto last = knots_.end() - degree_ - 1;
  if (!(t < knots_.back())) {
    // The last non-empty span ends with the last knot.
    return static_cast<int>(std::lower_bound(first, last, knots_.back()) - knots_.begin()) - 1;
  }
  if (!(t > knots_.front())) t = knots_.front();
  return static_cast<int>(std::upper_bound(first, last, t) - knots_.begin()) - 1;
}

Basis KnotVector::basis(double t, int derivatives) const {
  t = std::clamp(t, start(), end());
  return basis_in_span(t, span(t), derivatives);
}

Basis KnotVector::basis_in_span(double t, int span, int derivatives) const {
  assert(derivatives >= 0 && derivatives <= kMaxDerivative);
  Basis result;
  result.first = span - degree_;
  const double* knot = knots_.data() + span;
  switch (degree_) {
    case 1:
      fill<1>(knot, t, derivatives, result);
      break;
    case 2:
      fill<2>(knot, t, derivatives, result);
      break;
    case 3:
      fill<3>(knot, t, derivatives, result);
      break;
    case 4:
      fill<4>(knot, t, derivatives, result);
      break;
    default:
      fill<5>(knot, t, derivatives, result);
  }
  return result;
}

std::vector<int> KnotVector::nonempty_spans() const {
  std::vector<int> spans;
  for (int i = degree_; i < control_points(); ++i)
    if (knots_[static_cast<std::size_t>(i)] < knots_[static_cast<std::size_t>(i) + 1]) spans.push_back(i);
  return spans;
}

}  // namespace tendril
