#pragma once

#include <functional>

#include "polynomial.h"

namespace tendril::exact {

/// A root of p in [low, high]: the end itself where they are equal, else the only root of p in the open
/// interval, a simple one.
struct Root {
  const Polynomial* p = nullptr;
  Dyadic low, high;

  bool is_dyadic() const { return low.exponent == high.exponent && low.numerator == high.numerator; }
};

/// Which roots are wanted.
struct Wanted {
  /// Whether none between two times is.
  std::function<bool(double, double)> none_between;
  /// Whether this one is.
  std::function<bool(const Root&)> root;
};

/// The roots of p, not zero, behind 0 and up to 1 in ascending order, each in a bracket of at most 2^-42,
/// until one is wanted.
/// \return  whether one was; `first` is then that root.
bool find_root(const Polynomial& p, const Wanted& wanted, Root& first);

/// Sign of q at the root. Doubles first, then the integers on the bracket, then common divisors.
int sign_at(const Polynomial& q, Root root);

}  // namespace tendril::exact
