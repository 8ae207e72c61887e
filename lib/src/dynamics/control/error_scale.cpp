#include "error_scale.h"

#include <algorithm>
#include <cmath>

namespace tendril {
namespace {

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

}  // namespace

ErrorScale::ErrorScale(const System& system) : system_(system) {
  for (const Rod& rod : system.scene().rods) {
    rod_length_.push_back(length_of(rod));
    longest_ = std::max(longest_, rod_length_.back());
    add_shares(rod, speed_share_);
  }
  for (const Body& body : system_.scene().bodies)
    body_size_.push_back(std::sqrt(body.inertia.trace() / 3.0 / body.mass));
  if (rod_length_.empty()) longest_ = *std::max_element(body_size_.begin(), body_size_.end());
}

/// The speed of a body's surface where it spins: that of its matter at a radius of gyration.
void ErrorScale::see_bodies(const State& state) {
  const auto k = 3 * static_cast<Eigen::Index>(body_size_.size());
  const Eigen::Index u = state.y.size() - 1 - 2 * k;
  for (Eigen::Index b = 0; b < k / 3; ++b)
    see(state.y.segment<3>(u + 3 * b).norm() +
        body_size_[static_cast<std::size_t>(b)] * state.y.segment<3>(u + k + 3 * b).norm());
}

double ErrorScale::norm_of_bodies(const Eigen::VectorXd& error, double speed) const {
  const auto k = 3 * static_cast<Eigen::Index>(body_size_.size());
  const Eigen::Index x = error.size() - 1 - 4 * k;
  double largest = 0.0;
  for (Eigen::Index b = 0; b < k / 3; ++b) {
    const auto part = [&](Eigen::Index kind) {
      return error.segment<3>(x + kind * k + 3 * b).cwiseAbs().maxCoeff();
    };
    largest = std::max({largest, part(0) / longest_, part(1), part(2) / speed,
                        part(3) * body_size_[static_cast<std::size_t>(b)] / speed});
  }
  return largest;
}

void ErrorScale::see(const State& state) {
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  double fastest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double share = speed_share_[static_cast<std::size_t>(i)];
    fastest = std::max(fastest, share * share * state.y.segment<3>(3 * n + 3 * i).squaredNorm());
  }
  see(std::sqrt(fastest));
  see_bodies(state);
}

double ErrorScale::norm(const Eigen::VectorXd& error) const {
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  const auto m = static_cast<Eigen::Index>(system_.twist_count());
  const double speed = speed_ > 0.0 ? speed_ : longest_;
  double largest = 0.0;
  for (std::size_t r = 0; r < rod_length_.size(); ++r) {
    const auto first = 3 * static_cast<Eigen::Index>(system_.rods()[r].first);
    const auto count = 3 * static_cast<Eigen::Index>(system_.rods()[r].count);
    largest = std::max(largest, error.segment(first, count).cwiseAbs().maxCoeff() / rod_length_[r]);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    largest = std::max(largest, speed_share_[static_cast<std::size_t>(i)] *
                                    error.segment<3>(3 * n + 3 * i).cwiseAbs().maxCoeff() / speed);
  if (m > 0) {
    largest = std::max(largest, error.segment(6 * n, m).cwiseAbs().maxCoeff());
    largest = std::max(largest, error.segment(6 * n + m, m).cwiseAbs().maxCoeff() * longest_ / speed);
  }
  return std::max(largest, norm_of_bodies(error, speed));
}

}  // namespace tendril
