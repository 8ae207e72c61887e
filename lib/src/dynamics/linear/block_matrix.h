#pragma once

#include <tendril/base/types.h>

#include <array>
#include <vector>

#include "block_pattern.h"

namespace tendril {

/// A matrix of B x B blocks, one row of blocks a node (three positions; four with the angle), on a pattern.
/// Symmetric ones are given the upper half alone.
template <int B>
class BlockMatrix {
 public:
  /// Columns of four numbers, so that a column is a vector register whatever B.
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

  BlockMatrix(const BlockPattern& pattern, bool symmetric)
      : pattern_(&pattern),
        diagonal_(pattern.size()),
        upper_(pattern.entries()),
        lower_(pattern.entries()),
        symmetric_(symmetric) {}

  void set_zero();
  bool symmetric() const { return symmetric_; }

  /// The block of a row node and a column node; null where none is kept.
  Block* find(std::size_t row_node, std::size_t column_node);
  const Block* find(std::size_t row_node, std::size_t column_node) const {
    return const_cast<BlockMatrix*>(this)->find(row_node, column_node);
  }

  /// One number, which must be kept.
  double& entry(std::size_t row, std::size_t column, std::size_t r, std::size_t c) {
    return find(row, column)->column[c][r];
  }

  /// this = -(a + s b), b may be null.
  void set_negative(const BlockMatrix& a, double s, const BlockMatrix* b);

  /// Zeroes a coordinate's row and column.
  void release(std::size_t node, std::size_t coordinate);

  /// L U in place. False when a pivot is not finite, or smaller than 1e-12 of its row within the block.
  bool factor();
  /// Solves with the factors, in place: four numbers a pivot, in the pivots' order.
  void solve(double* b) const;
  /// y += s A x, before factoring, not symmetric; laid out like b.
  void multiply_add(double s, const double* x, double* y) const;

  const BlockPattern& pattern() const { return *pattern_; }

 private:
  const BlockPattern* pattern_;
  std::vector<Block> diagonal_, upper_, lower_;
  bool symmetric_;
};

extern template class BlockMatrix<3>;
extern template class BlockMatrix<4>;

}  // namespace tendril
