#include "error_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/scene/model.h"

namespace tendril {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// How many steps' errors may add up before a flight, and the root of how many in it, over the tolerance.
constexpr double kBeforeFlight = 40.0, kInFlight = 3.0;
// How large a rigid body is, in radii of gyration: about a ball's diameter.
constexpr double kBodyLength = 3.0;
// What moves in itself less than this, of the common speed and of a length in a flight, does so by rounding.
constexpr double kStill = 1e-6;

double length_of(const Rod& rod) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < rod.p.size(); ++i) length += (rod.p[i + 1] - rod.p[i]).norm();
  return length;
}

/// A mass much lighter than the rod's others may ring fast and carry next to nothing: its speed counts by
/// the root of what it carries, its place in full.
void add_shares(const Rod& rod, std::vector<double>& shares) {
  double mass = 0.0;
  for (const double m : rod.mass) mass += m;
  const auto count = static_cast<double>(rod.mass.size());
  for (const double m : rod.mass)
    shares.push_back(mass > 0.0 ? std::clamp(std::sqrt(2.0 * m * count / mass), 0.01, 1.0) : 1.0);
}

/// A vector per node, in a part of y that begins there.
auto of_node(const Eigen::VectorXd& y, Eigen::Index begin, std::size_t node) {
  return y.segment<3>(begin + 3 * static_cast<Eigen::Index>(node));
}

Vec3 mean(const Tree& tree, const std::vector<double>& mass, const Eigen::VectorXd& y, Eigen::Index begin) {
  Vec3 sum = Vec3::Zero();
  double all = 0.0;
  for (const std::size_t i : tree.nodes) {
    sum += mass[i] * of_node(y, begin, i);
    all += mass[i];
  }
  return sum / all;
}

}  // namespace

ErrorScale::ErrorScale(const System& system) : system_(system), trees_(trees_of(model_of(system))) {
  for (const Rod& rod : system.scene().rods) {
    rod_length_.push_back(length_of(rod));
    longest_ = std::max(longest_, rod_length_.back());
    mass_.insert(mass_.end(), rod.mass.begin(), rod.mass.end());
    add_shares(rod, speed_share_);
  }
  for (const Tree& tree : trees_) {
    tree_mass_.push_back(0.0);
    for (const std::size_t i : tree.nodes) tree_mass_.back() += mass_[i];
  }
  flights_.resize(trees_.size(), {kNever, 0.0});
  for (const Body& body : system_.scene().bodies)
    body_size_.push_back(std::sqrt(body.inertia.trace() / 3.0 / body.mass));
  if (rod_length_.empty()) longest_ = *std::max_element(body_size_.begin(), body_size_.end());
  for (const double size : body_size_) body_length_.push_back(std::min(longest_, kBodyLength * size));
  speeds_.resize(trees_.size() + body_size_.size());
}

/// Of several anchors the last to let go counts.
void ErrorScale::look_ahead(double now, double until) {
  const Model& model = model_of(system_);
  const std::vector<std::size_t> rod_of = model.rods_of_nodes();
  std::vector<double> held_until(model.nodes, now);
  for (const Anchor& anchor : model.anchors) {
    double& last = held_until[model.rods[anchor.rod].first + anchor.node];
    last = std::max(last, anchor.until);
  }
  flights_.assign(trees_.size(), {kNever, 0.0});
  for (std::size_t b = 0; b < trees_.size(); ++b) {
    double length = 0.0, begin = now;
    for (const std::size_t i : trees_[b].nodes) {
      length = std::max(length, rod_length_[rod_of[i]]);
      begin = std::max(begin, held_until[i]);
    }
    if (begin < until) flights_[b] = {length / (until - begin), (trees_[b].free ? until : begin) - now};
  }
}

double ErrorScale::own_speed(std::size_t part) const {
  return std::max(least_speed(), speeds_[part].own);
}

/// That errors of what goes on in a flight count by. Up to its beginning those of all steps add up; in the
/// flight, where they are seen beside what keeps the energy, some go one way and some the other.
double ErrorScale::flying_speed(std::size_t tree, double h) const {
  const Flight& flight = flights_[tree];
  if (flight.speed == kNever || speeds_[tree].own < kStill * std::max(flight.speed, speeds_[tree].common))
    return own_speed(tree);
  const double part = h / flight.over;
  const double share = trees_[tree].free ? kInFlight * std::sqrt(part) : kBeforeFlight * part;
  return std::min(own_speed(tree), flight.speed * std::min(1.0, share));
}

