#include "roots.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "collision/continuous/bernstein.h"

namespace tendril::exact {
namespace {

/// Brackets are cut on multiples of 2^-grid, `reach` of them on each side of an approximate root.
constexpr unsigned grid = 46;
constexpr int reach = 7;
/// The depth at which a part that still seems to have several roots is asked for multiple ones.
constexpr unsigned suspicious = 10;

Dyadic between(const Dyadic& low, const Dyadic& high) {
  const unsigned e = std::max(low.exponent, high.exponent);
  return {(low.numerator << (e - low.exponent)) + (high.numerator << (e - high.exponent)), e + 1};
}

bool less(const Dyadic& a, const Dyadic& b) {
  const unsigned e = std::max(a.exponent, b.exponent);
  return (a.numerator << (e - a.exponent)) < (b.numerator << (e - b.exponent));
}

Polynomial on_bracket(const Polynomial& p, const Root& root) {
  return restricted(p, root.low, root.high);
}

/// A part of [0, 1] of width 2^-exponent and the polynomial there.
struct Part {
  Polynomial p;
  Dyadic low;

  Dyadic high() const { return {low.numerator + 1, low.exponent}; }
  Dyadic middle() const { return {low.numerator * 2 + 1, low.exponent + 1}; }
};

/// A part's only root, about, as a share of the part.
double approximate_root_of(const Polynomial& p) {
  const std::array<double, 10> c = in_doubles(p);
  return std::clamp(collision::approximate_root({c.data(), static_cast<std::size_t>(p.degree) + 1}), 0.0,
                    1.0);
}

/// All roots of p in the open interval (0, 1) are below 2^-k: Fujiwara's bound
/// 2 max |c_i / c_n|^(1 / (n - i)) in x = t / (1 - t), with the powers of two of the coefficients. 0 where
/// it says nothing.
unsigned halvings_towards_0(const Polynomial& p) {
  int n = p.degree;
  while (n > 0 && p.c[n] == 0) --n;
  long bound = std::numeric_limits<int>::min();
  for (int i = 0; i < n; ++i) {
    if (p.c[i] == 0) continue;
    const long bits = static_cast<long>(msb(abs(p.c[i]))) + 1 - static_cast<long>(msb(abs(p.c[n])));
    bound = std::max(bound, bits > 0 ? bits : bits / (n - i));
  }
  return n > 0 && bound < -2 ? static_cast<unsigned>(-bound - 2) : 0;
}

unsigned halvings_towards_1(Polynomial p) {
  std::reverse(p.c.begin(), p.c.begin() + p.degree + 1);
  return halvings_towards_0(p);
}

/// Narrows the bracket of a root by the signs of p at points within.
class Narrowing {
 public:
  /// `there` is p on the bracket, up to a positive factor.
  Narrowing(const Root& root, const Polynomial& there) : root_(root), before_(first_sign(there)) {}

  const Root& root() const { return root_; }

  /// Splits the bracket beside an approximate root, ever farther from it until the sign changes. Where
  /// doubles tell the root well the bracket becomes 2^-42 of its width; half of it always.
  void sharpen(const Polynomial& there) {
    const auto [low, width, exponent] = common();
    const Integer start = low << finer;
    const auto point = [&, w = width, e = exponent](std::int64_t steps) {
      return Dyadic{start + w * steps, e + finer};
    };
    const auto guess = static_cast<std::int64_t>(std::llround(std::ldexp(approximate_root_of(there), finer)));
    split_at(point(guess));
    const bool above = guess == 0 || !less(root_.low, point(guess));
    for (std::int64_t step = reach; !is_within(width * (2 * reach), exponent + finer) && step < most_steps;
         step <<= 7)
      split_at(point(above ? guess + step : guess - step));
    if (!is_within(width, exponent + 1)) split_at(between(root_.low, root_.high));
  }

  bool is_narrow() const { return is_within(Integer(2 * reach), grid); }

 private:
  static constexpr unsigned finer = grid;
  static constexpr std::int64_t most_steps = std::int64_t{1} << finer;

  /// The lower end, the width and the power of two they are over.
  std::tuple<Integer, Integer, unsigned> common() const {
    const unsigned e = std::max(root_.low.exponent, root_.high.exponent);
    const Integer low = root_.low.numerator << (e - root_.low.exponent);
    return {low, (root_.high.numerator << (e - root_.high.exponent)) - low, e};
  }

  /// The bracket is at most units / 2^e wide.
  bool is_within(const Integer& units, unsigned e) const {
    const auto [low, width, exponent] = common();
    const unsigned most = std::max(e, exponent);
    return (width << (most - exponent)) <= (units << (most - e));
  }

  void split_at(const Dyadic& t) {
    if (!less(root_.low, t) || !less(t, root_.high)) return;
    const int sign = sign_at(*root_.p, t);
    if (sign != -before_) root_.low = t;
    if (sign != before_) root_.high = t;
  }

  Root root_;
  int before_;
};

class Isolation {
 public:
  Isolation(const Polynomial& p, const Wanted& wanted) : p_(p), wanted_(wanted) {}

  bool run() {
    const bool ends_in_root = p_.c[p_.degree] == 0;
    bool found = search({p_, {0, 0}});
    if (has_multiple_roots_) {
      make_square_free();
      found = search({p_, {0, 0}});
    }
    return found || (ends_in_root && accept({&p_, {1, 0}, {1, 0}}));
  }

  Root first;

 private:
  bool accept(const Root& root) {
    if (!wanted_.root(root)) return false;
    first = root;
    return true;
  }

