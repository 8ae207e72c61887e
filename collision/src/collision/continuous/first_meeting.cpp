#include <tendril/collision/continuous.h>

#include <algorithm>
#include <cmath>

#include "relative_paths.h"
#include "sharp_determinant.h"
#include "time_interval.h"

namespace tendril::collision {
namespace {

/// How many intervals are looked at before the query is left to exact arithmetic: one that needs more is
/// nearly always a touch, which no number of them decides.
constexpr int most_intervals = 40;
/// Where the intervals are cut. Not in the middle: made-up scenes like to meet there, and at the end of an
/// interval a meeting cannot be proven.
constexpr double cut = 0.484375;
/// Half the width of the bracket that is tried around an approximate root.
constexpr double half_bracket = 0x1.8p-42;

template <int Degree>
class Search {
 public:
  Search(Features features, const Paths<Degree>& given, const RelativePaths<Degree>& paths)
      : features_(features), given_(given), paths_(paths) {}

  /// What is not yet free begins at `from`, and its parts end at the times that wait.
  FirstMeeting run() {
    std::array<Instant, most_intervals + 1> waiting;
    int count = 1;
    Instant from = paths_.at(0.0);
    waiting[0] = paths_.at(1.0);
    for (int looked = 0; looked < most_intervals; ++looked) {
      const TimeInterval<Degree> now = paths_.interval(from, waiting[count - 1]);
      const Instant at = paths_.at(now.from.time + cut * (now.to.time - now.from.time));
      if (paths_.apart(features_, now, at)) {
        if (--count == 0) return {Meeting::free, Reason::none, 1.0, 1.0};
        from = waiting[count];
        continue;
      }
      if (may_meet(now, at))
        if (const auto c = paths_.determinant(now); paths_.has_one_root(c)) return narrowed(now, c);
      if (is_a_touch(now)) break;
      waiting[count++] = at;
    }
    return {Meeting::undecided, Reason::rounding, from.time, 1.0};
  }

 private:
  /// Features in one plane at an end and still not apart shortly beside it very likely are: then more
  /// intervals would not tell either.
  static bool is_a_touch(const TimeInterval<Degree>& now) {
    return now.from.side * now.to.side == 0 && now.to.time - now.from.time < 0x1p-12;
  }

  /// They do once for each root of the determinant.
  bool may_meet(const TimeInterval<Degree>& now, const Instant& at) const {
    return now.from.side * now.to.side < 0 && paths_.weights_keep_sign(features_, now, at);
  }

  /// The interval holds one meeting and the determinant one root, so a change of the determinant's sign
  /// within brackets the meeting.
  /// \param c  coefficients of the determinant
  FirstMeeting narrowed(const TimeInterval<Degree>& now, const std::array<double, 3 * Degree + 1>& c) const {
    const double width = now.to.time - now.from.time;
    const double root = now.from.time + width * approximate_root(c);
    const Instant low = paths_.at(std::max(now.from.time, root - half_bracket));
    const Instant high = paths_.at(std::min(now.to.time, root + half_bracket));
    if (low.side == now.from.side && high.side == now.to.side)
      return {Meeting::hit, Reason::none, low.time, high.time};
    return sharpened(now, c, root);
  }

  /// Newton's method by the sharp determinant f and the slope of its coefficients c, until f is so small that
  /// half a bracket before it has the sign it begins with and half a bracket after the other: there it is
  /// f -+ slope half_bracket, but for half_bracket times the error of the slope, and half its square times a
  /// bound of the curvature.
  FirstMeeting sharpened(const TimeInterval<Degree>& now, const std::array<double, 3 * Degree + 1>& c,
                         double root) const {
    constexpr int kSteps = 4, n = 3 * Degree;
    const FirstMeeting wide{Meeting::hit, Reason::none, now.from.time, now.to.time};
    if (!(paths_.permanent() > SharpDeterminant<Degree>::least_permanent)) return wide;
    const SharpDeterminant<Degree> determinant(given_, paths_.scale());
    const HornerForm slope_there = slope_of(c);
    const double width = now.to.time - now.from.time, size = paths_.permanent();
    const double slope_error = 2 * n * (paths_.coefficient_error() + 0x1p-44 * size) / width;
    const double error = SharpDeterminant<Degree>::error() * size + half_bracket * slope_error +
                         half_bracket * half_bracket * (2 * n * (n - 1)) * size;
    for (int step = 0; step < kSteps; ++step) {
      const double f = determinant(root), slope = slope_there((root - now.from.time) / width) / width;
      if ((std::abs(f) + error) * (1 + 0x1p-30) < now.to.side * slope * half_bracket)
        return {Meeting::hit, Reason::none, std::max(now.from.time, root - half_bracket),
                std::min(now.to.time, root + half_bracket)};
      const double next = root - f / slope;
      if (!(next > now.from.time && next < now.to.time)) return wide;
      root = next;
    }
    return wide;
  }

  Features features_;
  const Paths<Degree>& given_;
  const RelativePaths<Degree>& paths_;
};

}  // namespace

template <int Degree>
FirstMeeting first_meeting(Features features, const Paths<Degree>& paths) {
  const RelativePaths<Degree> relative(paths);
  if (!relative.finite()) return {Meeting::undecided, Reason::not_finite, 0.0, 1.0};
  if (!relative.in_range()) return {Meeting::undecided, Reason::rounding, 0.0, 1.0};
  return Search<Degree>(features, paths, relative).run();
}

template FirstMeeting first_meeting<1>(Features, const Paths<1>&);
template FirstMeeting first_meeting<3>(Features, const Paths<3>&);

}  // namespace tendril::collision