double ErrorScale::share_of_flight() const {
  double least = 1.0;
  for (std::size_t b = 0; b < trees_.size(); ++b)
    if (!trees_[b].free) least = std::min(least, flights_[b].speed / own_speed(b));
  return least;
}

/// How fast an error of the velocities turns a free tree about its centre: the speed at a radius of gyration.
double ErrorScale::turn_of(std::size_t tree, const Eigen::VectorXd& error, const Eigen::VectorXd& y) const {
  const Eigen::Index v = 3 * static_cast<Eigen::Index>(system_.node_count());
  const Vec3 centre = mean(trees_[tree], mass_, y, 0);
  Vec3 momentum = Vec3::Zero();
  double inertia = 0.0;
  for (const std::size_t i : trees_[tree].nodes) {
    const Vec3 arm = of_node(y, 0, i) - centre;
    momentum += mass_[i] * arm.cross(Vec3(of_node(error, v, i)));
    inertia += mass_[i] * arm.squaredNorm();
  }
  return inertia > 0.0 ? momentum.norm() / std::sqrt(inertia * tree_mass_[tree]) : 0.0;
}

/// The speed of a body's surface where it spins: that of its matter at a radius of gyration.
double ErrorScale::speed_of(std::size_t body, const Eigen::VectorXd& y) const {
  const auto k = 3 * static_cast<Eigen::Index>(body_size_.size());
  const Eigen::Index u = y.size() - 1 - 2 * k + 3 * static_cast<Eigen::Index>(body);
  return y.segment<3>(u).norm() + body_size_[body] * y.segment<3>(u + k).norm();
}

double ErrorScale::norm_of_bodies(const Eigen::VectorXd& error) const {
  const auto k = 3 * static_cast<Eigen::Index>(body_size_.size());
  const Eigen::Index x = error.size() - 1 - 4 * k;
  double largest = 0.0;
  for (std::size_t b = 0; b < body_size_.size(); ++b) {
    const double length = body_length_[b], speed = own_speed(trees_.size() + b);
    const auto part = [&](Eigen::Index kind) {
      return error.segment<3>(x + kind * k + 3 * static_cast<Eigen::Index>(b)).cwiseAbs().maxCoeff();
    };
    largest =
        std::max({largest, part(0) / length, part(1), part(2) / speed, part(3) * body_size_[b] / speed});
  }
  return largest;
}

void ErrorScale::see(const State& state) {
  double own = 0.0;
  for (std::size_t b = 0; b < body_size_.size(); ++b) {
    const double speed = speed_of(b, state.y);
    take(trees_.size() + b, {speed, 0.0});
    own += 0.5 * system_.scene().bodies[b].mass * speed * speed;
  }
  double all = own;
  const Eigen::Index v = 3 * static_cast<Eigen::Index>(system_.node_count());
  for (std::size_t b = 0; b < trees_.size(); ++b) {
    const Vec3 common = trees_[b].free ? mean(trees_[b], mass_, state.y, v) : Vec3(Vec3::Zero());
    double fastest = 0.0;
    double kinetic = 0.0;
    for (const std::size_t i : trees_[b].nodes) {
      const double square = (of_node(state.y, v, i) - common).squaredNorm();
      fastest = std::max(fastest, speed_share_[i] * speed_share_[i] * square);
      kinetic += mass_[i] * square;
    }
    take(b, {std::sqrt(fastest), common.norm()});
    own += 0.5 * kinetic;
    all += 0.5 * (kinetic + tree_mass_[b] * common.squaredNorm());
  }
  most_own_kinetic_ = std::max(most_own_kinetic_, own);
  most_kinetic_ = std::max(most_kinetic_, all);
}

void ErrorScale::see_start(const Eigen::VectorXd& rate) {
  const Eigen::Index v = 3 * static_cast<Eigen::Index>(system_.node_count());
  const auto k = 3 * static_cast<Eigen::Index>(body_size_.size());
  for (std::size_t b = 0; b < body_size_.size(); ++b) {
    const double a = rate.segment<3>(rate.size() - 1 - 2 * k + 3 * static_cast<Eigen::Index>(b)).norm();
    take(trees_.size() + b, {std::sqrt(a * body_length_[b]), 0.0});
  }
  for (std::size_t b = 0; b < trees_.size(); ++b) {
    const Vec3 common = trees_[b].free ? mean(trees_[b], mass_, rate, v) : Vec3(Vec3::Zero());
    double moved = 0.0;
    for (const std::size_t i : trees_[b].nodes) moved += mass_[i] * (of_node(rate, v, i) - common).norm();
    take(b, {std::sqrt(moved / tree_mass_[b] * longest_), std::sqrt(common.norm() * longest_)});
  }
}