  /// A part to be searched, or what of it comes behind its first half.
  struct Pending {
    Part part;
    bool begun = false, root_in_middle = false;
  };

  /// On a stack of its own: clustered roots are found hundreds of halvings deep.
  bool search(const Part& all) {
    std::vector<Pending> pending{{all}};
    while (!pending.empty()) {
      Pending next = std::move(pending.back());
      pending.pop_back();
      if (next.begun) {
        const Dyadic middle = next.part.middle();
        if (next.root_in_middle && accept({&p_, middle, middle})) return true;
        next.part = {second_half(next.part.p), middle};
      }
      if (look_at(next.part, pending)) return true;
      if (has_multiple_roots_) return false;
    }
    return false;
  }

  /// True when the root wanted is the only one of the part; what else there is to be searched is put aside.
  bool look_at(const Part& part, std::vector<Pending>& pending) {
    const int changes = sign_changes(part.p);
    if (changes == 0 || none_is_wanted(part)) return false;
    if (changes == 1) {
      Narrowing narrowing({&p_, part.low, part.high()}, part.p);
      if (!narrowing.is_narrow()) narrowing.sharpen(part.p);
      while (!narrowing.is_narrow()) narrowing.sharpen(on_bracket(p_, narrowing.root()));
      return accept(narrowing.root());
    }
    if (part.low.exponent >= suspicious && !is_square_free()) return false;
    if (const unsigned closer = halvings_towards_0(part.p); closer > 2) {
      pending.push_back({{restricted(part.p, {0, 0}, {1, closer}),
                          {part.low.numerator << closer, part.low.exponent + closer}}});
    } else if (const unsigned near = halvings_towards_1(part.p); near > 2) {
      const Integer one = Integer(1) << near;
      pending.push_back({{restricted(part.p, {one - 1, near}, {1, 0}),
                          {(part.low.numerator << near) + (one - 1), part.low.exponent + near}}});
    } else {
      const Part before{first_half(part.p), {part.low.numerator * 2, part.low.exponent + 1}};
      pending.push_back({part, true, before.p.c[before.p.degree] == 0});
      pending.push_back({before});
    }
    return false;
  }

  /// Asked once; if it is not, the search ends and begins anew without the multiple roots.
  bool is_square_free() {
    if (!asked_) {
      const Polynomial inner = without_ends(p_);
      has_multiple_roots_ = inner.degree > 1 && !surely_coprime(inner, derivative(inner));
    }
    asked_ = true;
    return !has_multiple_roots_;
  }

  /// The same roots between 0 and 1, each once.
  void make_square_free() {
    const Polynomial inner = without_ends(p_);
    p_ = quotient(inner, common_divisor(inner, derivative(inner)));
    has_multiple_roots_ = false;
  }

  /// Ends beyond doubles are not asked about.
  bool none_is_wanted(const Part& part) const {
    if (part.low.exponent > 50) return false;
    const auto at = [&](const Dyadic& t) {
      return std::ldexp(static_cast<double>(static_cast<std::int64_t>(t.numerator)),
                        -static_cast<int>(t.exponent));
    };
    return wanted_.none_between(at(part.low), at(part.high()));
  }

  Polynomial p_;
  const Wanted& wanted_;
  bool asked_ = false;
  bool has_multiple_roots_ = false;
};

/// 2 where the doubles do not tell. The bracket is below 2^-42 or of no account: q varies over it by at most
/// its width times 2 degree max |c|.
int sign_in_doubles(const Polynomial& q, const Root& root) {
  std::array<double, 10> c = in_doubles(q);
  double largest = 0.0;
  for (int i = 0; i <= q.degree; ++i) largest = std::max(largest, std::abs(c[i]));
  const double t = std::ldexp(static_cast<double>(root.low.numerator), -static_cast<int>(root.low.exponent));
  for (int level = q.degree; level > 0; --level)
    for (int i = 0; i < level; ++i) c[i] += t * (c[i + 1] - c[i]);
  const double error = (0x1p-42 * 2 * q.degree + (4 * q.degree + 8) * 0x1p-50) * largest;
  return c[0] > error ? 1 : (c[0] < -error ? -1 : 2);
}

/// For a root in an open interval.
bool is_root_of(const Polynomial& q, const Root& root) {
  if (proportional(q, *root.p)) return true;
  const Polynomial p = without_ends(*root.p);
  const Polynomial inner = without_ends(q);
  if (inner.degree == 0 || surely_coprime(p, inner)) return false;
  const Polynomial common = common_divisor(p, inner);
  return sign_changes(restricted(common, root.low, root.high)) % 2 == 1;
}

}  // namespace

bool find_root(const Polynomial& p, const Wanted& wanted, Root& first) {
  Isolation isolation(p, wanted);
  if (!isolation.run()) return false;
  first = isolation.first;
  return true;
}

int sign_at(const Polynomial& q, Root root) {
  if (is_zero(q)) return 0;
  if (root.is_dyadic()) return sign_at(q, root.low);
  const int in_double = sign_in_doubles(q, root);
  if (in_double != 2) return in_double;
  if (is_root_of(q, root)) return 0;
  Polynomial there = on_bracket(q, root);
  while (sign_changes(there) != 0) {
    const Polynomial p = on_bracket(*root.p, root);
    Narrowing narrowing(root, p);
    narrowing.sharpen(p);
    root = narrowing.root();
    if (root.is_dyadic()) return sign_at(q, root.low);
    there = on_bracket(q, root);
  }
  return first_sign(there);
}

}  // namespace tendril::exact
