#include <tendril/exact/continuous.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "polynomial.h"
#include "roots.h"

namespace tendril::exact {
namespace {

using collision::Features;
using collision::FirstMeeting;
using collision::Meeting;
using collision::Paths;
using collision::Reason;

/// What the answer's bracket may be wide.
constexpr double widest = 0x1p-40;

/// x = mantissa 2^exponent with an odd mantissa, or 0.
struct Parts {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

Parts parts(double x) {
  if (x == 0.0) return {};
  int exponent = 0;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  exponent -= 53;
  while (mantissa % 2 == 0) {
    mantissa /= 2;
    ++exponent;
  }
  return {mantissa, exponent};
}

/// The paths of the other three vertices relative to the first: d[i][axis]. Each axis is scaled by a power of
/// two of its own, which changes no answer.
template <int Degree>
class IntegerPaths {
 public:
  explicit IntegerPaths(const Paths<Degree>& paths) {
    for (int axis = 0; axis < 3; ++axis) set_axis(paths, axis);
  }

  const Polynomial& at(int which, int axis) const { return d_[which][axis]; }

  /// d_first x d_second along an axis.
  Polynomial cross(int first, int second, int axis) const {
    const int x = (axis + 1) % 3;
    const int y = (axis + 2) % 3;
    return at(first, x) * at(second, y) - at(first, y) * at(second, x);
  }

  Polynomial determinant() const {
    return at(0, 0) * cross(1, 2, 0) + at(0, 1) * cross(1, 2, 1) + at(0, 2) * cross(1, 2, 2);
  }

 private:
  void set_axis(const Paths<Degree>& paths, int axis) {
    std::array<std::array<Parts, Degree + 1>, 4> p;
    int least = std::numeric_limits<int>::max();
    for (int vertex = 0; vertex < 4; ++vertex)
      for (int i = 0; i <= Degree; ++i) {
        p[vertex][i] = parts(paths[vertex][i][axis]);
        if (p[vertex][i].mantissa != 0) least = std::min(least, p[vertex][i].exponent);
      }
    const auto integer = [&](const Parts& part) {
      return part.mantissa == 0 ? Integer(0)
                                : Integer(part.mantissa) << static_cast<unsigned>(part.exponent - least);
    };
    constexpr int cubic[4] = {1, 3, 3, 1};
    for (int which = 0; which < 3; ++which) {
      d_[which][axis].degree = Degree;
      for (int i = 0; i <= Degree; ++i)
        d_[which][axis].c[i] = (integer(p[which + 1][i]) - integer(p[0][i])) * (Degree == 3 ? cubic[i] : 1);
    }
  }

  std::array<std::array<Polynomial, 3>, 3> d_;
};

/// Whether features that lie in one plane with the first vertex meet, by signs of polynomials.
template <int Degree>
class Coplanar {
 public:
  Coplanar(Features features, const IntegerPaths<Degree>& d) : features_(features), d_(d) {}

  /// Those of weights_keep_sign (collision/continuous/relative_paths.h), of the cross products along an axis.
  /// Where not all are zero, the features meet exactly if no two have opposite signs. Vertex and face: the
  /// weights are then the only relation between the d_i up to a factor. Edges: the pairs sum to the cross
  /// product of the edges, so one sign makes that not zero; of opposite signs, either it is not zero and the
  /// lines cross outside an edge, or the edges are on two parallel lines.
  std::vector<Polynomial> weights(int axis) const {
    const Polynomial w1 = d_.cross(1, 2, axis);
    const Polynomial w2 = d_.cross(2, 0, axis);
    const Polynomial w3 = d_.cross(0, 1, axis);
    if (features_ == Features::vertex_face) return {w1, w2, w3};
    return {w1, -w2, -w3, -(w1 + w2 + w3)};
  }

  /// Of features on one line: they are apart exactly if along an axis all of these have one sign, not zero.
  std::vector<Polynomial> differences(int axis) const {
    const Polynomial& d1 = d_.at(0, axis);
    const Polynomial& d2 = d_.at(1, axis);
    const Polynomial& d3 = d_.at(2, axis);
    if (features_ == Features::vertex_face) return {d1, d2, d3};
    return {d2, d3, d2 - d1, d3 - d1};
  }

  bool meet(const Root& time) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto [least, most] = signs(weights(axis), time);
      if (least != 0 || most != 0) return least * most >= 0;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto [least, most] = signs(differences(axis), time);
      if (least * most > 0) return false;
    }
    return true;
  }