void ErrorScale::see(const std::vector<Speed>& speeds) {
  for (std::size_t b = 0; b < speeds_.size() && b < speeds.size(); ++b) take(b, speeds[b]);
}

void ErrorScale::take(std::size_t part, const Speed& speed) {
  Speed& most = speeds_[part];
  most.own = std::max(most.own, speed.own);
  most.common = std::max(most.common, speed.common);
  fastest_ = std::max({fastest_, most.own, most.common});
}

double ErrorScale::least_speed() const {
  const double least = std::max(kLeast * fastest_, slowest_);
  return least > 0.0 ? least : longest_;
}

double ErrorScale::energy() const {
  double sum = energy_of_bodies();
  for (std::size_t b = 0; b < trees_.size(); ++b)
    sum += 0.5 * tree_mass_[b] * speeds_[b].own * speeds_[b].own;
  return sum;
}

double ErrorScale::energy_of_bodies() const {
  double sum = 0.0;
  for (std::size_t b = 0; b < body_size_.size(); ++b) {
    const double own = speeds_[trees_.size() + b].own;
    sum += 0.5 * system_.scene().bodies[b].mass * own * own;
  }
  return sum;
}

double ErrorScale::common_energy() const {
  double sum = 0.0;
  for (std::size_t b = 0; b < trees_.size(); ++b)
    sum += 0.5 * tree_mass_[b] * speeds_[b].common * speeds_[b].common;
  return sum;
}

double ErrorScale::rate() const {
  double fastest = 0.0;
  for (const Speed& speed : speeds_) fastest = std::max(fastest, speed.own);
  return fastest / longest_;
}

double ErrorScale::velocity_norm(std::size_t tree, double speed, const Eigen::VectorXd& error) const {
  const Eigen::Index v = 3 * static_cast<Eigen::Index>(system_.node_count());
  Vec3 common = Vec3::Zero();
  double largest = 0.0;
  if (trees_[tree].free) {
    common = mean(trees_[tree], mass_, error, v);
    largest = common.cwiseAbs().maxCoeff() / std::max(speed, speeds_[tree].common);
  }
  for (const std::size_t i : trees_[tree].nodes)
    largest =
        std::max(largest, speed_share_[i] * (of_node(error, v, i) - common).cwiseAbs().maxCoeff() / speed);
  return largest;
}

double ErrorScale::turning_norm(std::size_t tree, double speed, const Eigen::VectorXd& error) const {
  const Model& model = model_of(system_);
  double largest = 0.0;
  for (const std::size_t i : trees_[tree].nodes) {
    if (!model.has_twist(i)) continue;
    largest = std::max({largest, std::abs(error[model.theta_begin() + model.twist_index[i]]),
                        std::abs(error[model.spin_begin() + model.twist_index[i]]) * longest_ / speed});
  }
  return largest;
}

double ErrorScale::norm(const Eigen::VectorXd& error, const Eigen::VectorXd& y, double h) const {
  double largest = 0.0;
  for (std::size_t r = 0; r < rod_length_.size(); ++r) {
    const auto first = 3 * static_cast<Eigen::Index>(system_.rods()[r].first);
    const auto count = 3 * static_cast<Eigen::Index>(system_.rods()[r].count);
    largest = std::max(largest, error.segment(first, count).cwiseAbs().maxCoeff() / rod_length_[r]);
  }
  for (std::size_t b = 0; b < trees_.size(); ++b) {
    const double speed = trees_[b].free ? own_speed(b) : flying_speed(b, h);
    largest = std::max(largest, velocity_norm(b, speed, error));
    if (trees_[b].free) largest = std::max(largest, turn_of(b, error, y) / flying_speed(b, h));
    if (system_.twist_count() > 0) largest = std::max(largest, turning_norm(b, speed, error));
  }
  return std::max(largest, norm_of_bodies(error));
}

}  // namespace tendril
