#include <tendril/base/error.h>
#include <tendril/curve/frame_jump.h>
#include <tendril/dynamics/rod_curves.h>

#include <algorithm>
#include <cmath>

namespace tendril {
namespace {

std::string name_of(std::size_t rod) {
  return "rods[" + std::to_string(rod) + "]";
}

/// Curves through orientation masses turn from each to the next by the shorter way, and wander off the circle
/// about the axis where that is far. What the twist of an edge is beyond this [rad] they leave to the turn.
constexpr double kMostByCurve = M_PI / 3.0;

/// Of the nodes of a rod: how far their frames are turned, by twists beyond what the curves show, against the
/// first. None where no edge is twisted that far.
/// \param rest  twist of each edge at rest, which the curves always show
std::vector<double> turns_of(const State& state, const NodeRange& rod, const std::vector<Frame>& frames,
                             std::span<const double> rest) {
  std::vector<double> turn{0.0};
  bool any = false;
  for (std::size_t k = 0; k + 1 < rod.count; ++k) {
    const std::size_t i = rod.first + k;
    const double before = state.twist[i];
    const double twist = before + std::remainder(turn_between(frames[i], frames[i + 1]) - before, 2 * M_PI);
    const double beyond = std::max(0.0, std::abs(twist) - std::max(kMostByCurve, std::abs(rest[k])));
    any = any || beyond > 0.0;
    turn.push_back(turn.back() + std::copysign(beyond, twist));
  }
  if (!any) turn.clear();
  return turn;
}

std::vector<double> solve(const Interpolator& fit, const std::vector<double>& values) {
  std::vector<Vec3> points;
  for (const double x : values) points.emplace_back(x, 0.0, 0.0);
  std::vector<double> out;
  for (const Vec3& control : fit.solve(points)) out.push_back(control.x());
  return out;
}

}  // namespace

RodCurves::RodCurves(std::span<const Rod> rods, int degree, Parametrisation how) {
  if (degree < 1 || degree > kMaxDegree)
    throw InvalidInput("degree", std::to_string(degree), "1 to " + std::to_string(kMaxDegree));
  std::size_t first = 0;
  for (const Rod& rod : rods) {
    const std::size_t n = rod.p.size();
    const std::string name = name_of(rods_.size());
    if (n < 2 || rod.q.size() != n)
      throw InvalidInput(name, std::to_string(n) + " and " + std::to_string(rod.q.size()) + " masses",
                         "at least 2, and as many orientation masses");
    One one{Interpolator(std::min(degree, static_cast<int>(n) - 1), rod.p, how), first, {}, {}, {}};
    const NodeFrames frames = node_frames(rod.p, rod.q);
    for (std::size_t i = 0; i < n; ++i) {
      if (frames.status[i] != FrameStatus::ok)
        throw InvalidInput(name + " node " + std::to_string(i), "no frame", "a rest shape with frames");
      const Vec3 arm = rod.q[i] - rod.p[i];
      one.by_m.push_back(arm.dot(frames.frame[i].y));
      one.by_t.push_back(arm.dot(frames.frame[i].z));
      if (i > 0) one.twist.push_back(turn_between(frames.frame[i - 1], frames.frame[i]));
    }
    rods_.push_back(std::move(one));
    first += n;
  }
}

CurvePair RodCurves::through(std::size_t rod, Points p, Points q) const {
  const Interpolator& fit = rods_.at(rod).fit;
  return {fit.knots(), fit.solve(p), fit.solve(q)};
}

void RodCurves::update(const System& system, const State& state, System::Workspace& work,
                       std::span<CurvePair> pairs) const {
  if (pairs.size() != size() || system.rods().size() != size())
    throw InvalidInput("pairs", std::to_string(pairs.size()) + " of them", "one for each rod");
  std::vector<Vec3> q = system.orientation_masses(state, work);
  if (q.empty() && size() > 0) throw InvalidInput("state", "a node without a frame", "a state with frames");
  const std::vector<Frame> frames =
      system.twist_count() > 0 ? system.frames(state, work) : std::vector<Frame>{};
  std::vector<Vec3> p;
  for (std::size_t r = 0; r < size(); ++r) {
    const NodeRange& range = system.rods()[r];
    p.clear();
    for (std::size_t i = range.first; i < range.first + range.count; ++i)
      p.push_back(state.y.segment<3>(3 * static_cast<Eigen::Index>(i)));
    const Interpolator& fit = rods_[r].fit;
    const std::vector<double> turn =
        frames.empty() ? std::vector<double>{} : turns_of(state, range, frames, rods_[r].twist);
    for (std::size_t i = 0; i < turn.size(); ++i) {
      const std::size_t node = range.first + i;
      q[node] = p[i] + rotate_about(frames[node].z, -turn[i], q[node] - p[i]);
    }
    pairs[r].set_turn(turn.empty() ? turn : solve(fit, turn));
    pairs[r].set_control_points(fit.solve(p), fit.solve(Points(q).subspan(range.first, range.count)));
  }
}

std::vector<CurvePair> RodCurves::pairs(const System& system, const State& state,
                                        System::Workspace& work) const {
  std::vector<CurvePair> pairs;
  for (const One& one : rods_) {
    const std::vector<Vec3> none(one.by_m.size(), Vec3::Zero());
    pairs.emplace_back(one.fit.knots(), none, none);
  }
  update(system, state, work, pairs);
  return pairs;
}

std::vector<Vec3> RodCurves::arms(const StateView& state, std::size_t rod) const {
  const One& one = rods_.at(rod);
  std::vector<Vec3> arms;
  arms.reserve(one.by_m.size());
  for (std::size_t i = 0; i < one.by_m.size(); ++i) {
    const Vec3& m = state.m[one.first + i];
    if (m.isZero(0.0))
      throw InvalidInput(name_of(rod), "its twist state is left out",
                         "directors: a force that asks for them says twists()");
    arms.push_back(one.by_m[i] * m + one.by_t[i] * state.t[one.first + i]);
  }
  return arms;
}

CurvePair RodCurves::pair(const StateView& state, std::size_t rod) const {
  std::vector<Vec3> q = arms(state, rod);
  const Points p = state.p.subspan(rods_[rod].first, q.size());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = p[i] + q[i];
  return through(rod, p, q);
}

CurvePair RodCurves::rates(const StateView& state, std::size_t rod) const {
  std::vector<Vec3> q = arms(state, rod);
  const std::size_t first = rods_[rod].first;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = state.v[first + i] + state.turn[first + i].cross(q[i]);
  return through(rod, state.v.subspan(first, q.size()), q);
}

std::vector<std::vector<double>> RodCurves::interpolation(std::size_t rod) const {
  const One& one = rods_.at(rod);
  const std::size_t n = one.by_m.size();
  std::vector<std::vector<double>> rows(n, std::vector<double>(n));
  std::vector<Vec3> unit(n, Vec3::Zero());
  for (std::size_t k = 0; k < n; ++k) {
    unit[k].x() = 1.0;
    const std::vector<Vec3> column = one.fit.solve(unit);
    for (std::size_t i = 0; i < n; ++i) rows[i][k] = column[i].x();
    unit[k].x() = 0.0;
  }
  return rows;
}

double RodCurves::gain(std::size_t rod) const {
  double most = 0.0;
  for (const std::vector<double>& row : interpolation(rod)) {
    double sum = 0.0;
    for (const double weight : row) sum += std::abs(weight);
    most = std::max(most, sum);
  }
  return most;
}

void RodCurves::add_loads(const StateView& state, std::size_t rod, const ControlForces& forces,
                          const Loads& loads) const {
  const MassLoads on_masses = loads_on_masses(rods_.at(rod).fit, forces, arms(state, rod));
  for (std::size_t i = 0; i < on_masses.force.size(); ++i) {
    loads.force[rods_[rod].first + i] += on_masses.force[i];
    loads.torque[rods_[rod].first + i] += on_masses.torque[i];
  }
}

}  // namespace tendril
