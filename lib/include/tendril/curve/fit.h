#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/bspline.h>

#include <vector>

namespace tendril {

/// How parameters r_k in [0, 1] are given to the points a curve passes through ([Chan 2008] section 3.2.1).
enum class Parametrisation {
  uniform,       ///< r_k = k / n
  chord_length,  ///< steps as |p_k - p_{k-1}|
  centripetal,   ///< steps as |p_k - p_{k-1}|^(1/2) [Lee 1989] ([Chan 2008] 3.8, 3.9)
  universal,     ///< uniform clamped knots; r_k where the k-th basis function is largest [Lim 1999]
};

/// Interpolation of n + 1 points by a clamped B-spline. Parameters and knots come from the *rest* positions
/// and are frozen: the matrix N_{i,p}(r_k) is factored once, every later set of points is one banded solve,
/// and what is bound at a parameter does not slide. Knots by averaging p consecutive parameters ([Chan
/// 2008] 3.10 with its lost 1/p), except for universal parameters, whose knots are uniform.
class TENDRIL_CORE_API Interpolator {
 public:
  /// \param degree  p, 1 to kMaxDegree; else InvalidInput
  /// \param rest    more than `degree` finite points, neighbours distinct for the two chord methods; else
  ///                InvalidInput
  /// \param how     gives the parameters
  Interpolator(int degree, Points rest, Parametrisation how = Parametrisation::centripetal);

  const KnotVector& knots() const { return knots_; }                     ///< on [0, 1]
  const std::vector<double>& parameters() const { return parameters_; }  ///< r_k, ascending from 0 to 1

  /// Control points u with sum_i N_i(r_k) u_i = points_k. Gaussian elimination without pivoting: the matrix
  /// is totally positive [de Boor and Pinkus 1977]. O(n p), no allocation beyond the result.
  std::vector<Vec3> solve(Points points) const;

  /// The transposed map: forces f on the points for forces g on the control points, sum_k N_i(r_k) f_k = g_i.
  /// Then f does the same work under moves of the points as g under those of the control points they cause.
  std::vector<Vec3> solve_transposed(Points forces) const;

 private:
  double& at(std::size_t row, std::size_t column) { return band_[row * width() + column + half() - row]; }
  double at(std::size_t row, std::size_t column) const {
    return band_[row * width() + column + half() - row];
  }
  std::size_t half() const { return static_cast<std::size_t>(knots_.degree()); }
  std::size_t width() const { return 2 * half() + 1; }
  void factor();

  std::vector<double> parameters_;
  KnotVector knots_;
  std::vector<double> band_;  ///< rows of the matrix about the diagonal, then its LU factors
};

}  // namespace tendril
