#pragma once

#include <Eigen/Core>

#include <vector>

namespace tendril {

/// Square matrix with `half` diagonals on either side of the main one; LU without pivoting, O(n half^2).
class BandMatrix {
 public:
  BandMatrix(Eigen::Index size, Eigen::Index half)
      : size_(size), half_(std::min(half, std::max<Eigen::Index>(size - 1, 0))), rows_(width(), size) {
    set_zero();
  }

  Eigen::Index size() const { return size_; }
  Eigen::Index half() const { return half_; }
  void set_zero() { rows_.setZero(); }
  bool inside(Eigen::Index row, Eigen::Index column) const { return std::abs(row - column) <= half_; }
  double& at(Eigen::Index row, Eigen::Index column) { return rows_(column - row + half_, row); }
  double at(Eigen::Index row, Eigen::Index column) const { return rows_(column - row + half_, row); }

  /// L U in place. False when a pivot is not finite, or smaller than 1e-12 of its row.
  bool factor();
  /// Solves with the factors, in place.
  void solve(Eigen::VectorXd& b) const;
  /// y += s A x, before factoring.
  void multiply_add(double s, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  Eigen::MatrixXd& data() { return rows_; }
  const Eigen::MatrixXd& data() const { return rows_; }

 private:
  Eigen::Index width() const { return 2 * half_ + 1; }

  Eigen::Index size_, half_;
  Eigen::MatrixXd rows_;  ///< column r holds row r about its diagonal
};

}  // namespace tendril
