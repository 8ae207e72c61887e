#pragma once

#include <tendril/base/types.h>

#include <array>
#include <cstddef>

namespace tendril {

/// B x B numbers of a matrix, the columns padded to four, so that each is a vector register whatever B.
template <int B>
struct Block {
  std::array<std::array<double, 4>, B> column{};

  void add(const Mat3& k) {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t r = 0; r < 3; ++r)
        column[c][r] += k(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
  }
  /// In the column, or the row, of the angle.
  void add_column(const Vec3& k) {
    for (std::size_t r = 0; r < 3; ++r) column[B - 1][r] += k[static_cast<Eigen::Index>(r)];
  }
  void add_row(const Vec3& k) {
    for (std::size_t c = 0; c < 3; ++c) column[c][3] += k[static_cast<Eigen::Index>(c)];
  }
};

/// Where a block stands: the nodes of its row and its column; and whether it counts (nobody feels through a
/// one-way joint, and not every node is there).
struct BlockPlace {
  std::size_t row, column;
  bool counts;
  bool row_angle,
      column_angle;  ///< whether its fourth row and column are those of the nodes' angles, or empty
};

}  // namespace tendril
