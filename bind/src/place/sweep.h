#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "base/plain_vector.h"
#include "records.h"
#include "spans.h"
#include "vector_units.h"

/// Positions of points on posed curve-pairs, many at a time. Every operation is elementwise and none is
/// contracted, so a point has the same bits whatever vector unit it went through, and alone.
namespace tendril::bind {

using lanes::Triple;

/// Where the loops compute the frame themselves; all else is left to the second pass.
template <class T>
struct Limits;
template <>
struct Limits<double> {
  static constexpr double least_speed = 1e-8;  ///< |dc/ds| over the reach of the span's control points
  static constexpr double least_sine = 1e-8;   ///< |offset x dc/ds| over bounds of both
  static constexpr double smallest = 1e-140;   ///< length
  static constexpr double largest = 1e304;     ///< square of a length
};
template <>
struct Limits<float> {
  static constexpr double least_speed = 1e-2;
  static constexpr double least_sine = 1e-2;
  static constexpr double smallest = 1e-12;
  static constexpr double largest = 1e36;
};

/// As wide as the number, so that a loop over numbers handles it in the same lanes.
template <class T>
using Flag = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
template <class T>
TENDRIL_INLINE Triple<T> term(const std::array<std::array<T, 3>, kMostTerms>& c, int j) {
  const auto& row = c[static_cast<std::size_t>(j)];
  return {row[0], row[1], row[2]};
}

/// Curve, velocity by s, scaled offset, and the two directions before they are normalised: z is the velocity,
/// x = offset cross z.
template <class T>
struct Moving {
  Triple<T> origin, z, offset, x;
  T zz, xx;  ///< squares of the lengths of z and x
  T sound;  ///< 1, or 0 where the frame is not to be computed here; a number, which every vector unit selects
};

/// Horner's scheme for the value and the derivative together, from the coefficient J down. Unrolled by hand:
/// compilers vectorise no loop with a loop inside.
template <int J, class T>
TENDRIL_INLINE void go_down(const Piece<T>& piece, T s, Moving<T>& at) {
  if constexpr (J >= 0) {
    at.z = at.origin + s * at.z;
    at.origin = term(piece.c, J) + s * at.origin;
    at.offset = term(piece.d, J) + s * at.offset;
    go_down<J - 1>(piece, s, at);
  }
}

template <class T, int P>
TENDRIL_INLINE Moving<T> moving(const Piece<T>& piece, T s) {
  Moving<T> at;
  at.z = term(piece.c, P);
  at.origin = term(piece.c, P - 1) + s * at.z;
  at.offset = term(piece.d, P - 1) + s * term(piece.d, P);
  go_down<P - 2>(piece, s, at);
  at.x = cross(at.offset, at.z);
  at.zz = dot(at.z, at.z);
  at.xx = dot(at.x, at.x);
  at.sound = at.xx > piece.least_area ? T(1) : T(0);
  at.sound = at.zz > piece.least_speed ? at.sound : T(0);
  return at;
}

/// Reciprocal lengths of z and x with one division.
template <class T>
struct Lengths {
  T z, x, both;
};
template <class T>
TENDRIL_INLINE Lengths<T> inverse_lengths(const Moving<T>& at) {
  const T z = std::sqrt(at.zz), x = std::sqrt(at.xx);
  const T both = T(1) / (z * x);
  return {both * x, both * z, both};
}

template <class T>
struct Evaluated {
  Triple<T> point;
  Flag<T> fault;  ///< not 0: not to be used
};

/// c + u l_x + v l_y + w l_z, the last only where the record is off the normal plane.
template <class T, int P, bool Off>
TENDRIL_INLINE Evaluated<T> evaluate(const Piece<T>& piece, T s, T u, T v, T w) {
  const Moving<T> at = moving<T, P>(piece, s);
  const Lengths<T> inverse = inverse_lengths(at);
  const Triple<T> y = cross(at.z, at.x);
  Triple<T> point = (at.origin + (u * inverse.x) * at.x) + (v * inverse.both) * y;
  if constexpr (Off) point = point + (w * inverse.z) * at.z;
  return {point, std::bit_cast<Flag<T>>(T(1) - at.sound)};
}

/// Evaluates `count` points; true when one was left to the second pass.
/// \param off  false: w is 0 for all, and is not read
template <class T>
bool sweep(const Piece<T>& piece, bool off, const RecordsView<T>& records, const ColumnsView<T>& out,
           std::size_t count);

/// The same on a vector unit that the machine has.
template <class T>
bool sweep_on(VectorUnit unit, const Piece<T>& piece, bool off, const RecordsView<T>& records,
              const ColumnsView<T>& out, std::size_t count);

/// One point, the same bits.
template <class T>
Evaluated<T> evaluate_one(const Piece<T>& piece, bool off, const RecordsView<T>& record);

}  // namespace tendril::bind