 private:
  static std::pair<int, int> signs(const std::vector<Polynomial>& polynomials, const Root& time) {
    int least = 1;
    int most = -1;
    for (const Polynomial& p : polynomials) {
      const int sign = sign_at(p, time);
      least = std::min(least, sign);
      most = std::max(most, sign);
      if (least < 0 && most > 0) break;
    }
    return {least, most};
  }

  Features features_;
  const IntegerPaths<Degree>& d_;
};

double round_down(const Dyadic& t) {
  const unsigned drop = t.exponent > 53 ? t.exponent - 53 : 0;
  return std::ldexp(static_cast<double>(static_cast<std::int64_t>(t.numerator >> drop)),
                    -static_cast<int>(t.exponent - drop));
}

double round_up(const Dyadic& t) {
  const Dyadic rest{(Integer(1) << t.exponent) - t.numerator, t.exponent};
  return 1.0 - round_down(rest);
}

FirstMeeting hit_at(const Root& root) {
  return {Meeting::hit, Reason::none, round_down(root.low), round_up(root.high)};
}

template <int Degree>
class Search {
 public:
  Search(Features features, const Paths<Degree>& paths, double free_until)
      : d_(paths), coplanar_(features, d_), free_until_(free_until) {}

  FirstMeeting run() {
    const Polynomial determinant = d_.determinant();
    if (is_zero(determinant))
      in_one_plane();
    else
      take_roots(determinant);
    return first_;
  }

 private:
  void take_roots(const Polynomial& p) {
    Root root;
    if (is_zero(p) || !find_root(
                          p, free_until_, [&](const Root& at) { return coplanar_.meet(at); }, root))
      return;
    keep_first(hit_at(root));
  }

  /// The first of two brackets, or what holds the first of two times where the brackets overlap.
  void keep_first(const FirstMeeting& found) {
    const bool none = first_.meeting == Meeting::free;
    first_ = none ? found
                  : FirstMeeting{Meeting::hit, Reason::none, std::min(first_.from, found.from),
                                 std::min(first_.to, found.to)};
  }

  /// The features lie in one plane at all times. Whether they meet changes only at the roots of the
  /// polynomials whose signs decide it, and to meet is closed, so it begins at 0 or at one of them.
  void in_one_plane() {
    Polynomial beginning{1, {}};
    beginning.c[1] = 1;
    take_roots(beginning);
    if (first_.meeting == Meeting::hit) return;
    for (int axis = 0; axis < 3; ++axis)
      if (take_all(coplanar_.weights(axis))) return;
    for (int axis = 0; axis < 3; ++axis) take_all(coplanar_.differences(axis));
  }

  /// \return  whether any is not zero throughout
  bool take_all(const std::vector<Polynomial>& polynomials) {
    for (const Polynomial& p : polynomials) take_roots(p);
    return std::any_of(polynomials.begin(), polynomials.end(),
                       [](const Polynomial& p) { return !is_zero(p); });
  }

  IntegerPaths<Degree> d_;
  Coplanar<Degree> coplanar_;
  double free_until_;
  FirstMeeting first_{Meeting::free, Reason::none, 1.0, 1.0};
};

template <int Degree>
bool finite(const Paths<Degree>& paths) {
  return std::all_of(paths.begin(), paths.end(), [](const auto& path) { return all_finite(path); });
}

}  // namespace

template <int Degree>
FirstMeeting first_meeting_in_integers(Features features, const Paths<Degree>& paths) {
  if (!finite<Degree>(paths)) return {Meeting::undecided, Reason::not_finite, 0.0, 1.0};
  return Search<Degree>(features, paths, 0.0).run();
}

template <int Degree>
FirstMeeting first_meeting(Features features, const Paths<Degree>& paths) {
  const FirstMeeting in_doubles = collision::first_meeting<Degree>(features, paths);
  if (in_doubles.reason == Reason::not_finite || in_doubles.meeting == Meeting::free) return in_doubles;
  if (in_doubles.meeting == Meeting::hit && in_doubles.to - in_doubles.from <= widest) return in_doubles;
  return Search<Degree>(features, paths, in_doubles.from).run();
}

template FirstMeeting first_meeting<1>(Features, const Paths<1>&);
template FirstMeeting first_meeting<3>(Features, const Paths<3>&);
template FirstMeeting first_meeting_in_integers<1>(Features, const Paths<1>&);
template FirstMeeting first_meeting_in_integers<3>(Features, const Paths<3>&);

}  // namespace tendril::exact
