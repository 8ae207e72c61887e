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
}

void ErrorScale::see(const State& state) {
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  double fastest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double share = speed_share_[static_cast<std::size_t>(i)];
    fastest = std::max(fastest, share * share * state.y.segment<3>(3 * n + 3 * i).squaredNorm());
  }
  see(std::sqrt(fastest));
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
  return largest;
}

}  // namespace tendril
