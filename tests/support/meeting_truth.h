#pragma once

#include <tendril/collision/continuous.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <functional>
#include <optional>
#include <vector>

/// When two moving features first meet, in exact arithmetic: the oracle of the continuous tests. Shares
/// neither arithmetic nor method with them. Paths are polynomials in t with integer coefficients (doubles are
/// rationals); roots are counted and told apart by Sturm's theorem, and the sign of another polynomial at a
/// root is found by Tarski's, with p' q in the place of p'. Whether coplanar features meet is asked of the
/// plane's normal and barycentric coordinates, and of their edges where there is no normal.
namespace tendril::test {

using Whole = boost::multiprecision::mpz_int;
using Ratio = boost::multiprecision::mpq_rational;

/// Coefficients of 1, t, t^2 ...; no leading zeros, so the zero polynomial is empty.
using Power = std::vector<Whole>;

inline void trim(Power& p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
}

inline Power sum(const Power& p, const Power& q, int sign = 1) {
  Power r(std::max(p.size(), q.size()), 0);
  for (std::size_t i = 0; i < p.size(); ++i) r[i] += p[i];
  for (std::size_t i = 0; i < q.size(); ++i) r[i] += sign * q[i];
  trim(r);
  return r;
}

inline Power product(const Power& p, const Power& q) {
  if (p.empty() || q.empty()) return {};
  Power r(p.size() + q.size() - 1, 0);
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < q.size(); ++j) r[i + j] += p[i] * q[j];
  return r;
}

inline Power slope(const Power& p) {
  Power r;
  for (std::size_t i = 1; i < p.size(); ++i) r.push_back(i * p[i]);
  return r;
}

inline int sign_at(const Power& p, const Ratio& t) {
  Whole value = 0;
  Whole scale = 1;
  for (auto c = p.rbegin(); c != p.rend(); ++c) {
    value = value * numerator(t) + *c * scale;
    scale *= denominator(t);
  }
  return value.sign();
}

/// Minus the remainder of p by q, times a positive number, without common factors.
inline Power next_of(Power p, const Power& q) {
  while (p.size() >= q.size()) {
    const Whole lead = p.back();
    const std::size_t offset = p.size() - q.size();
    const int sign = q.back().sign();
    for (Whole& c : p) c *= abs(q.back());
    for (std::size_t i = 0; i < q.size(); ++i) p[offset + i] -= sign * lead * q[i];
    trim(p);
  }
  Whole common = 0;
  for (const Whole& c : p) common = gcd(common, c);
  for (Whole& c : p) c /= -common;
  return p;
}

/// Sturm's sequence of p and q.
inline std::vector<Power> sequence_of(const Power& p, const Power& q) {
  std::vector<Power> sequence{p};
  for (Power next = q; !next.empty(); next = next_of(sequence[sequence.size() - 2], sequence.back()))
    sequence.push_back(next);
  return sequence;
}

inline int changes_at(const std::vector<Power>& sequence, const Ratio& t) {
  int changes = 0;
  int last = 0;
  for (const Power& p : sequence) {
    const int sign = sign_at(p, t);
    changes += sign * last < 0;
    if (sign != 0) last = sign;
  }
  return changes;
}

/// A time: low where the two are equal, else the only root of p between them, neither of them a root.
struct RootOf {
  const Power* p;
  Ratio low, high;
};

inline Ratio value_at(const Power& p, const Ratio& t) {
  Ratio value = 0;
  for (auto c = p.rbegin(); c != p.rend(); ++c) value = value * t + *c;
  return value;
}

/// The sign of q at a root that changes p's sign, where q is farther from 0 near it than its slope allows it
/// to go to 0 within the bracket, halved some times; else 0.
inline int clear_sign_at(const Power& q, RootOf root) {
  const int low = sign_at(*root.p, root.low);
  if (low * sign_at(*root.p, root.high) >= 0) return 0;
  for (int halving = 0; halving < 40; ++halving) {
    const Ratio middle = (root.low + root.high) / 2;
    const int sign = sign_at(*root.p, middle);
    if (sign == 0) return sign_at(q, middle);
    (low * sign < 0 ? root.high : root.low) = middle;
  }
  Whole steepest = 0;  // of q' on [0, 1]
  for (const Whole& c : slope(q)) steepest += abs(c);
  const Ratio value = value_at(q, root.low);
  return abs(value) > steepest * (root.high - root.low) ? value.sign() : 0;
}

inline int sign_at(const Power& q, const RootOf& root) {
  if (root.low == root.high) return sign_at(q, root.low);
  if (q.empty()) return 0;
  if (const int sign = clear_sign_at(q, root)) return sign;
  const auto sequence = sequence_of(*root.p, product(slope(*root.p), q));
  return changes_at(sequence, root.low) - changes_at(sequence, root.high);
}

