#pragma once

#include "block_matrix.h"

namespace tendril {

/// A sink for stiffness_elements.h that adds to a matrix.
///
/// Which blocks the springs of a model add to, and in which order, depends on the model alone, not on its
/// state. So the first pass records the address of each block in turn (its route), and every later pass reads
/// the addresses off the route with a counter, without a search: restart() puts the counter back. Valid as
/// long as the matrix keeps its pattern and its storage, and the model its springs. A block that the matrix
/// does not keep (the lower half of a symmetric one) is dropped: its address is null, or that of one that
/// nobody reads.
template <int B>
class BlockRoute {
 public:
  /// \param matrix  kept by reference
  explicit BlockRoute(BlockMatrix<B>& matrix) : matrix_(matrix) {}
  BlockRoute(const BlockRoute&) = delete;
  BlockRoute& operator=(const BlockRoute&) = delete;

  /// Zeroes the matrix and starts again at the first block.
  void restart() {
    matrix_.set_zero();
    next_ = 0;
  }

  /// Blocks at once, none larger than the matrix's.
  /// \param place  of block k: BlockPlace
  template <int N, class Place>
  void blocks(std::size_t count, const Block<N>* from, const Place& place) {
    if constexpr (N <= B) {
      while (route_.size() < next_ + count) {
        const BlockPlace at = place(route_.size() - next_);
        Block<B>* to = at.counts ? matrix_.find(at.row, at.column) : nullptr;
        route_.push_back(to ? to : &dropped_);
      }
      add_blocks(count, from, route_.data() + next_);
      next_ += count;
    }
  }

  void block(std::size_t row, std::size_t column, const Mat3& k) {
    if (auto* to = next(row, column)) to->add(k);
  }
  void column(std::size_t row, std::size_t node, const Vec3& k) {
    if (auto* to = next(row, node); to && B == 4) to->add_column(k);
  }
  void row(std::size_t node, std::size_t column, const Vec3& k) {
    if (auto* to = next(node, column); to && B == 4) to->add_row(k);
  }
  void angles(std::size_t row, std::size_t column, double k) {
    if (auto* to = next(row, column); to && B == 4) to->column[B - 1][3] += k;
  }

 private:
  Block<B>* next(std::size_t row, std::size_t column) {
    if (next_ == route_.size()) route_.push_back(matrix_.find(row, column));
    return route_[next_++];
  }

  BlockMatrix<B>& matrix_;
  std::vector<Block<B>*> route_;
  Block<B> dropped_;  ///< takes what the matrix does not keep
  std::size_t next_ = 0;
};

}  // namespace tendril
