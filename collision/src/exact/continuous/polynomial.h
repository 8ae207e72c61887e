#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

namespace tendril::exact {

/// Integers of any size; up to 512 bits without the heap.
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked,
                                           std::allocator<boost::multiprecision::limb_type>>,
    boost::multiprecision::et_off>;

/// numerator / 2^exponent
struct Dyadic {
  Integer numerator;
  unsigned exponent;
};

/// p(t) = sum_i c_i t^i (1 - t)^(degree - i): Bernstein coefficients times their binomials, so that a product
/// is a plain convolution and all stay integers. In x = t / (1 - t) the c_i are the usual coefficients of a
/// polynomial, which is how remainders are taken.
struct Polynomial {
  int degree = 0;
  std::array<Integer, 10> c;  ///< up to degree 9
};

bool is_zero(const Polynomial& p);
bool proportional(const Polynomial& p, const Polynomial& q);  ///< whether one is the other times a constant
Polynomial operator+(const Polynomial& p, const Polynomial& q);  ///< of one degree
Polynomial operator-(const Polynomial& p, const Polynomial& q);  ///< of one degree
Polynomial operator-(const Polynomial& p);
Polynomial operator*(const Polynomial& p, const Polynomial& q);

int sign_at(const Polynomial& p, const Dyadic& t);

/// p on [low, high] as a polynomial on [0, 1], times a positive number.
Polynomial restricted(const Polynomial& p, const Dyadic& low, const Dyadic& high);
Polynomial first_half(const Polynomial& p);
Polynomial second_half(const Polynomial& p);

/// Changes of sign among the coefficients: the number of roots in the open interval (0, 1), with
/// multiplicity, or more by an even number (Descartes' rule in Bernstein form).
int sign_changes(const Polynomial& p);
/// Sign just after 0 and just before 1; 0 only for the zero polynomial.
int first_sign(const Polynomial& p);
int last_sign(const Polynomial& p);

/// Plain Bernstein coefficients in doubles, up to a positive factor, each off by at most 2^-50 of the
/// largest.
std::array<double, 10> in_doubles(const Polynomial& p);

/// Without the factors t and 1 - t.
Polynomial without_ends(const Polynomial& p);
/// Greatest common divisor up to a constant factor, of polynomials without roots at 0 and 1.
Polynomial common_divisor(const Polynomial& p, const Polynomial& q);
/// True only if they have none: no common divisor modulo a prime, where the degree of p stays.
bool surely_coprime(const Polynomial& p, const Polynomial& q);
Polynomial derivative(const Polynomial& p);  ///< in x
/// p / q up to a constant factor, where q divides p.
Polynomial quotient(const Polynomial& p, const Polynomial& q);

}  // namespace tendril::exact