/// The distinct roots of p in [0, 1], in ascending order, until `wanted` says so.
class Roots {
 public:
  explicit Roots(const Power& p) : p_(p), sturm_(sequence_of(p, slope(p))) {}

  std::optional<RootOf> first(const std::function<bool(const RootOf&)>& wanted) const {
    if (const auto root = at(0, wanted)) return root;
    if (const auto root = between(0, 1, wanted)) return root;
    return at(1, wanted);
  }

  /// Halves the bracket of a root.
  void narrow(RootOf& root) const {
    if (root.low == root.high) return;
    const Ratio middle = (root.low + root.high) / 2;
    const int sign = sign_at(p_, middle), low = sign_at(p_, root.low);
    if (sign == 0)
      root.low = root.high = middle;
    else if (low * sign_at(p_, root.high) < 0)  // the only root between them changes the sign
      (low * sign < 0 ? root.high : root.low) = middle;
    else
      (changes_at(sturm_, root.low) != changes_at(sturm_, middle) ? root.high : root.low) = middle;
  }

 private:
  std::optional<RootOf> at(const Ratio& t, const std::function<bool(const RootOf&)>& wanted) const {
    const RootOf root{&p_, t, t};
    return sign_at(p_, t) == 0 && wanted(root) ? std::optional(root) : std::nullopt;
  }

  /// The ends not included. Sturm's theorem needs ends that are no roots: where one is, points ever nearer
  /// to it with no root between stand for it.
  std::optional<RootOf> between(const Ratio& low, const Ratio& high,
                                const std::function<bool(const RootOf&)>& wanted) const {
    const Ratio l = inside(low, high);
    const Ratio h = inside(high, low);
    if (l >= h) return {};
    const int count = changes_at(sturm_, l) - changes_at(sturm_, h);
    if (count == 0) return {};
    const RootOf only{&p_, l, h};
    if (count == 1) return wanted(only) ? std::optional(only) : std::nullopt;
    const Ratio middle = (low + high) / 2;
    if (const auto root = between(low, middle, wanted)) return root;
    if (const auto root = at(middle, wanted)) return root;
    return between(middle, high, wanted);
  }

  /// A root divided out of the sequence leaves the count of the others right.
  Ratio inside(const Ratio& end, const Ratio& other) const {
    if (sign_at(p_, end) != 0) return end;
    Power without = p_;
    while (sign_at(without, end) == 0) without = divided(without, end);
    const auto sturm = sequence_of(without, slope(without));
    Ratio near = (end + other) / 2;
    while (changes_at(sturm, end) != changes_at(sturm, near) || sign_at(without, near) == 0)
      near = (end + near) / 2;
    return near;
  }

  /// p / (denominator t - numerator)
  static Power divided(const Power& p, const Ratio& root) {
    Power q(p.size() - 1, 0);
    Whole carry = 0;
    for (std::size_t i = p.size() - 1; i > 0; --i) {
      carry = (p[i] + carry) / denominator(root);
      q[i - 1] = carry;
      carry *= numerator(root);
    }
    return q;
  }

  Power p_;
  std::vector<Power> sturm_;
};

/// The truth of a query: whether the features meet, and a bracket of the first time, below 2^-60 wide.
struct MeetingTruth {
  bool meets = false;
  Ratio low = 0, high = 1;
};

template <int Degree>
class MeetingOracle {
 public:
  MeetingOracle(collision::Features features, const collision::Paths<Degree>& paths)
      : edges_(features == collision::Features::edge_edge) {
    const Whole scale = scale_of(paths);
    for (int vertex = 0; vertex < 4; ++vertex)
      for (int axis = 0; axis < 3; ++axis) p_[vertex][axis] = coefficients(paths[vertex], axis, scale);
  }

  MeetingTruth truth() {
    const Triple a = minus(p_[1], p_[0]);
    const Triple b = minus(p_[2], p_[0]);
    const Triple c = minus(p_[3], p_[0]);
    const Power volume = dot(a, cross(b, c));
    MeetingTruth truth;
    if (!volume.empty())
      look(volume, truth);
    else
      look_in_plane(truth);
    return truth;
  }

 private:
  using Triple = std::array<Power, 3>;

