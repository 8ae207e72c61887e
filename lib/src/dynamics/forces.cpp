#include <tendril/base/error.h>
#include <tendril/dynamics/forces.h>

#include <cmath>
#include <numbers>
#include <string>

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
}

double Gravity::energy(const StateView& state) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < state.p.size(); ++i) sum -= state.mass[i] * g_.dot(state.p[i]);
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
    const double place = options.waves > 1 ? static_cast<double>(k) / (options.waves - 1) - 0.5 : 0.0;
    const auto counter = options.seed * 1024 + static_cast<std::uint64_t>(k) + 1;
    waves_.push_back({options.gust_frequency * std::pow(10.0, place), phase_of(counter)});
  }
}

Vec3 Wind::velocity(const Vec3& x, double t) const {
  const double speed = options_.mean.norm();
  if (speed == 0.0) return Vec3::Zero();
  double gust = 0.0;
  if (options_.gust > 0.0 && !waves_.empty()) {
    const double delay = x.dot(options_.mean) / (speed * speed);
    for (const Wave& wave : waves_)
      gust += std::sin(2 * std::numbers::pi * wave.frequency * (t - delay) + wave.phase);
    gust *= options_.gust / std::sqrt(static_cast<double>(waves_.size()));
  }
  return options_.switched(t) * (1.0 + gust) * options_.mean;
}

void Wind::add(const StateView& state, const Loads& loads) const {
  for (const NodeRange& rod : state.rods) {
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      const Vec3 edge = state.p[i + 1] - state.p[i];
      const double length = edge.norm();
      if (!(length > 0.0)) continue;
      const Vec3 e = edge / length;
      const Vec3 w =
          0.5 * (state.v[i] + state.v[i + 1]) - velocity(0.5 * (state.p[i] + state.p[i + 1]), state.time);
      const Vec3 along = e.dot(w) * e;
      const Vec3 across = w - along;
      const double scale = -0.25 * options_.air_density * state.width[i] * length;
      const Vec3 half = scale * (options_.normal_drag * across.norm() * across +
                                 options_.tangential_drag * along.norm() * along);
      loads.force[i] += half;
      loads.force[i + 1] += half;
    }
  }
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

void PullTowards::check(std::span<const NodeRange> rods) const {
  check_node(rods, rod_, node_);
}

double PullTowards::energy(const StateView& state) const {
  return 0.5 * stiffness_ * (state.p[flat(state, rod_, node_)] - target_).squaredNorm();
}

}  // namespace tendril
