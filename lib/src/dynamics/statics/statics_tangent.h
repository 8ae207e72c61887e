#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include "statics_problem.h"

namespace tendril {

/// A tangent K scaled to S = D^-1/2 K D^-1/2, so that its eigenvalues are those of Stability, and factors of
/// S + shift. Rows keep the order of StaticCoordinates, without fill on chains and trees, unless what touches
/// fills the factors: then they are eliminated by minimum degree.
class StaticTangent {
 public:
  /// \param weight  D, kept by reference
  explicit StaticTangent(const Eigen::VectorXd& weight) : weight_(weight) {}

  /// \param symmetric  of k only the lower triangle is there
  void set(const Eigen::SparseMatrix<double>& k, bool symmetric);

  bool finite() const;  ///< all numbers of K
  /// False when a pivot is 0, or a number is not finite. Then solutions are not numbers.
  bool factorise(double shift);
  int negative() const;  ///< pivots below 0: eigenvalues of S below -shift
  bool soft() const;     ///< a pivot that rounding may have made
  /// (K + shift D)^-1 b
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// The same without what lies within the shift of a neutral direction: such a part of a step is as large as
  /// rounding makes it, and means nothing. K v / (K + shift D), twice.
  Eigen::VectorXd solve_but_neutral(const Eigen::VectorXd& b) const;
  /// solve() in scaled coordinates, and S v.
  Eigen::VectorXd solve_scaled(const Eigen::VectorXd& b) const;
  Eigen::VectorXd times(const Eigen::VectorXd& v) const;

  /// What rounding makes of an eigenvalue 0, by the largest row sum.
  double rounding() const { return rounding_; }
  const Eigen::VectorXd& root() const { return root_; }  ///< D^1/2
  long factorisations = 0;

 private:
  const Eigen::VectorXd& weight_;
  Eigen::VectorXd root_, diagonal_;
  Eigen::SparseMatrix<double> s_;
  bool symmetric_ = true;
  double rounding_ = 0.0, shift_ = 0.0;
  bool analysed_ = false, factorised_ = false;
  void order();
  bool factorise_finite();
  Eigen::PermutationMatrix<Eigen::Dynamic> order_;  ///< of no size where rows keep theirs
  Eigen::SparseMatrix<double> ordered_;             ///< the lower triangle of S in that order
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> ldlt_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> lu_;
};

/// Largest eigenvalue threshold below which one counts as 0, the counts, and the smallest with its mode.
/// \param tangent  set, symmetric
/// \param unbalanced  energy below which unbalanced forces may move an eigenvalue
Stability analyse(const StaticCoordinates& coordinates, StaticTangent& tangent, double unbalanced);

/// The smallest eigenvalue and its mode in free coordinates, by the power of the inverse.
struct LowestMode {
  double value = 0.0;
  Eigen::VectorXd x;
};
LowestMode lowest_mode(StaticTangent& tangent, double threshold);

/// Eigenvalues within this of 0 count as neutral.
double neutral_threshold(const StaticCoordinates& coordinates, const StaticTangent& tangent);

}  // namespace tendril
