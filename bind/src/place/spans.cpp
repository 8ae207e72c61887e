#include "spans.h"

#include <cmath>
#include <limits>

#include "sweep.h"

namespace tendril::bind {
namespace {

using Polynomial = std::array<double, kMostTerms>;  // coefficients of 1, s, s^2, ...

/// to += (a + b s) p
void add_product(double a, double b, const Polynomial& p, Polynomial& to) {
  for (std::size_t j = 0; j < kMostTerms; ++j) to[j] += a * p[j];
  for (std::size_t j = 0; j + 1 < kMostTerms; ++j) to[j + 1] += b * p[j];
}

double largest(const std::array<Vec3, kMostTerms>& v, std::size_t count) {
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, v[i].cwiseAbs().maxCoeff());
  return most;
}

template <class T>
void combine(const Span& span, const std::array<Vec3, kMostTerms>& points,
             std::array<std::array<T, 3>, kMostTerms>& to, const Vec3& base) {
  for (std::size_t j = 0; j < span.terms(); ++j) {
    Vec3 sum = j == 0 ? base : Vec3(Vec3::Zero());
    for (std::size_t i = 0; i < span.terms(); ++i) sum += span.power[j][i] * points[i];
    for (std::size_t k = 0; k < 3; ++k) to[j][k] = static_cast<T>(sum[static_cast<Eigen::Index>(k)]);
  }
}

/// \param size  of the span's control points, relative to one of them
template <class T>
void limit(double size, Piece<T>& piece) {
  double fastest = 0.0;
  for (std::size_t j = 1; j < kMostTerms; ++j) {
    double most = 0.0;
    for (const T x : piece.c[j]) most = std::max(most, std::abs(static_cast<double>(x)));
    fastest += 2.0 * static_cast<double>(j) * most * std::ldexp(1.0, 1 - static_cast<int>(j));
  }
  const double speed = std::max(Limits<T>::least_speed * size, Limits<T>::smallest);
  const double area = std::max(Limits<T>::least_sine * fastest, Limits<T>::smallest);
  const bool too_fast = !(fastest * fastest < Limits<T>::largest);
  piece.least_speed = too_fast ? std::numeric_limits<T>::infinity() : static_cast<T>(speed * speed);
  piece.least_area = static_cast<T>(area * area);
}

}  // namespace

Span make_span(std::uint32_t pair, const KnotVector& knots, int index) {
  const auto at = static_cast<std::size_t>(index);
  const auto p = static_cast<std::size_t>(knots.degree());
  const double* knot = knots.knots().data() + at;
  Span span{
      pair, static_cast<std::uint32_t>(at - p), knots.degree(), 0.5 * (knot[0] + knot[1]), knot[1] - knot[0],
      {}};
  // The recurrence of Cox and de Boor on polynomials in s: functions[j] is N_{at - d + j, d}, and each of its
  // factors (right - t) / width, (t - left) / width is linear in s, as t = middle + length s.
  std::array<Polynomial, kMostTerms> functions{};
  functions[0][0] = 1.0;
  for (std::size_t d = 1; d <= p; ++d) {
    std::array<Polynomial, kMostTerms> raised{};
    for (std::size_t j = 0; j < d; ++j) {
      const double left = knot[static_cast<std::ptrdiff_t>(j + 1) - static_cast<std::ptrdiff_t>(d)];
      const double right = knot[j + 1];
      const double width = right - left;
      const double slope = span.length / width;
      add_product((right - span.middle) / width, -slope, functions[j], raised[j]);
      add_product((span.middle - left) / width, slope, functions[j], raised[j + 1]);
    }
    functions = raised;
  }
  for (std::size_t i = 0; i <= p; ++i)
    for (std::size_t j = 0; j <= p; ++j) span.power[j][i] = functions[i][j];
  return span;
}

template <class T>
Piece<T> pose(const Span& span, const CurvePair& posed) {
  const Points u = posed.primary().control_points();
  const Points v = posed.orientation().control_points();
  const Vec3 base = u[span.reference()];
  std::array<Vec3, kMostTerms> from_base, offset;
  from_base.fill(Vec3::Zero());
  offset.fill(Vec3::Zero());
  for (std::size_t i = 0; i < span.terms(); ++i) {
    from_base[i] = u[span.first + i] - base;
    offset[i] = v[span.first + i] - u[span.first + i];
  }
  Piece<T> piece;
  piece.degree = span.degree;
  const double width = largest(offset, span.terms());
  piece.scale = width > 0.0 ? std::ldexp(1.0, -std::ilogb(width)) : 0.0;
  for (std::size_t i = 0; i < span.terms(); ++i) offset[i] *= piece.scale;
  combine(span, from_base, piece.c, base);
  combine(span, offset, piece.d, Vec3::Zero());
  limit(largest(from_base, span.terms()), piece);
  piece.turned = !posed.turn().empty();
  for (std::size_t j = 0; piece.turned && j < span.terms(); ++j)
    for (std::size_t i = 0; i < span.terms(); ++i)
      piece.turn[j] += span.power[j][i] * posed.turn()[span.first + i];
  return piece;
}

/// u l_x + v l_y of the turned frame, l_x = cos x + sin y and l_y = cos y - sin x, in terms of x and y.
template <class T>
RecordsView<T> turn_records(const Piece<T>& piece, const RecordsView<T>& records, std::size_t count, T* u,
                            T* v) {
  for (std::size_t i = 0; i < count; ++i) {
    const Turn turn = turn_at(piece, static_cast<double>(records.s[i]));
    const T c = static_cast<T>(turn.cosine), s = static_cast<T>(turn.sine);
    u[i] = c * records.u[i] - s * records.v[i];
    v[i] = s * records.u[i] + c * records.v[i];
  }
  return {records.s, u, v, records.w};
}

template Piece<double> pose(const Span&, const CurvePair&);
template Piece<float> pose(const Span&, const CurvePair&);
template RecordsView<double> turn_records(const Piece<double>&, const RecordsView<double>&, std::size_t,
                                          double*, double*);
template RecordsView<float> turn_records(const Piece<float>&, const RecordsView<float>&, std::size_t, float*,
                                         float*);

}  // namespace tendril::bind
