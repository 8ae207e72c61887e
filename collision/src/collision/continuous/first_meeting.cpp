#include <tendril/collision/continuous.h>

#include <algorithm>
#include <cmath>

#include "closest_direction.h"
#include "relative_paths.h"
#include "time_interval.h"

namespace tendril::collision {
namespace {

/// How many intervals are looked at before the query is left to exact arithmetic: one that needs more is
/// nearly always a touch, which no number of them decides.
constexpr int most_intervals = 48;
/// Where the intervals are cut. Not in the middle: made-up scenes like to meet there, and at the end of an
/// interval a meeting cannot be proven.
constexpr double cut = 0.484375;
/// Half the width of the bracket that is tried around an approximate root.
constexpr double half_bracket = 0x1.8p-42;

template <int Degree>
class Search {
 public:
  Search(Features features, const RelativePaths<Degree>& paths) : features_(features), paths_(paths) {}

  FirstMeeting run() {
    std::array<TimeInterval<Degree>, most_intervals + 2> waiting;
    int count = 1;
    waiting[0] = paths_.interval(0.0, 1.0);
    for (int looked = 0; looked < most_intervals; ++looked) {
      const TimeInterval<Degree> now = waiting[--count];
      const double middle = now.from.time + cut * (now.to.time - now.from.time);
      const Instant at = paths_.at(middle);
      if (apart(now, at)) {
        if (count == 0) return {Meeting::free, Reason::none, 1.0, 1.0};
        continue;
      }
      if (meets(now, at)) return narrowed(now);
      waiting[count++] = paths_.interval(at, now.to);
      waiting[count++] = paths_.interval(now.from, at);
    }
    return {Meeting::undecided, Reason::rounding, waiting[count - 1].from.time, 1.0};
  }

 private:
  bool apart(const TimeInterval<Degree>& now, const Instant& at) const {
    return features_ == Features::vertex_face
               ? paths_.template apart<Features::vertex_face>(now, vertex_face_direction(at))
               : paths_.template apart<Features::edge_edge>(now, edge_edge_direction(at));
  }

  bool meets(const TimeInterval<Degree>& now, const Instant& at) const {
    return now.from.side * now.to.side < 0 && paths_.weights_keep_sign(features_, now, at) &&
           paths_.has_one_root(paths_.determinant(now));
  }

  /// The interval holds one meeting and the determinant one root, so a change of the determinant's sign
  /// within brackets the meeting.
  FirstMeeting narrowed(const TimeInterval<Degree>& now) const {
    const double width = now.to.time - now.from.time;
    const double root = now.from.time + width * approximate_root(paths_.determinant(now));
    const Instant low = paths_.at(std::max(now.from.time, root - half_bracket));
    const Instant high = paths_.at(std::min(now.to.time, root + half_bracket));
    const double from = low.side == now.from.side ? low.time : now.from.time;
    const double to = high.side == now.to.side ? high.time : now.to.time;
    return {Meeting::hit, Reason::none, from, to};
  }

  Features features_;
  const RelativePaths<Degree>& paths_;
};

}  // namespace

template <int Degree>
FirstMeeting first_meeting(Features features, const Paths<Degree>& paths) {
  const RelativePaths<Degree> relative(paths);
  if (!relative.finite()) return {Meeting::undecided, Reason::not_finite, 0.0, 1.0};
  if (!relative.in_range()) return {Meeting::undecided, Reason::rounding, 0.0, 1.0};
  return Search<Degree>(features, relative).run();
}

template FirstMeeting first_meeting<1>(Features, const Paths<1>&);
template FirstMeeting first_meeting<3>(Features, const Paths<3>&);

}  // namespace tendril::collision
