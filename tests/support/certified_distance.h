#pragma once

#include <tendril/curve/bspline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

/// Proves that no point of a B-spline is nearer to a point than a given distance, or finds one that is: the
/// Bernstein coefficients of the squared distance bound it from below on each piece of the curve, which is
/// halved until they decide. In extended precision (64 bits at least), on Bezier points from 113 bits: its
/// rounding is some 1e-18 of the size, a millionth of the margins it is asked about. Shares no arithmetic
/// with the search it judges.
namespace tendril::test {

class CertifiedDistance {
 public:
  enum Answer { none_nearer, nearer, undecided };

  explicit CertifiedDistance(const BSpline& curve) : degree_(static_cast<std::size_t>(curve.degree())) {
    for (const int span : curve.knots().nonempty_spans()) pieces_.push_back(piece(curve, span));
  }

  Answer ask(const Vec3& p, double distance) const {
    if (!(distance > 0.0)) return none_nearer;
    Answer worst = none_nearer;
    for (const Polygon& piece : pieces_) {
      Polygon relative = piece;
      for (std::size_t i = 0; i <= degree_; ++i)
        for (std::size_t c = 0; c < 3; ++c)
          relative[i][c] -= static_cast<long double>(p[static_cast<Eigen::Index>(c)]);
      worst = std::max(
          worst, ask(relative, static_cast<long double>(distance) * static_cast<long double>(distance), 0),
          [](Answer a, Answer b) { return b == nearer || (a == none_nearer && b == undecided); });
      if (worst == nearer) break;
    }
    return worst;
  }

 private:
  static constexpr int kMostHalvings = 60;
  using Point = std::array<long double, 3>;
  using Polygon = std::array<Point, kMaxDegree + 1>;

  static long double choose(std::size_t n, std::size_t k) {
    long double b = 1.0L;
    for (std::size_t i = 1; i <= k; ++i)
      b = b * static_cast<long double>(n - k + i) / static_cast<long double>(i);
    return b;
  }

  Polygon piece(const BSpline& curve, int span) const {
    using Wide = __float128;
    const auto k = static_cast<std::size_t>(span);
    const auto knots = curve.knots().knots();
    Polygon out{};
    for (std::size_t j = 0; j <= degree_; ++j)
      for (std::size_t c = 0; c < 3; ++c) {
        std::array<Wide, kMaxDegree + 1> d{};
        for (std::size_t i = 0; i <= degree_; ++i)
          d[i] = static_cast<Wide>(curve.control_points()[k - degree_ + i][static_cast<Eigen::Index>(c)]);
        for (std::size_t r = 1; r <= degree_; ++r)
          for (std::size_t i = degree_; i >= r; --i) {
            const auto low = static_cast<Wide>(knots[k - degree_ + i]);
            const auto high = static_cast<Wide>(knots[k + 1 + i - r]);
            const Wide share = (static_cast<Wide>(r <= j ? knots[k + 1] : knots[k]) - low) / (high - low);
            d[i] = d[i - 1] + share * (d[i] - d[i - 1]);
          }
        out[j][c] = static_cast<long double>(d[degree_]);
      }
    return out;
  }

  static long double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

  /// Least Bernstein coefficient of the squared distance.
  long double least(const Polygon& r) const {
    long double least = dot(r[0], r[0]);
    for (std::size_t k = 1; k <= 2 * degree_; ++k) {
      long double d = 0.0L;
      for (std::size_t i = k > degree_ ? k - degree_ : 0; i <= std::min(k, degree_); ++i)
        d += weights_[degree_][i][k - i] * dot(r[i], r[k - i]);
      least = std::min(least, d);
    }
    return least;
  }

  Answer ask(Polygon& left, long double square, int depth) const {
    if (least(left) >= square) return none_nearer;
    if (dot(left[0], left[0]) < square || dot(left[degree_], left[degree_]) < square) return nearer;
    if (depth == kMostHalvings) return undecided;
    Polygon right = left;
    for (std::size_t n = degree_; n > 0; --n) {
      left[degree_ - n] = right[0];
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = 0; c < 3; ++c) right[i][c] = 0.5L * (right[i][c] + right[i + 1][c]);
    }
    left[degree_] = right[0];
    const Answer first = ask(left, square, depth + 1);
    if (first == nearer) return nearer;
    const Answer second = ask(right, square, depth + 1);
    return second == none_nearer ? first : second;
  }

  /// C(n, i) C(n, j) / C(2 n, i + j)
  using Weights = std::array<std::array<long double, kMaxDegree + 1>, kMaxDegree + 1>;
  static std::array<Weights, kMaxDegree + 1> make_weights() {
    std::array<Weights, kMaxDegree + 1> w{};
    for (std::size_t n = 1; n <= kMaxDegree; ++n)
      for (std::size_t i = 0; i <= n; ++i)
        for (std::size_t j = 0; j <= n; ++j) w[n][i][j] = choose(n, i) * choose(n, j) / choose(2 * n, i + j);
    return w;
  }

  std::size_t degree_;
  std::vector<Polygon> pieces_;
  std::array<Weights, kMaxDegree + 1> weights_ = make_weights();
};

}  // namespace tendril::test
