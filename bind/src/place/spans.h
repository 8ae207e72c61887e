#pragma once

#include <tendril/curve/curve_pair.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "records.h"

namespace tendril::bind {

inline constexpr std::size_t kMostTerms = kMaxDegree + 1;

/// A non-empty span of a curve-pair's knots, and how its control points become polynomials in
/// s = (t - middle) / length, |s| <= 1/2.
struct Span {
  std::uint32_t pair;
  std::uint32_t first;  ///< control point
  int degree;
  double middle, length;
  /// Row j: the weights of the degree + 1 control points in the coefficient of s^j.
  std::array<std::array<double, kMostTerms>, kMostTerms> power;

  double local(double t) const { return (t - middle) / length; }  ///< s
  std::size_t terms() const { return static_cast<std::size_t>(degree) + 1; }
  /// The control point that the others are taken relative to, so that coefficients far from the origin keep
  /// the digits of their differences.
  std::size_t reference() const { return first + terms() / 2; }
};

/// \param span  index of its first knot, as KnotVector::span gives it
Span make_span(std::uint32_t pair, const KnotVector& knots, int span);

/// A span of a posed curve-pair as the loops read it: c(s) = sum_j s^j c_j, and the offset to the orientation
/// curve, times a power of 2 that makes the largest of its control points about 1.
template <class T>
struct Piece {
  int degree = 1;
  std::array<std::array<T, 3>, kMostTerms> c{}, d{};
  double scale = 0.0;  ///< that power of 2
  /// Squares of |dc/ds| and of |offset x dc/ds|; what is not above them the loops leave to the second pass.
  T least_speed = T(0), least_area = T(0);
  bool turned = false;  ///< whether the frame is turned, by sum_j s^j turn_j [rad]
  std::array<double, kMostTerms> turn{};
};

template <class T>
Piece<T> pose(const Span& span, const CurvePair& posed);

/// By what a piece turns its frame at s.
struct Turn {
  double cosine, sine;
};
template <class T>
Turn turn_at(const Piece<T>& piece, double s) {
  if (!piece.turned) return {1.0, 0.0};
  double angle = 0.0;
  for (std::size_t j = kMostTerms; j-- > 0;) angle = piece.turn[j] + s * angle;
  return {std::cos(angle), std::sin(angle)};
}

/// The records of a turned piece as they are in its frames before the turn: s and w as they were, u and v at
/// the two places given. A point's are the same bits alone and among others.
template <class T>
RecordsView<T> turn_records(const Piece<T>& piece, const RecordsView<T>& records, std::size_t count, T* u,
                            T* v);

/// What is asked for of spans, made when it first is: few of many where little of a large mesh is wanted.
template <class Made, class Make>
class OnDemand {
 public:
  /// \param make  of a span's index
  OnDemand(std::size_t spans, Make make) : make_(std::move(make)), number_(spans, 0) { made_.reserve(spans); }

  Made& operator[](std::uint32_t span) {
    if (number_[span] == 0) {
      made_.push_back(make_(span));
      number_[span] = static_cast<std::uint32_t>(made_.size());
    }
    return made_[number_[span] - 1];
  }
  bool has(std::uint32_t span) const { return number_[span] != 0; }

 private:
  Make make_;
  std::vector<std::uint32_t> number_;  ///< per span: one more than its place among the made, or 0
  std::vector<Made> made_;             ///< with room for all, so that they stay where they are
};
template <class T>
auto on_demand(const std::vector<Span>& spans, std::span<const CurvePair> posed) {
  const auto make = [&spans, posed](std::uint32_t span) {
    return pose<T>(spans[span], posed[spans[span].pair]);
  };
  return OnDemand<Piece<T>, decltype(make)>(spans.size(), make);
}

template <class T>
std::vector<Piece<T>> pose(const std::vector<Span>& spans, std::span<const CurvePair> posed) {
  std::vector<Piece<T>> pieces;
  pieces.reserve(spans.size());
  for (const Span& span : spans) pieces.push_back(pose<T>(span, posed[span.pair]));
  return pieces;
}

}  // namespace tendril::bind
