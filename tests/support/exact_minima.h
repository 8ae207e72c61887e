#pragma once

#include <tendril/curve/bspline.h>

#include <algorithm>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

/// Critical points of the distance from a point to a B-spline, in exact arithmetic: the oracle that dense
/// sampling is too weak to be. Doubles are rationals; the curve's Bezier pieces come exactly out of its
/// knots, and half the derivative of the squared distance is a polynomial with integer Bernstein
/// coefficients, whose roots are isolated by Descartes' rule and halving. Shares no arithmetic with the
/// search it judges.
namespace tendril::test {

struct Critical {
  double t;            ///< in the middle of an interval of 2^-54 of a span
  double span;         ///< length of that span
  bool minimum, zone;  ///< zone: 2^-40 of a span holds more than one root, or the polynomial vanishes
  double low, high;    ///< of the interval
  int order = 1;       ///< of the root, where it is a multiple one at a joint
};

class ExactMinima {
 public:
  explicit ExactMinima(const BSpline& curve) : curve_(curve) {
    for (const int span : curve.knots().nonempty_spans()) pieces_.push_back(piece(span));
  }

  /// All critical points in ascending order, ends of the domain included when they are minima. A piece
  /// farther from p than `cut` is one entry, no minimum.
  std::vector<Critical> critical(const Vec3& p, double cut) {
    out_.clear();
    sign_ = -1;
    trailing_ = 0;
    for (const Piece& piece : pieces_) {
      if (beyond(piece, p, cut)) {
        turn(1, piece.begin, piece.end - piece.begin);
        if (!out_.empty() && out_.back().t == piece.begin && out_.back().minimum) far_minimum(piece, p, cut);
        out_.push_back({piece.begin, piece.end - piece.begin, false, false, piece.begin, piece.end});
        sign_ = -1;
        far_ = true;
      } else {
        std::vector<Integer> g = slope(piece, p);
        scan(std::move(g), piece, 0.0, 1.0, 0);
      }
    }
    turn(1, pieces_.back().end, pieces_.back().end - pieces_.back().begin);
    return out_;
  }

 private:
  using Integer = boost::multiprecision::mpz_int;
  using Rational = boost::multiprecision::mpq_rational;

  struct Piece {
    double begin, end;
    std::vector<std::array<Integer, 3>> points;  ///< times `scale`
    Integer scale;
    std::vector<Vec3> rounded;
  };

  Piece piece(int span) const {
    const auto k = static_cast<std::size_t>(span), degree = static_cast<std::size_t>(curve_.degree());
    const auto knots = curve_.knots().knots();
    Piece result{knots[k], knots[k + 1], {}, 1, {}};
    std::vector<std::array<Rational, 3>> points;
    for (std::size_t j = 0; j <= degree; ++j) {
      std::vector<std::array<Rational, 3>> d;
      for (std::size_t i = 0; i <= degree; ++i) {
        const Vec3& u = curve_.control_points()[k - degree + i];
        d.push_back({Rational(u.x()), Rational(u.y()), Rational(u.z())});
      }
      for (std::size_t r = 1; r <= degree; ++r)
        for (std::size_t i = degree; i >= r; --i) {
          const Rational low(knots[k - degree + i]), high(knots[k + 1 + i - r]);
          const Rational share = (Rational(r <= j ? knots[k + 1] : knots[k]) - low) / (high - low);
          for (std::size_t c = 0; c < 3; ++c) d[i][c] = d[i - 1][c] + share * (d[i][c] - d[i - 1][c]);
        }
      points.push_back(d[degree]);
      for (const Rational& x : d[degree]) result.scale = lcm(result.scale, denominator(x));
    }
    for (const auto& u : points) {
      result.rounded.emplace_back(u[0].convert_to<double>(), u[1].convert_to<double>(),
                                  u[2].convert_to<double>());
      auto& whole = result.points.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) whole[c] = numerator(u[c]) * (result.scale / denominator(u[c]));
    }
    return result;
  }

  static double choose(int n, int k) {
    double b = 1.0;
    for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
    return b;
  }

  /// Proven by the convex hull of the squared distance's coefficients, with a margin far above rounding.
  bool beyond(const Piece& piece, const Vec3& p, double cut) const {
    const int degree = curve_.degree();
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (int k = 0; k <= 2 * degree; ++k) {
      double d = 0.0;
      for (int i = std::max(0, k - degree); i <= std::min(k, degree); ++i)
        d += choose(degree, i) * choose(degree, k - i) / choose(2 * degree, k) *
             (piece.rounded[static_cast<std::size_t>(i)] - p)
                 .dot(piece.rounded[static_cast<std::size_t>(k - i)] - p);
      least = std::min(least, d);
      most = std::max(most, std::abs(d));
    }
    return least - 1e-10 * most > cut * cut;
  }

