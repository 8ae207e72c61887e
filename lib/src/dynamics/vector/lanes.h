#pragma once

#include <cmath>

#include "base/plain_vector.h"

/// What the vector loops of this module compute with. Those with fused multiply-adds use them, so that the
/// last bits can differ between machines, and between the same rod alone and among others (a loop's last few
/// numbers are no vector, and fuse in another order). The same scene gives the same bits on one machine,
/// wherever its numbers lie in memory.
///
/// Elementary functions without branches, so that loops over them vectorise. Each is its leading term and a
/// small correction by a polynomial in z = x^2: x + x z P(z) for the odd ones, 1 + w P(w) for the even ones.
/// P is fitted at the Chebyshev nodes of the interval given. The error given is the largest over it of the
/// whole function against its power series in 50 digits, with the coefficients as the doubles they are:
/// always below 2^-54, a quarter of an ulp of 1. Rounding in P enters with the size of the correction, so
/// that the last sum decides: about an ulp in all.
namespace tendril::lanes {

/// Nearest whole number, for |x| < 2^51 and rounding to nearest.
TENDRIL_INLINE double nearest_whole(double x) {
  constexpr double kBig = 0x1.8p52;
  return (x + kBig) - kBig;
}

/// c0 + c1 z + c2 z^2 + ..., from the last on.
template <class T>
TENDRIL_INLINE T horner(const T& z, double first, double last) {
  return z * last + first;
}
template <class T, class... Rest>
TENDRIL_INLINE T horner(const T& z, double first, double second, Rest... rest) {
  return horner(z, second, rest...) * z + first;
}

/// (atan(t) - t) / t for z = t^2 up to (sqrt 2 - 1)^2: Chebyshev fit, error 8e-18.
TENDRIL_INLINE double atan_series(double z) {
  const double p = horner(z, -3.33333333333333315e-01, 1.99999999999955158e-01, -1.42857142846656821e-01,
                          1.11111110151870182e-01, -9.09090457530648960e-02, 7.69218312537689186e-02,
                          -6.66451052550893625e-02, 5.85814090486632827e-02, -5.08540783458948445e-02,
                          3.92304477847930932e-02, -1.91754047111049354e-02);
  return p * z;
}

/// Argument of atan, brought to |t| <= tan(pi / 8) = sqrt 2 - 1: for larger a, atan(a) = pi / 4 +
/// atan((a - 1) / (a + 1)), which maps [sqrt 2 - 1, 1] onto [1 - sqrt 2, 0].
struct Ratio {
  double up, down, offset;  ///< atan(small / large) = offset + atan(up / down), |up / down| <= tan(pi / 8)
};

/// \param large  > 0
TENDRIL_INLINE Ratio reduce(double small, double large) {
  const bool far = small > 0.41421356237309503 * large;
  return {far ? small - large : small, far ? small + large : large, far ? 0.78539816339744831 : 0.0};
}

/// atan2 to about an ulp, without branches; atan2(0, 0) = 0.
TENDRIL_INLINE double angle(double y, double x) {
  const double ay = std::fabs(y);
  const double ax = std::fabs(x);
  const double large = larger(ax, ay);
  const Ratio r = reduce(smaller(ax, ay), large > 0.0 ? large : 1.0);
  const double t = r.up / r.down;
  double a = r.offset + (t + t * atan_series(t * t));
  a = ay > ax ? 1.57079632679489656 - a : a;
  a = x < 0.0 ? 3.14159265358979312 - a : a;
  return std::copysign(a, y);
}

/// Up to which square of a sine the series below hold: angles to 10.2 degrees.
constexpr double kNearSquare = 0.03125;

/// (asin(s) / s - 1) / w for w = s^2 up to kNearSquare: Chebyshev fit, error of the ratio 2e-18.
template <class T>
TENDRIL_INLINE T asin_series(const T& w) {
  return horner(w, 1.66666666666666713e-01, 7.49999999998587352e-02, 4.46428572150876571e-02,
                3.03819306143614416e-02, 2.23734174402499056e-02, 1.72942214348841203e-02,
                1.53025466205305438e-02);
}
TENDRIL_INLINE double asin_ratio(double w) {
  return 1.0 + asin_series(w) * w;
}

/// asin(s) / s up to kWideSquare, 30 degrees: error 3e-18.
constexpr double kWideSquare = 0.25;
TENDRIL_INLINE double wide_asin_ratio(double w) {
  const double p = horner(w, 1.66666666666666657e-01, 7.49999999999999140e-02, 4.46428571428834006e-02,
                          3.03819444413638076e-02, 2.23721592796799797e-02, 1.73527574778197871e-02,
                          1.39650099320536066e-02, 1.15490866129874248e-02, 9.79275132020199571e-03,
                          8.13582992550165689e-03, 8.79500607648842948e-03, 3.80853033290725978e-04,
                          2.25535636382029822e-02, -2.40205449185546052e-02, 3.07187689951910967e-02);
  return 1.0 + p * w;
}

/// (1 / sqrt(1 - w) - 1) / w for w up to kNearSquare: Chebyshev fit, error of the inverse cosine 3e-17.
template <class T>
TENDRIL_INLINE T inverse_cosine_series(const T& w) {
  return horner(w, 5.00000000000000777e-01, 3.74999999997571776e-01, 3.12500001241328595e-01,
                2.73437262397397518e-01, 2.46115356384987716e-01, 2.24581757055933529e-01,
                2.32368976156264700e-01);
}

/// What a direction at the angle phi from an axis, with components x, y across it, needs for the turn vector
/// (x, y) phi / sin(phi): the ratio r = phi / s of angle and sine, and how it rises, dr = rise (x dx + y dy)
/// with rise = (1 / cos(phi) - r) / s^2.
template <class T>
struct ArcOf {
  T ratio, rise;
};
using Arc = ArcOf<double>;
/// \param w  s^2 up to kNearSquare
template <class T>
TENDRIL_INLINE ArcOf<T> near_arc(const T& w) {
  const T p = asin_series(w);
  return {1.0 + p * w, inverse_cosine_series(w) - p};
}
/// Up to a quarter turn, where the ratio rises without bound: a cosine of 0 is taken for 1.
/// \param z  the cosine
TENDRIL_INLINE Arc arc(double w, double s, double z) {
  const bool near = w <= kNearSquare;
  const Arc small = near_arc(near ? w : kNearSquare);
  const double ratio = angle(s, z) / (near ? 1.0 : s);
  const double rise = (1.0 / (z > 0.0 ? z : 1.0) - ratio) / (near ? 1.0 : w);
  return {near ? small.ratio : ratio, near ? small.rise : rise};
}

/// asin(s) / (s sqrt(1 - w)), both at once: the slope of asin(s)^2 / 2 over s. Chebyshev fit, error 4e-17.
TENDRIL_INLINE double asin_slope(double w) {
  const double p = horner(w, 6.66666666666667851e-01, 5.33333333329628401e-01, 4.57142859036851090e-01,
                          4.06348843823369055e-01, 3.69441335141163008e-01, 3.39460268031447132e-01,
                          3.53190131570816801e-01);
  return 1.0 + p * w;
}

struct SineCosine {
  double sine, cosine;
};
/// To about an ulp for |x| up to some thousands: the nearest multiple n pi / 2 is taken off in two parts, of
/// which the first has 33 bits, so that its product with |n| < 2^20 and the first difference are exact.
TENDRIL_INLINE SineCosine sine_cosine(double x) {
  const double n = nearest_whole(x * 0.63661977236758138);
  const double r = ((x - n * 1.57079632673412561417e+00) - n * 6.07710050650619224932e-11);
  const double z = r * r;
  const double s = horner(z, -1.66666666666666657e-01, 8.33333333333333148e-03, -1.98412698412650626e-04,
                          2.75573192193373122e-06, -2.50521062318028370e-08, 1.60585315167977585e-10,
                          -7.58669109419795817e-13);
  const double sine = r + r * (s * z);
  const double c = horner(z, 4.16666666666666644e-02, -1.38888888888888873e-03, 2.48015873015846453e-05,
                          -2.75573192214017919e-07, 2.08767557907219548e-09, -1.14704608307942149e-11,
                          4.74586855302733013e-14);
  const double cosine = 1.0 - (0.5 * z - (z * z) * c);
  // n modulo 4, in (-2 .. 2): odd ones swap, 2 (and -2) turn both signs.
  const double quarter = n - 4.0 * nearest_whole(0.25 * n);
  const bool odd = quarter == 1.0 || quarter == -1.0;
  const double s1 = odd ? cosine : sine;
  const double c1 = odd ? sine : cosine;
  const bool half = quarter == 2.0 || quarter == -2.0;
  return {half || quarter == -1.0 ? -s1 : s1, half || quarter == 1.0 ? -c1 : c1};
}

/// The same for |x| up to kNearTurn: Chebyshev fits, error 1e-18.
constexpr double kNearTurn = 0.25;
TENDRIL_INLINE SineCosine near_sine_cosine(double x) {
  const double z = x * x;
  const double s = horner(z, -1.66666666666666657e-01, 8.33333333333309383e-03, -1.98412698382089867e-04,
                          2.75573055104068607e-06, -2.50270282610854804e-08);
  const double c = horner(z, 4.16666666666664146e-02, -1.38888888876155330e-03, 2.48015771141572259e-05,
                          -2.75312355960495884e-07);
  return {x + x * (s * z), 1.0 - (0.5 * z - (z * z) * c)};
}

/// d less the nearest multiple of 2 pi.
TENDRIL_INLINE double less_turns(double d) {
  const double n = nearest_whole(d * 0.15915494309189535);
  return (d - n * 6.28318530693650245668e+00) - n * 2.43084020260247690e-10;
}

}  // namespace tendril::lanes
