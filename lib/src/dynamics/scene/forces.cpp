#include <tendril/base/error.h>
#include <tendril/dynamics/forces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "dynamics/vector/drag.h"
#include "dynamics/vector/waves.h"

namespace tendril {
namespace {

const Vec3& finite(const char* what, const Vec3& v) {
  if (!is_finite(v)) throw InvalidInput(what, "not finite", "three finite numbers");
  return v;
}

double not_negative(const char* what, double value) {
  if (!(value >= 0.0) || !std::isfinite(value))
    throw InvalidInput(what, std::to_string(value), "a number >= 0");
  return value;
}

/// Phase in [0, 2 pi) from a counter (SplitMix64), the same everywhere.
double phase_of(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return 2 * std::numbers::pi * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

std::size_t flat(const StateView& state, std::size_t rod, std::size_t node) {
  return state.rods[rod].first + node;
}

void check_node(std::span<const NodeRange> rods, std::size_t rod, std::size_t node) {
  if (rod >= rods.size())
    throw InvalidInput("rod", std::to_string(rod), "less than the " + std::to_string(rods.size()) + " rods");
  if (node >= rods[rod].count)
    throw InvalidInput("node", std::to_string(node),
                       "less than the rod's " + std::to_string(rods[rod].count) + " nodes");
}

}  // namespace

Gravity::Gravity(const Vec3& acceleration) : g_(finite("gravity", acceleration)) {}

void Gravity::add(const StateView& state, const Loads& loads) const {
  for (std::size_t i = 0; i < state.p.size(); ++i) loads.force[i] += state.mass[i] * g_;
  for (std::size_t b = 0; b < loads.bodies.size(); ++b) loads.bodies[b].force += state.bodies[b].mass * g_;
}

double Gravity::energy(const StateView& state) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < state.p.size(); ++i) sum -= state.mass[i] * g_.dot(state.p[i]);
  for (const BodyView& body : state.bodies) sum -= body.mass * g_.dot(body.position);
  return sum;
}

Wind::Wind(const WindOptions& options) : options_(options) {
  finite("wind mean", options.mean);
  not_negative("gust", options.gust);
  not_negative("gust frequency", options.gust_frequency);
  not_negative("air density", options.air_density);
  not_negative("normal drag", options.normal_drag);
  not_negative("tangential drag", options.tangential_drag);
  if (options.waves < 0 || options.waves > 1000)
    throw InvalidInput("waves", std::to_string(options.waves), "0 to 1000");
  for (int k = 0; k < options.waves; ++k) {
    const double exponent = options.waves > 1 ? static_cast<double>(k) / (options.waves - 1) - 0.5 : 0.0;
    const auto counter = options.seed * 1024 + static_cast<std::uint64_t>(k) + 1;
    waves_.push_back({options.gust_frequency * std::pow(10.0, exponent), phase_of(counter)});
  }
}

namespace {

/// The air along the mean wind at a time, over |mean|.
class Gusts {
 public:
  /// \param waves  frequencies and phases
  template <class Waves>
  Gusts(const WindOptions& options, const Waves& waves, double t)
      : mean_(options.mean), square_(options.mean.squaredNorm()), switched_(options.switched(t)) {
    if (!(square_ > 0.0) || options.gust == 0.0) return;
    const double size = options.gust / std::sqrt(static_cast<double>(waves.size()));
    carried_.reserve(waves.size());
    for (const auto& wave : waves) {
      const double omega = 2 * std::numbers::pi * wave.frequency, phase = omega * t + wave.phase;
      carried_.push_back({size * std::sin(phase), size * std::cos(phase), omega});
    }
  }

  /// The delay of a point is its product with this.
  Vec3 delays() const { return square_ > 0.0 ? Vec3(mean_ / square_) : Vec3(Vec3::Zero()); }

  /// How long after the origin the air passes a point.
  double delay(const Vec3& x) const { return square_ > 0.0 ? x.dot(mean_) / square_ : 0.0; }
  /// `factor` of each delay.
  void find(std::span<const double> delay, std::span<double> factor) const {
    std::fill(factor.begin(), factor.end(), 1.0);
    add_waves(carried_, delay, factor);
    for (double& f : factor) f *= switched_;
  }
  /// And its derivatives by delays.
  void find_slopes(std::span<const double> delay, std::span<double> slope) const {
    std::vector<CarriedWave> by_delay;
    for (const auto& [s, c, omega] : carried_) by_delay.push_back({-omega * c, omega * s, omega});
    std::fill(slope.begin(), slope.end(), 0.0);
    add_waves(by_delay, delay, slope);
    for (double& d : slope) d *= switched_;
  }
  /// Of the air's velocity by place, of the slope there.
  Mat3 gradient(double slope) const {
    return square_ > 0.0 ? Mat3((slope / square_) * mean_ * mean_.transpose()) : Mat3::Zero();
  }