  static Triple minus(const Triple& a, const Triple& b) {
    return {sum(a[0], b[0], -1), sum(a[1], b[1], -1), sum(a[2], b[2], -1)};
  }
  static Power dot(const Triple& a, const Triple& b) {
    return sum(sum(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]));
  }
  static Triple cross(const Triple& a, const Triple& b) {
    Triple c;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      c[i] = sum(product(a[j], b[k]), product(a[k], b[j]), -1);
    }
    return c;
  }

  /// What all coordinates are multiplied by to be integers.
  static Whole scale_of(const collision::Paths<Degree>& paths) {
    Whole scale = 1;
    for (const auto& path : paths)
      for (const Vec3& p : path)
        for (const double x : p) scale = std::max(scale, Whole(denominator(Ratio(x))));
    return scale;
  }

  static Power coefficients(const std::array<Vec3, Degree + 1>& path, int axis, const Whole& scale) {
    std::array<Whole, Degree + 1> x;
    for (int i = 0; i <= Degree; ++i) x[i] = Whole(numerator(Ratio(path[i][axis]) * scale));
    Power p;
    if constexpr (Degree == 1)
      p = {x[0], x[1] - x[0]};
    else
      p = {x[0], 3 * (x[1] - x[0]), 3 * (x[2] - 2 * x[1] + x[0]), x[3] - 3 * x[2] + 3 * x[1] - x[0]};
    trim(p);
    return p;
  }

  /// On the closed segment from a to b.
  bool on_segment(const Triple& point, const Triple& from, const Triple& to, const RootOf& t) {
    const Triple a = minus(from, point);
    const Triple b = minus(to, point);
    const Triple area = cross(a, b);
    keep({dot(area, area), dot(a, b)});
    return sign_at(dot(area, area), t) == 0 && sign_at(dot(a, b), t) <= 0;
  }

  /// The features lie in one plane at t.
  bool meet_at(const RootOf& t) { return edges_ ? edges_meet_at(t) : vertex_meets_face_at(t); }

  bool vertex_meets_face_at(const RootOf& t) {
    const Triple a = minus(p_[1], p_[0]);
    const Triple b = minus(p_[2], p_[0]);
    const Triple c = minus(p_[3], p_[0]);
    const Triple normal = cross(minus(b, a), minus(c, a));
    const Power square = dot(normal, normal);
    const std::array<Power, 3> inside{dot(normal, cross(a, b)), dot(normal, cross(b, c)),
                                      dot(normal, cross(c, a))};
    keep({square, inside[0], inside[1], inside[2]});
    if (sign_at(square, t) != 0)
      return std::all_of(inside.begin(), inside.end(), [&](const Power& p) { return sign_at(p, t) >= 0; });
    return any({on_segment(p_[0], p_[1], p_[2], t), on_segment(p_[0], p_[2], p_[3], t),
                on_segment(p_[0], p_[3], p_[1], t)});
  }

  bool edges_meet_at(const RootOf& t) {
    const Triple along = minus(p_[1], p_[0]);
    const Triple other = minus(p_[3], p_[2]);
    const Triple apart = minus(p_[2], p_[0]);
    const Triple normal = cross(along, other);
    const Power square = dot(normal, normal);
    const Power s = dot(cross(apart, other), normal);
    const Power r = dot(cross(apart, along), normal);
    keep({square, s, r, sum(square, s, -1), sum(square, r, -1)});
    if (sign_at(square, t) != 0)
      return sign_at(s, t) >= 0 && sign_at(r, t) >= 0 && sign_at(sum(square, s, -1), t) >= 0 &&
             sign_at(sum(square, r, -1), t) >= 0;
    return any({on_segment(p_[0], p_[2], p_[3], t), on_segment(p_[1], p_[2], p_[3], t),
                on_segment(p_[2], p_[0], p_[1], t), on_segment(p_[3], p_[0], p_[1], t)});
  }

  static bool any(std::initializer_list<bool> list) {
    return std::any_of(list.begin(), list.end(), [](bool b) { return b; });
  }

  /// The polynomials whose signs decide, for motion in one plane.
  void keep(std::vector<Power> asked) {
    if (!keeping_) return;
    for (Power& p : asked)
      if (!p.empty()) asked_.push_back(std::move(p));
  }

  void look(const Power& p, MeetingTruth& truth) {
    const Roots roots(p);
    auto found = roots.first([&](const RootOf& t) { return meet_at(t); });
    if (!found) return;
    while (found->high - found->low > Ratio(1, Whole(1) << 60)) roots.narrow(*found);
    if (!truth.meets || found->low < truth.low) truth = {true, found->low, found->high};
  }

  /// Whether the features meet can change at the roots of what decides it alone, and to meet is closed.
  void look_in_plane(MeetingTruth& truth) {
    keeping_ = true;
    const bool at_once = meet_at({nullptr, 0, 0});
    keeping_ = false;
    if (at_once) {
      truth = {true, 0, 0};
      return;
    }
    for (const Power& p : asked_) look(p, truth);
  }

  bool edges_, keeping_ = false;
  std::array<Triple, 4> p_;
  std::vector<Power> asked_;
};

}  // namespace tendril::test
