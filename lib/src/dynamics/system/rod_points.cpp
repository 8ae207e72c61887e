#include <tendril/base/error.h>
#include <tendril/dynamics/rod_points.h>

#include <algorithm>
#include <string>
#include <utility>

namespace tendril {
namespace {

constexpr double kMost = 1e150;  // squares of what is farther overflow

bool fits(Points points) {
  return std::all_of(points.begin(), points.end(),
                     [](const Vec3& x) { return x.cwiseAbs().maxCoeff() < kMost; });
}

}  // namespace

RodPoints::RodPoints(RodCurves curves, std::vector<std::size_t> rods,
                     std::shared_ptr<const LoadedPoints> points)
    : curves_(std::move(curves)), rods_(std::move(rods)), points_(std::move(points)) {
  if (!points_) throw InvalidInput("points", "none", "bound points");
  if (rods_.empty()) throw InvalidInput("rods", "none", "one for each curve-pair");
  for (std::size_t i = 0; i < rods_.size(); ++i)
    if (rods_[i] >= curves_.size())
      throw InvalidInput("rods[" + std::to_string(i) + "]", std::to_string(rods_[i]),
                         "below " + std::to_string(curves_.size()));
}

std::vector<CurvePair> RodPoints::pairs(const StateView& state) const {
  return pairs(state, std::vector<bool>(rods_.size(), true));
}

std::vector<CurvePair> RodPoints::rates(const StateView& state) const {
  return rates(state, std::vector<bool>(rods_.size(), true));
}

namespace {

CurvePair at_zero(const KnotVector& knots) {
  const std::vector<Vec3> none(static_cast<std::size_t>(knots.control_points()), Vec3::Zero());
  return {knots, none, none};
}

}  // namespace

std::vector<CurvePair> RodPoints::pairs(const StateView& state, const std::vector<bool>& which) const {
  std::vector<CurvePair> result;
  if (!fits(state.p)) return result;
  for (std::size_t i = 0; i < rods_.size(); ++i)
    result.push_back(which[i] ? curves_.pair(state, rods_[i]) : at_zero(curves_.knots(rods_[i])));
  return result;
}

std::vector<CurvePair> RodPoints::rates(const StateView& state, const std::vector<bool>& which) const {
  std::vector<CurvePair> result;
  if (!fits(state.v) || !fits(state.turn)) return result;
  for (std::size_t i = 0; i < rods_.size(); ++i)
    result.push_back(which[i] ? curves_.rates(state, rods_[i]) : at_zero(curves_.knots(rods_[i])));
  return result;
}

void RodPoints::add_loads(const StateView& state, std::span<const ControlForces> forces,
                          const Loads& loads) const {
  const auto none = [](const std::vector<Vec3>& all) {
    return std::all_of(all.begin(), all.end(), [](const Vec3& f) { return f.isZero(0.0); });
  };
  for (std::size_t i = 0; i < rods_.size(); ++i)
    if (!none(forces[i].primary) || !none(forces[i].orientation))
      curves_.add_loads(state, rods_[i], forces[i], loads);
}

}  // namespace tendril
