#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

/// Polynomials on [0, 1] by their Bernstein coefficients.
namespace tendril::collision {

/// The weight with which coefficient i of degree m and coefficient j of degree n add to coefficient i + j of
/// the product: C(m, i) C(n, j) / C(m + n, i + j).
constexpr double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 0; i < k; ++i) value = value * (n - i) / (i + 1);
  return value;
}

template <int M, int N>
constexpr std::array<std::array<double, N + 1>, M + 1> make_product_weights() {
  std::array<std::array<double, N + 1>, M + 1> weights{};
  for (int i = 0; i <= M; ++i)
    for (int j = 0; j <= N; ++j) weights[i][j] = binomial(M, i) * binomial(N, j) / binomial(M + N, i + j);
  return weights;
}

template <int M, int N>
inline constexpr auto product_weights = make_product_weights<M, N>();

/// The most coefficients that the functions below take.
constexpr std::size_t most_coefficients = 10;

/// A polynomial for many values: coefficients times binomials, for Horner's rule in both s and 1 - s.
class HornerForm {
 public:
  explicit HornerForm(std::span<const double> coefficients) : degree_(coefficients.size() - 1) {
    double binomial = 1.0;
    for (std::size_t i = 0; i <= degree_; ++i) {
      c_[i] = binomial * coefficients[i];
      binomial = binomial * static_cast<double>(degree_ - i) / static_cast<double>(i + 1);
    }
  }
  double operator()(double s) const {
    double sum = c_[0], power = 1.0;
    for (std::size_t i = 1; i <= degree_; ++i) {
      power *= s;
      sum = sum * (1.0 - s) + power * c_[i];
    }
    return sum;
  }

 private:
  std::size_t degree_;
  std::array<double, most_coefficients> c_;
};

inline HornerForm slope_of(std::span<const double> c) {
  std::array<double, most_coefficients> slopes{};
  const std::size_t degree = c.size() - 1;
  for (std::size_t i = 0; i < degree; ++i) slopes[i] = static_cast<double>(degree) * (c[i + 1] - c[i]);
  return HornerForm({slopes.data(), degree});
}

/// A root of a polynomial with one root in [0, 1] and opposite signs at the ends, to about the rounding of
/// its values: steps of Newton's method, halving where one leaves the bracket.
inline double approximate_root(std::span<const double> c) {
  const HornerForm value(c), slope = slope_of(c);
  double low = 0.0;
  double high = 1.0;
  double s = c.front() / (c.front() - c.back());
  double last = 1.0;
  for (int step = 0; step < 60; ++step) {
    const double f = value(s);
    if (f == 0.0) return s;
    ((f < 0.0) == (c.front() < 0.0) ? low : high) = s;
    double next = s - f / slope(s);
    const bool halved = !(next > low && next < high);
    if (halved) next = 0.5 * (low + high);
    const double moved = std::abs(next - s);
    s = next;
    // Among roundings steps no longer shrink.
    if (moved < 0x1p-50 || (!halved && moved < 0x1p-20 && moved > 0.5 * last)) break;
    last = moved;
  }
  return s;
}

}  // namespace tendril::collision
