#include <tendril/base/error.h>
#include <tendril/curve/fit.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tendril {
namespace {

void check(int degree, Points rest) {
  if (degree < 1 || degree > kMaxDegree)
    throw InvalidInput("degree", std::to_string(degree), "1 to " + std::to_string(kMaxDegree));
  if (rest.size() <= static_cast<std::size_t>(degree))
    throw InvalidInput("points",
                       std::to_string(rest.size()) + " of them for degree " + std::to_string(degree),
                       "at least degree + 1");
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (!is_finite(rest[i]))
      throw InvalidInput("points[" + std::to_string(i) + "]", "not finite", "three finite numbers");
}

std::vector<double> by_steps(Points rest, double exponent) {
  std::vector<double> r(rest.size(), 0.0);
  for (std::size_t k = 1; k < rest.size(); ++k) {
    const double chord = (rest[k] - rest[k - 1]).stableNorm();
    if (!(chord > 0.0))
      throw InvalidInput("points[" + std::to_string(k) + "]", "the same as the point before it",
                         "distinct neighbours");
    r[k] = r[k - 1] + std::pow(chord, exponent);
  }
  const double total = r.back();
  for (double& value : r) value /= total;
  r.back() = 1.0;
  return r;
}

/// Parameter where basis function k of the knots is largest: its derivative changes sign once inside the
/// support.
double peak(const KnotVector& knots, int k) {
  if (k == 0) return knots.start();
  if (k + 1 == knots.control_points()) return knots.end();
  double low = knots.knots()[static_cast<std::size_t>(k)];
  double high = knots.knots()[static_cast<std::size_t>(k + knots.degree()) + 1];
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const Basis basis = knots.basis(middle, 1);
    const int j = k - basis.first;
    const bool inside = j >= 0 && j <= knots.degree();
    const double slope = inside ? basis.value[1][static_cast<std::size_t>(j)] : (j < 0 ? -1.0 : 1.0);
    (slope > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<double> parameters_for(int degree, Points rest, Parametrisation how) {
  check(degree, rest);
  switch (how) {
    case Parametrisation::chord_length:
      return by_steps(rest, 1.0);
    case Parametrisation::centripetal:
      return by_steps(rest, 0.5);
    case Parametrisation::uniform:
    case Parametrisation::universal:
      break;
  }
  const std::size_t n = rest.size() - 1;
  const bool universal = how == Parametrisation::universal;
  const KnotVector knots = KnotVector::uniform(degree, static_cast<int>(rest.size()));
  std::vector<double> r(n + 1);
  for (std::size_t k = 0; k <= n; ++k)
    r[k] = universal ? peak(knots, static_cast<int>(k)) : static_cast<double>(k) / static_cast<double>(n);
  return r;
}

KnotVector knots_for(int degree, const std::vector<double>& r, Parametrisation how) {
  if (how == Parametrisation::universal) return KnotVector::uniform(degree, static_cast<int>(r.size()));
  const std::size_t p = static_cast<std::size_t>(degree);
  const std::size_t n = r.size() - 1;
  std::vector<double> knots(p + 1, 0.0);
  for (std::size_t j = 1; j + p <= n; ++j) {
    double sum = 0.0;
    for (std::size_t i = j; i < j + p; ++i) sum += r[i];
    knots.push_back(sum / degree);
  }
  knots.insert(knots.end(), p + 1, 1.0);
  return KnotVector(degree, std::move(knots));
}

}  // namespace

Interpolator::Interpolator(int degree, Points rest, Parametrisation how)
    : parameters_(parameters_for(degree, rest, how)), knots_(knots_for(degree, parameters_, how)) {
  band_.assign(parameters_.size() * width(), 0.0);
  for (std::size_t row = 0; row < parameters_.size(); ++row) {
    const Basis basis = knots_.basis(parameters_[row]);
    for (std::size_t j = 0; j <= half(); ++j) {
      const double value = basis.value[0][j];
      if (value != 0.0) at(row, static_cast<std::size_t>(basis.first) + j) = value;
    }
  }
  factor();
}

/// Gaussian elimination without pivoting, within the band. The matrix N_j(r_i) of B-splines is totally
/// positive, and regular as the averaged knots put each r_i inside the support of its own function
/// (Schoenberg and Whitney) [de Boor 2001]. For such matrices the factors of every elimination are not
/// negative, so no entry grows, and the factors without pivoting are backward stable
/// [de Boor and Pinkus 1977]; exchanges of rows would only fill the band.
void Interpolator::factor() {
  const std::size_t n = parameters_.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t row = k + 1; row < std::min(n, k + half() + 1); ++row) {
      const double ratio = at(row, k) / at(k, k);
      at(row, k) = ratio;
      for (std::size_t column = k + 1; column < std::min(n, k + half() + 1); ++column)
        at(row, column) -= ratio * at(k, column);
    }
  }
}

std::vector<Vec3> Interpolator::solve(Points points) const {
  const std::size_t n = parameters_.size();
  if (points.size() != n)
    throw InvalidInput("points", std::to_string(points.size()) + " of them", std::to_string(n));
  std::vector<Vec3> u(points.begin(), points.end());
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t k = row - std::min(row, half()); k < row; ++k) u[row] -= at(row, k) * u[k];
  for (std::size_t row = n; row-- > 0;) {
    for (std::size_t column = row + 1; column < std::min(n, row + half() + 1); ++column)
      u[row] -= at(row, column) * u[column];
    u[row] /= at(row, row);
  }
  return u;
}

std::vector<Vec3> Interpolator::solve_transposed(Points forces) const {
  const std::size_t n = parameters_.size();
  if (forces.size() != n)
    throw InvalidInput("forces", std::to_string(forces.size()) + " of them", std::to_string(n));
  std::vector<Vec3> f(forces.begin(), forces.end());
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = row - std::min(row, half()); k < row; ++k) f[row] -= at(k, row) * f[k];
    f[row] /= at(row, row);
  }
  for (std::size_t row = n; row-- > 0;)
    for (std::size_t k = row + 1; k < std::min(n, row + half() + 1); ++k) f[row] -= at(k, row) * f[k];
  return f;
}

}  // namespace tendril
