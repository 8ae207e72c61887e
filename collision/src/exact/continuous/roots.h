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

/// The roots of p, not zero, in [0, 1] in ascending order, each in a bracket of at most 2^-42, to `meets`
/// until it says true.
/// \return  whether it did; `first` is then that root. `free_until`: no root before it is wanted.
bool find_root(const Polynomial& p, double free_until, const std::function<bool(const Root&)>& meets,
               Root& first);

/// Sign of q at the root. Doubles first, then the integers on the bracket, then common divisors.
int sign_at(const Polynomial& q, Root root);

}  // namespace tendril::exact
