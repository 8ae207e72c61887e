#pragma once

#include <vector>

#include "block_pattern.h"
#include "dynamics/vector/block.h"

namespace tendril {

/// A matrix of B x B blocks, one row of blocks a node (three positions; four with the angle), on a pattern.
/// Symmetric ones are given the upper half alone.
template <int B>
class BlockMatrix {
 public:
  using Block = tendril::Block<B>;

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
  /// Puts a symmetric matrix before a node's rows of positions and after its columns.
  void project(std::size_t node, const Mat3& by);

  /// L U in place. False when a pivot is not finite, or smaller than 1e-12 of its row within the block.
  bool factor();
  /// Solves with the factors, in place: four numbers a pivot, in the pivots' order.
  void solve(double* b) const;
  /// y -= A x, before factoring, not symmetric; laid out like b.
  void subtract_product(const double* x, double* y) const;

  const BlockPattern& pattern() const { return *pattern_; }

 private:
  const BlockPattern* pattern_;
  std::vector<Block> diagonal_, upper_, lower_;
  bool symmetric_;
};

/// The product of a column of four numbers and a row of three, for the first three columns of a block.
struct BlockProduct {
  const double* column;
  const double* row;
  Block<4>* to;
};
void add_products(std::size_t count, const BlockProduct* products);

/// Adds blocks to those at the addresses given, one each.
void add_blocks(std::size_t count, const Block<3>* from, Block<3>* const* to);
void add_blocks(std::size_t count, const Block<4>* from, Block<4>* const* to);
void add_blocks(std::size_t count, const Block<3>* from, Block<4>* const* to);

extern template class BlockMatrix<3>;
extern template class BlockMatrix<4>;

}  // namespace tendril
