#pragma once

#include <Eigen/Core>
#include <vector>

namespace tendril {

/// Where the four numbers of a pivot, a place and an angle, stand in y, and what they weigh.
struct PivotLayout {
  std::vector<Eigen::Index> place, rate;  ///< per pivot, of three numbers in y
  std::vector<Eigen::Index> angle;        ///< likewise, in theta and in the spins, or -1
  std::vector<double> mass, damping;      ///< per pivot four, 0 of what is held or not there
  Eigen::Index theta_begin = 0, spin_begin = 0;
};

/// x = r_x and b = M (r_u + s r_x) + D r_x, four numbers a pivot, of r laid out like y: M the masses, D the
/// damping.
void put_right(const PivotLayout& at, double s, const Eigen::VectorXd& r, double* x, double* b);

/// The way back: U_x and U_u = s U_x - r_x, into all of y but the work, which gets 0. Resizes.
/// \param u, x  U_x and r_x, four numbers a pivot
/// \param size  of y
void take_solution(const PivotLayout& at, double s, const double* u, const double* x, Eigen::Index size,
                   Eigen::VectorXd& result);

}  // namespace tendril
