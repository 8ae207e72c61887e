#include "exact/fallback.h"

#include "exact/polynomials.h"

// CGAL would else test the rounding modes when the program starts.
#define CGAL_DISABLE_ROUNDING_MATH_CHECK
#include <CGAL/Mpzf.h>

#ifndef CGAL_HAS_MPZF
#error "tendril::exact needs CGAL's Mpzf: GMP with limbs of 64 bits"
#endif

namespace tendril::exact::fallback {

namespace {

/// A binary fraction of any length: sums and products do not round.
class Unrounded {
 public:
  explicit Unrounded(double x) : value_(x) {}

  friend Unrounded operator+(const Unrounded& a, const Unrounded& b) {
    return Unrounded(a.value_ + b.value_);
  }
  friend Unrounded operator-(const Unrounded& a, const Unrounded& b) {
    return Unrounded(a.value_ - b.value_);
  }
  friend Unrounded operator*(const Unrounded& a, const Unrounded& b) {
    return Unrounded(a.value_ * b.value_);
  }
  friend int sign(const Unrounded& x) { return static_cast<int>(x.value_.sign()); }

 private:
  explicit Unrounded(CGAL::Mpzf&& value) : value_(std::move(value)) {}
  CGAL::Mpzf value_;
};

}  // namespace

int side(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) {
  return sign(side_polynomial<Unrounded>(p, q, r, x));
}

int turn(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  return sign(turn_polynomial<Unrounded>(axis, a, b, c));
}

int compare_distance(Points a, Points b, double radius_a, double radius_b) {
  return exact::compare_distance<Unrounded>(a, b, radius_a, radius_b);
}

}  // namespace tendril::exact::fallback