 private:
  Vec3 mean_;
  double square_, switched_;
  std::vector<CarriedWave> carried_;
};

/// Edges that have a length, in blocks: sines of many at once cost a tenth of what they do one by one.
/// \param each  takes first nodes of a block's edges and the delays of their middles
template <class Each>
void in_blocks(const StateView& state, const Gusts& gusts, Each&& each) {
  constexpr std::size_t kBlock = ExposedEdges::kMost;
  std::array<std::size_t, kBlock> edges;
  std::array<double, kBlock> delay;
  std::size_t count = 0;
  const auto flush = [&] {
    each(std::span(edges).first(count), std::span<const double>(delay).first(count));
    count = 0;
  };
  for (const NodeRange& rod : state.rods)
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      if ((state.p[i + 1] - state.p[i]).isZero(0.0)) continue;
      edges[count] = i;
      delay[count++] = gusts.delay(0.5 * (state.p[i] + state.p[i + 1]));
      if (count == kBlock) flush();
    }
  flush();
}

}  // namespace

Vec3 Wind::velocity(const Vec3& x, double t) const {
  const Gusts gusts(options_, waves_, t);
  const double delay = gusts.delay(x);
  double factor = 0.0;
  gusts.find({&delay, 1}, {&factor, 1});
  return factor * options_.mean;
}

double Wind::period() const {
  double shortest = options_.switched.period();
  if (options_.gust > 0.0 && options_.mean.norm() > 0.0)
    for (const Wave& wave : waves_)
      if (wave.frequency > 0.0) shortest = std::min(shortest, 1.0 / wave.frequency);
  return shortest;
}

Mat3 Wind::velocity_gradient(const Vec3& x, double t) const {
  const Gusts gusts(options_, waves_, t);
  const double delay = gusts.delay(x);
  double slope = 0.0;
  gusts.find_slopes({&delay, 1}, {&slope, 1});
  return gusts.gradient(slope);
}

namespace {

/// An edge in the air, as derivatives need it: its unit vector and length, the flow across and along it, and
/// what makes the drag of half of it.
struct Exposed {
  Exposed(const Vec3& edge, const Vec3& flow, double per_length, const WindOptions& options)
      : length(edge.norm()),
        e(edge / length),
        q(e.dot(flow)),
        across(flow - q * e),
        normal(per_length * length * options.normal_drag),
        tangential(per_length * length * options.tangential_drag) {}

  Vec3 drag() const { return normal * across.norm() * across + tangential * std::abs(q) * q * e; }

  /// Of the drag by the flow.
  Mat3 by_flow() const {
    const Mat3 along = e * e.transpose();
    return normal * by_across() * (Mat3::Identity() - along) + 2 * tangential * std::abs(q) * along;
  }
  /// Of the drag by the edge, the flow being what it is.
  Mat3 by_edge() const {
    const Mat3 turn = (Mat3::Identity() - e * e.transpose()) / length;
    const Vec3 by_q = turn * (q * e + across);  // of q; turn is symmetric
    const Mat3 of_across = -q * turn - e * by_q.transpose();
    return normal * by_across() * of_across +
           tangential * (2 * std::abs(q) * e * by_q.transpose() + std::abs(q) * q * turn) +
           drag() * e.transpose() / length;
  }

  double length;
  Vec3 e;
  double q;
  Vec3 across;
  double normal, tangential;

 private:
  Mat3 by_across() const {
    const double size = across.norm();
    if (!(size > 0.0)) return Mat3::Zero();
    return size * Mat3::Identity() + across * across.transpose() / size;
  }
};

Exposed exposed_at(const StateView& state, std::size_t i, const Vec3& air, const WindOptions& options) {
  return {state.p[i + 1] - state.p[i], 0.5 * (state.v[i] + state.v[i + 1]) - air,
          -0.25 * options.air_density * state.width[i], options};
}

}  // namespace

