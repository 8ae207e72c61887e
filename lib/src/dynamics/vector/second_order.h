#pragma once

#include <Eigen/Core>

#include <array>

namespace tendril {

/// What stages of x'' = f give places and velocities.
struct SecondOrder {
  double time;        ///< places move on by this with their rates at the start
  std::size_t count;  ///< of the stages that follow, at most four
  std::array<const Eigen::VectorXd*, 4> k;
  std::array<double, 4> place, rate;  ///< their weights
};

/// Places are the first n numbers of a vector, velocities the n after them: to = y + time * first for places,
/// and for both the sums of the stages' accelerations, in one pass.
void second_order(const Eigen::VectorXd& y, const Eigen::VectorXd& first, const SecondOrder& sum,
                  Eigen::Index n, Eigen::VectorXd& to);

/// The same of four stages, and into `error` the sums alone by the weights of `off`, without a start. False
/// when a number is not finite.
bool second_order_both(const Eigen::VectorXd& y, const Eigen::VectorXd& first, const SecondOrder& sum,
                       const SecondOrder& off, Eigen::Index n, Eigen::VectorXd& to, Eigen::VectorXd& error);

}  // namespace tendril
