#include "band.h"

#include <algorithm>
#include <cmath>

namespace tendril {

bool BandMatrix::factor() {
  for (Eigen::Index k = 0; k < size_; ++k) {
    const double pivot = at(k, k);
    const Eigen::Index last = std::min(size_ - 1, k + half_);
    const Eigen::Index count = last - k;
    const auto upper = rows_.col(k).segment(half_ + 1, count);
    const double largest = count > 0 ? upper.cwiseAbs().maxCoeff() : 0.0;
    if (!std::isfinite(pivot) || !(std::abs(pivot) > 1e-12 * largest)) return false;
    for (Eigen::Index row = k + 1; row <= last; ++row) {
      double& ratio = at(row, k);
      if (ratio == 0.0) continue;
      ratio /= pivot;
      rows_.col(row).segment(k + 1 - row + half_, count).noalias() -= ratio * upper;
    }
  }
  return true;
}

void BandMatrix::solve(Eigen::VectorXd& b) const {
  for (Eigen::Index row = 1; row < size_; ++row) {
    const Eigen::Index count = std::min(row, half_);
    b[row] -= rows_.col(row).segment(half_ - count, count).dot(b.segment(row - count, count));
  }
  for (Eigen::Index row = size_; row-- > 0;) {
    const Eigen::Index count = std::min(size_ - 1 - row, half_);
    b[row] =
        (b[row] - rows_.col(row).segment(half_ + 1, count).dot(b.segment(row + 1, count))) / at(row, row);
  }
}

void BandMatrix::multiply_add(double s, const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  for (Eigen::Index row = 0; row < size_; ++row) {
    const Eigen::Index first = std::max<Eigen::Index>(0, row - half_);
    const Eigen::Index count = std::min(size_ - 1, row + half_) - first + 1;
    y[row] += s * rows_.col(row).segment(first - row + half_, count).dot(x.segment(first, count));
  }
}

}  // namespace tendril
