#include "path_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace tendril::axis {
namespace {

double parameter(std::size_t k, std::size_t count) {
  return static_cast<double>(k) / static_cast<double>(count - 1);
}

double largest_share(const BSpline& curve, const Line& points, const std::vector<double>& width) {
  double largest = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k)
    largest = std::max(largest, (curve.value(parameter(k, points.size())) - points[k]).norm() / width[k]);
  return largest;
}

}  // namespace

Line evenly(const Line& line, std::size_t count) {
  const double length = length_of(line);
  Line out;
  std::size_t k = 1;
  double before = 0.0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double wanted = length * parameter(i, count);
    double step = (line[k] - line[k - 1]).norm();
    while (k + 1 < line.size() && before + step < wanted) {
      before += step;
      ++k;
      step = (line[k] - line[k - 1]).norm();
    }
    const double part = step > 0.0 ? std::clamp((wanted - before) / step, 0.0, 1.0) : 0.0;
    out.push_back(line[k - 1] + part * (line[k] - line[k - 1]));
  }
  out.push_back(line.back());
  return out;
}

/// Minimises sum_k |sum_j N_j(t_k) u_j - p_k|^2 over the inner control points: u_0 and the last are the ends
/// of the line, whose part goes to the right side, sum_j (sum_k N_i N_j) u_j = sum_k N_i (p_k - N_0 u_0 - N_m
/// u_m). The normal matrix is definite as long as every function has a sample in its support: fit() asks for
/// at most one control point in two samples. Its condition is some tens for uniform cubics.
BSpline least_squares(const Line& points, int control_points) {
  const KnotVector knots = KnotVector::uniform(3, control_points);
  const Eigen::Index inner = control_points - 2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(inner, inner);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(inner, 3);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Basis basis = knots.basis(parameter(k, points.size()));
    const auto weight = [&](int j) { return basis.value[0][static_cast<std::size_t>(j)]; };
    Vec3 rest = points[k];
    for (int j = 0; j <= 3; ++j) {
      if (basis.first + j == 0) rest -= weight(j) * points.front();
      if (basis.first + j == control_points - 1) rest -= weight(j) * points.back();
    }
    for (int i = 0; i <= 3; ++i) {
      const Eigen::Index row = basis.first + i - 1;
      if (row < 0 || row >= inner) continue;
      right.row(row) += weight(i) * rest.transpose();
      for (int j = 0; j <= 3; ++j) {
        const Eigen::Index column = basis.first + j - 1;
        if (column >= 0 && column < inner) normal(row, column) += weight(i) * weight(j);
      }
    }
  }
  const Eigen::MatrixXd solved = normal.ldlt().solve(right);
  std::vector<Vec3> control{points.front()};
  for (Eigen::Index i = 0; i < inner; ++i) control.emplace_back(solved.row(i).transpose());
  control.push_back(points.back());
  return {knots, std::move(control)};
}

BSpline fit(const Line& points, const std::vector<double>& width, double tolerance) {
  const int most = std::max(4, static_cast<int>(points.size()) / 2);
  for (int count = 4;; count += std::max(1, count / 4)) {
    BSpline curve = least_squares(points, std::min(count, most));
    if (count >= most || largest_share(curve, points, width) <= tolerance) return curve;
  }
}

}  // namespace tendril::axis