/// Between two rods there is an edge without a width.
void Wind::add(const StateView& state, const Loads& loads) const {
  const Gusts gusts(options_, waves_, state.time);
  const double half = -0.25 * options_.air_density;
  const DragPerLength by{options_.mean, half * options_.normal_drag, half * options_.tangential_drag};
  ExposedEdges edges;
  auto rod = state.rods.begin();
  for (std::size_t first = 0; first + 1 < state.p.size(); first += ExposedEdges::kMost) {
    const std::size_t count = std::min(ExposedEdges::kMost, state.p.size() - 1 - first);
    expose(state.p.subspan(first, count + 1), state.v.subspan(first, count + 1),
           state.width.subspan(first, count), gusts.delays(), edges);
    for (; rod != state.rods.end() && rod->first + rod->count <= first + count; ++rod)
      edges.width[rod->first + rod->count - 1 - first] = 0.0;
    gusts.find(std::span(edges.delay).first(count), std::span(edges.air).first(count));
    drag(by, count, edges);
    put_drag(edges, loads.force.subspan(first, count + 1));
  }
}

Couplings Wind::couplings(std::span<const NodeRange>) const {
  return Couplings::within(1).with(
      [this](const StateView& state, LoadDerivatives& to) { add_derivatives(state, to); });
}

void Wind::add_derivatives(const StateView& state, LoadDerivatives& to) const {
  const Gusts gusts(options_, waves_, state.time);
  std::vector<double> factor, slope;
  in_blocks(state, gusts, [&](std::span<const std::size_t> edges, std::span<const double> delay) {
    factor.resize(edges.size());
    slope.resize(edges.size());
    gusts.find(delay, factor);
    gusts.find_slopes(delay, slope);
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const std::size_t i = edges[k];
      const Exposed exposed = exposed_at(state, i, factor[k] * options_.mean, options_);
      const Mat3 by_velocity = 0.5 * exposed.by_flow();
      const Mat3 by_middle = -by_velocity * gusts.gradient(slope[k]);
      const Mat3 by_edge = exposed.by_edge();
      for (const std::size_t at : {i, i + 1}) {
        to.add_by_velocity(at, i, by_velocity);
        to.add_by_velocity(at, i + 1, by_velocity);
        to.add_by_position(at, i, by_middle - by_edge);
        to.add_by_position(at, i + 1, by_middle + by_edge);
      }
    }
  });
}

PointLoad::PointLoad(Kind kind, std::size_t rod, std::size_t node, const Vec3& direction, Signal signal)
    : kind_(kind),
      rod_(rod),
      node_(node),
      direction_(finite("direction", direction)),
      signal_(std::move(signal)) {}

void PointLoad::add(const StateView& state, const Loads& loads) const {
  const MutablePoints to = kind_ == Kind::force ? loads.force : loads.torque;
  to[flat(state, rod_, node_)] += signal_(state.time) * direction_;
}

Couplings PointLoad::couplings(std::span<const NodeRange> rods) const {
  if (kind_ == Kind::force) return Couplings::none();
  return Couplings::among({rods[rod_].first + node_});  // a torque acts through the tangent
}

void PointLoad::check(std::span<const NodeRange> rods) const {
  check_node(rods, rod_, node_);
}

double PointLoad::energy(const StateView& state) const {
  return -signal_(state.time) * direction_.dot(state.p[flat(state, rod_, node_)]);
}

PullTowards::PullTowards(std::size_t rod, std::size_t node, const Vec3& target, double stiffness)
    : rod_(rod),
      node_(node),
      target_(finite("target", target)),
      stiffness_(not_negative("stiffness", stiffness)) {}

void PullTowards::add(const StateView& state, const Loads& loads) const {
  const std::size_t i = flat(state, rod_, node_);
  loads.force[i] -= stiffness_ * (state.p[i] - target_);
}

Couplings PullTowards::couplings(std::span<const NodeRange> rods) const {
  const std::size_t i = rods[rod_].first + node_;
  return Couplings::among({i}).with([i, k = stiffness_](const StateView&, LoadDerivatives& to) {
    to.add_by_position(i, i, -k * Mat3::Identity());
  });
}

void PullTowards::check(std::span<const NodeRange> rods) const {
  check_node(rods, rod_, node_);
}

double PullTowards::energy(const StateView& state) const {
  return 0.5 * stiffness_ * (state.p[flat(state, rod_, node_)] - target_).squaredNorm();
}

}  // namespace tendril