  std::vector<Integer> slope(const Piece& piece, const Vec3& p) const {
    const auto degree = static_cast<std::size_t>(curve_.degree());
    Integer unit = 1;
    std::array<Rational, 3> at{Rational(p.x()), Rational(p.y()), Rational(p.z())};
    for (const Rational& x : at) unit = lcm(unit, denominator(x));
    std::vector<std::array<Integer, 3>> r(degree + 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const Integer shift = numerator(at[c]) * (unit / denominator(at[c])) * piece.scale;
      for (std::size_t i = 0; i <= degree; ++i) r[i][c] = piece.points[i][c] * unit - shift;
    }
    const int n = 2 * static_cast<int>(degree) - 1;
    Integer common = 1;
    for (int k = 0; k <= n; ++k) common = lcm(common, Integer(choose(n, k)));
    std::vector<Integer> g(2 * degree, Integer(0));
    for (std::size_t i = 0; i <= degree; ++i)
      for (std::size_t j = 0; j < degree; ++j) {
        const auto a = static_cast<int>(i), b = static_cast<int>(j);
        const Integer weight =
            Integer(choose(n + 1 - static_cast<int>(degree), a) * choose(static_cast<int>(degree) - 1, b)) *
            (common / Integer(choose(n, a + b)));
        for (std::size_t c = 0; c < 3; ++c) g[i + j] += weight * r[i][c] * (r[j + 1][c] - r[j][c]);
      }
    return g;
  }

  static int variations(const std::vector<Integer>& g) {
    int count = 0, before = 0;
    for (const Integer& x : g) {
      const int now = x.sign();
      if (now != 0 && before != 0 && now != before) ++count;
      if (now != 0) before = now;
    }
    return count;
  }
  static int first_sign(const std::vector<Integer>& g) {
    for (const Integer& x : g)
      if (x.sign() != 0) return x.sign();
    return 0;
  }

  template <class It>
  static int zeros(It at, It end) {
    int count = 0;
    for (; at != end && at->is_zero(); ++at) ++count;
    return count;
  }

  void scan(std::vector<Integer> g, const Piece& piece, double low, double high, int depth) {
    const int changes = variations(g);
    const double width = piece.end - piece.begin;
    const double begin = piece.begin + low * width, end = piece.begin + high * width;
    if (first_sign(g) == 0) return zone(begin, end, width);
    if (changes == 0) {
      const int order = std::max(zeros(g.begin(), g.end()), trailing_);
      trailing_ = zeros(g.rbegin(), g.rend());
      return turn(first_sign(g), begin, width, order);
    }
    trailing_ = 0;
    if (depth >= 40 && changes > 1) return zone(begin, end, width);
    if (depth == 54) {
      turn(first_sign(g), begin, width);
      return turn(-first_sign(g), 0.5 * (begin + end), width);
    }
    std::vector<Integer> right = g;
    const std::size_t n = g.size() - 1;
    for (std::size_t m = n; m > 0; --m) {
      g[n - m] = right[0] << static_cast<unsigned>(m);
      for (std::size_t i = 0; i < m; ++i) right[i] += right[i + 1];
    }
    // After n rounds right[i] holds the right half's coefficient times 2^(n - i).
    for (std::size_t i = 0; i <= n; ++i) right[i] <<= static_cast<unsigned>(i);
    g[n] = right[0];
    const double middle = 0.5 * (low + high);
    scan(std::move(g), piece, low, middle, depth + 1);
    scan(std::move(right), piece, middle, high, depth + 1);
  }

  void zone(double low, double high, double width) {
    if (!out_.empty() && out_.back().zone && out_.back().high == low) {
      out_.back().high = high;
    } else {
      out_.push_back({0.5 * (low + high), width, false, true, low, high});
    }
    sign_ = 0;
  }

  /// From t on the distance falls or rises.
  void turn(int sign, double t, double width, int order = 1) {
    if (sign_ != 0 && sign != sign_ && !(far_ && sign > 0))
      out_.push_back({t, width, sign > 0, false, t, t, std::max(order, 1)});
    far_ = false;
    sign_ = sign;
  }
  void far_minimum(const Piece& piece, const Vec3& p, double cut) {
    if ((piece.rounded.front() - p).norm() > cut) out_.pop_back();
  }

  const BSpline& curve_;
  std::vector<Piece> pieces_;
  std::vector<Critical> out_;
  int sign_ = -1, trailing_ = 0;
  bool far_ = false;
};

}  // namespace tendril::test
