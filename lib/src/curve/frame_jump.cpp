#include <tendril/base/error.h>
#include <tendril/curve/frame_jump.h>

#include <algorithm>
#include <cmath>

namespace tendril {
namespace {

constexpr int kSteps = 16;  // between stations
constexpr double kRight = 0.5 * M_PI;
constexpr double kInTwoSteps = 2.0 * M_PI / 3.0;
constexpr double kSlack = 1e-9;  // rad: a right angle is none too many

/// Walks along a curve-pair, and remembers the first thing that stops its frame.
class Walk {
 public:
  Walk(const CurvePair& pair, double start) : pair_(pair), last_(look(start, 0)) {}

  void step(double t, std::size_t station) {
    const CurveFrame next = look(t, station);
    const double bend = std::acos(std::clamp(last_.frame.z.dot(next.frame.z), -1.0, 1.0));
    const double turn = turn_between(last_.frame, next.frame);
    // A jump with a sample in its middle shows in two steps.
    const double bend_of_two = bend_ + bend, turn_of_two = std::abs(turn_ + turn);
    if (bend > kRight + kSlack || bend_of_two > kInTwoSteps) {
      found({FrameJump::Cause::fold_back, station, t, bend_of_two});
    } else if (std::abs(turn) > kRight + kSlack || turn_of_two > kInTwoSteps) {
      found({FrameJump::Cause::flip, station, t, std::max(std::abs(turn), turn_of_two)});
    }
    bend_ = bend;
    turn_ = turn;
    turned_ += turn;
    last_ = next;
  }
  /// The turn in all since the last station.
  void arrive(double t, std::size_t station, bool limited) {
    if (limited && std::abs(turned_) > kRight + kSlack)
      found({FrameJump::Cause::turn, station, t, std::abs(turned_)});
    turned_ = 0.0;
  }
  const std::optional<FrameJump>& jump() const { return jump_; }

 private:
  CurveFrame look(double t, std::size_t station) {
    const CurveFrame at = pair_.frame(t);
    if (at.status == FrameStatus::zero_offset || at.status == FrameStatus::offset_along_tangent)
      found({FrameJump::Cause::no_frame, station, t, 0.0});
    return at;
  }
  void found(const FrameJump& jump) {
    if (!jump_) jump_ = jump;
  }

  const CurvePair& pair_;
  std::optional<FrameJump> jump_;
  CurveFrame last_;
  double turned_ = 0.0, bend_ = 0.0, turn_ = 0.0;
};

std::optional<FrameJump> find(const CurvePair& pair, std::span<const double> stations, bool limited) {
  Walk walk(pair, stations.front());
  for (std::size_t i = 0; i + 1 < stations.size() && !walk.jump(); ++i) {
    const double step = (stations[i + 1] - stations[i]) / kSteps;
    for (int k = 1; k <= kSteps && !walk.jump(); ++k)
      walk.step(k == kSteps ? stations[i + 1] : stations[i] + k * step, i);
    if (!walk.jump()) walk.arrive(stations[i + 1], i, limited);
  }
  return walk.jump();
}

std::string degrees(double angle) {
  return std::to_string(std::lround(angle * 180.0 / M_PI)) + " degrees";
}

}  // namespace

double turn_between(const Frame& a, const Frame& b) {
  const Vec3 carried = rotate_smallest(a.z, b.z, a.y);
  return std::atan2(carried.cross(b.y).dot(b.z), carried.dot(b.y));
}

std::optional<FrameJump> find_frame_jump(const CurvePair& pair, std::span<const double> stations) {
  if (stations.size() < 2 || !std::is_sorted(stations.begin(), stations.end()))
    throw InvalidInput("stations", "not ascending, or fewer than two", "ascending parameters");
  return find(pair, stations, true);
}

std::optional<FrameJump> find_frame_jump(const CurvePair& pair) {
  std::vector<double> knots(pair.knots().knots().begin(), pair.knots().knots().end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  return find(pair, knots, false);
}

std::string describe(const FrameJump& jump, const std::string& nodes) {
  const std::string where =
      " between " + nodes + " " + std::to_string(jump.station) + " and " + std::to_string(jump.station + 1);
  switch (jump.cause) {
    case FrameJump::Cause::no_frame:
      return "no frame" + where + ": the orientation curve meets the primary one, or lies along it";
    case FrameJump::Cause::fold_back:
      return "the curve folds back" + where;
    case FrameJump::Cause::flip:
      return "the frame jumps by " + degrees(jump.angle) + where;
    case FrameJump::Cause::turn:
      break;
  }
  return "the frame turns by " + degrees(jump.angle) + where;
}

}  // namespace tendril
