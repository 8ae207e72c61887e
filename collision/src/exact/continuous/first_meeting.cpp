#include <tendril/exact/continuous.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "collision/continuous/relative_paths.h"
#include "integer_paths.h"
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
  const std::vector<Polynomial>& weights(int axis) const {
    std::vector<Polynomial>& w = weights_[axis];
    if (!w.empty()) return w;
    w = {d_.cross(1, 2, axis), d_.cross(2, 0, axis), d_.cross(0, 1, axis)};
    if (features_ == Features::edge_edge) w = {w[0], -w[1], -w[2], -(w[0] + w[1] + w[2])};
    return w;
  }

  /// Of features on one line: they are apart exactly if along an axis all of these have one sign, not zero.
  std::vector<Polynomial> differences(int axis) const {
    const Polynomial& d1 = d_.at(0, axis);
    const Polynomial& d2 = d_.at(1, axis);
    const Polynomial& d3 = d_.at(2, axis);
    if (features_ == Features::vertex_face) return {d1, d2, d3};
    return {d2, d3, d2 - d1, d3 - d1};
  }

  Features features() const { return features_; }

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
  mutable std::array<std::vector<Polynomial>, 3> weights_;  ///< by axis, once they are asked for
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

/// What doubles prove of an interval, see RelativePaths.
template <int Degree>
class InDoubles {
 public:
  InDoubles(Features features, const Paths<Degree>& paths)
      : features_(features), paths_(paths), usable_(paths_.finite() && paths_.in_range()) {}

  bool apart(double from, double to) const { return prove(from, to, &Relative::apart); }
  /// At every time at which the features are in one plane.
  bool meet(double from, double to) const { return prove(from, to, &Relative::weights_keep_sign); }

 private:
  using Relative = collision::RelativePaths<Degree>;
  template <class Proof>
  bool prove(double from, double to, const Proof& proof) const {
    if (!usable_) return false;
    const collision::Instant first = paths_.at(from), last = paths_.at(to);
    return (paths_.*proof)(features_, paths_.interval(first, last), paths_.at(0.5 * (from + to)));
  }

  Features features_;
  Relative paths_;
  bool usable_;
};

template <int Degree>
class Search {
 public:
  /// \param in_doubles  null: integers alone
  Search(Features features, const Paths<Degree>& paths, double free_until,
         const InDoubles<Degree>* in_doubles)
      : d_(paths), coplanar_(features, d_), free_until_(free_until) {
    wanted_.none_between = [=, this](double from, double to) {
      return to < free_until || from > first_.to || (in_doubles && in_doubles->apart(from, to));
    };
    wanted_.root = [=, this](const Root& at) {
      if (in_doubles) {
        const double from = round_down(at.low), to = round_up(at.high);
        if (in_doubles->apart(from, to)) return false;
        if (in_doubles->meet(from, to)) return true;
      }
      return coplanar_.meet(at);
    };
  }

  FirstMeeting run() {
    const Polynomial determinant = d_.determinant();
    if (determinant.c[0] == 0 && meet_at_the_beginning()) return {Meeting::hit, Reason::none, 0.0, 0.0};
    if (is_zero(determinant))
      in_one_plane();
    else
      take_roots(determinant);
    return first_;
  }

 private:
  void take_roots(const Polynomial& p) {
    Root root;
    if (!is_zero(p) && find_root(p, wanted_, root)) keep_first(hit_at(root));
  }

  /// Where they are in one plane then.
  bool meet_at_the_beginning() const {
    if (free_until_ > 0.0) return false;
    const IntegerPaths<Degree> there = d_.beginning();
    const Polynomial time{1, {0, 1}};
    return Coplanar<Degree>(coplanar_.features(), there).meet({&time, {0, 0}, {0, 0}});
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
    for (int axis = 0; axis < 3; ++axis)
      if (take_all(coplanar_.weights(axis))) return;
    for (int axis = 0; axis < 3; ++axis) take_all(coplanar_.differences(axis));
  }

  /// Those that differ by a constant have the same roots: of features on one line all axes' do.
  /// \return  whether any is not zero throughout
  bool take_all(const std::vector<Polynomial>& polynomials) {
    bool any = false;
    for (const Polynomial& p : polynomials) {
      if (is_zero(p)) continue;
      any = true;
      if (std::any_of(taken_.begin(), taken_.end(), [&](const Polynomial& q) { return proportional(p, q); }))
        continue;
      taken_.push_back(p);
      take_roots(p);
    }
    return any;
  }

  std::vector<Polynomial> taken_;
  IntegerPaths<Degree> d_;
  Coplanar<Degree> coplanar_;
  double free_until_;
  Wanted wanted_;
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
  return Search<Degree>(features, paths, 0.0, nullptr).run();
}

template <int Degree>
FirstMeeting first_meeting(Features features, const Paths<Degree>& paths) {
  const FirstMeeting in_doubles = collision::first_meeting<Degree>(features, paths);
  if (in_doubles.reason == Reason::not_finite || in_doubles.meeting == Meeting::free) return in_doubles;
  if (in_doubles.meeting == Meeting::hit && in_doubles.to - in_doubles.from <= widest) return in_doubles;
  const InDoubles<Degree> proofs(features, paths);
  return Search<Degree>(features, paths, in_doubles.from, &proofs).run();
}

template FirstMeeting first_meeting<1>(Features, const Paths<1>&);
template FirstMeeting first_meeting<3>(Features, const Paths<3>&);
template FirstMeeting first_meeting_in_integers<1>(Features, const Paths<1>&);
template FirstMeeting first_meeting_in_integers<3>(Features, const Paths<3>&);

}  // namespace tendril::exact
