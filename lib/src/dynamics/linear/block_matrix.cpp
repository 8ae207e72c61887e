#include "block_matrix.h"

#include <algorithm>

#include "block_algebra.h"

namespace tendril {
namespace {

template <int B>
struct Parts {
  Block<B>* diagonal;
  Block<B>* upper;
  Block<B>* lower;
};

/// The scalar elimination, block by block: L D U, upper blocks L^-1 A, lower blocks A (D U)^-1 (in the
/// symmetric case the transposes of the upper ones times the inverse pivots).
template <int B, bool Symmetric>
TENDRIL_INLINE bool factor_blocks(const BlockPattern& pattern, const Parts<B>& m) {
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    if (!decompose<B>(m.diagonal[k])) return false;
    const Block<B> factors = m.diagonal[k];
    const std::size_t begin = pattern.begin(k);
    const std::size_t count = pattern.begin(k + 1) - begin;
    const std::size_t* pair = pattern.pairs(k);
    for (std::size_t a = 0; a < count; ++a) {
      divide_by_lower<B, Symmetric>(factors, m.upper[begin + a], m.lower[begin + a]);
      if constexpr (!Symmetric) divide_by_upper<B>(factors, m.lower[begin + a]);
    }
    for (std::size_t a = 0; a < count; ++a) {
      subtract_product<B>(m.lower[begin + a], m.upper[begin + a], m.diagonal[pattern.later(begin + a)]);
      for (std::size_t b = a + 1; b < count; ++b, ++pair) {
        subtract_product<B>(m.lower[begin + a], m.upper[begin + b], m.upper[*pair]);
        if constexpr (!Symmetric) subtract_product<B>(m.lower[begin + b], m.upper[begin + a], m.lower[*pair]);
      }
    }
  }
  return true;
}

template <int B>
TENDRIL_INLINE void solve_blocks(const BlockPattern& pattern, const Block<B>* diagonal, const Block<B>* upper,
                                 const Block<B>* lower, double* b) {
  const std::size_t n = pattern.size();
  const std::size_t* later = pattern.later();
  const std::size_t* begin = pattern.begin();
  double x[B];
  for (std::size_t k = 0; k < n; ++k) {
    TENDRIL_UNROLL
    for (std::size_t c = 0; c < B; ++c) x[c] = b[4 * k + c];
    substitute_lower<B>(diagonal[k], x);
    TENDRIL_UNROLL
    for (std::size_t c = 0; c < B; ++c) b[4 * k + c] = x[c];
    for (std::size_t e = begin[k]; e < begin[k + 1]; ++e) {
      Four& to = at(b + 4 * later[e]);
      lanes::Pack sum = to;
      subtract_upwards<B>(lower[e], x, sum);
      to = sum;
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    lanes::Pack sum = at(b + 4 * k);
    // What is known last comes last.
    for (std::size_t e = begin[k + 1]; e-- > begin[k];)
      subtract_downwards<B>(upper[e], b + 4 * later[e], sum);
    TENDRIL_UNROLL
    for (std::size_t c = 0; c < B; ++c) x[c] = sum[c];
    substitute_upper<B>(diagonal[k], x);
    TENDRIL_UNROLL
    for (std::size_t c = 0; c < B; ++c) b[4 * k + c] = x[c];
  }
}

TENDRIL_LANES bool factor_symmetric(const BlockPattern& p, const Parts<3>& m) {
  return factor_blocks<3, true>(p, m);
}
TENDRIL_LANES bool factor_three(const BlockPattern& p, const Parts<3>& m) {
  return factor_blocks<3, false>(p, m);
}
TENDRIL_LANES bool factor_four(const BlockPattern& p, const Parts<4>& m) {
  return factor_blocks<4, false>(p, m);
}
TENDRIL_LANES void solve_three(const BlockPattern& p, const Block<3>* d, const Block<3>* u, const Block<3>* l,
                               double* b) {
  solve_blocks<3>(p, d, u, l, b);
}
TENDRIL_LANES void solve_four(const BlockPattern& p, const Block<4>* d, const Block<4>* u, const Block<4>* l,
                              double* b) {
  solve_blocks<4>(p, d, u, l, b);
}

/// to = -(a + s b), of all the numbers of some blocks; without b where it is null.
TENDRIL_LANES void negate(std::size_t count, const double* __restrict a, double s, const double* __restrict b,
                          double* __restrict to) {
  if (!b) {
    for (std::size_t i = 0; i < count; ++i) to[i] = -a[i];
    return;
  }
  for (std::size_t i = 0; i < count; ++i) to[i] = -a[i] - s * b[i];
}

template <int B>
void negate(const std::vector<Block<B>>& a, double s, const std::vector<Block<B>>* b,
            std::vector<Block<B>>& to) {
  if (to.empty()) return;
  const auto numbers = [](const auto& blocks) { return blocks.front().column.front().data(); };
  negate(4 * B * to.size(), numbers(a), s, b ? numbers(*b) : nullptr, to.front().column.front().data());
}

/// y -= A x
template <int B>
TENDRIL_INLINE void subtract_product_of_blocks(const BlockPattern& pattern, const Block<B>* diagonal,
                                               const Block<B>* upper, const Block<B>* lower, const double* x,
                                               double* y) {
  const std::size_t* later = pattern.later();
  const std::size_t* begin = pattern.begin();
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    lanes::Pack own = at(y + 4 * k);
    subtract_upwards<B>(diagonal[k], x + 4 * k, own);
    for (std::size_t e = begin[k]; e < begin[k + 1]; ++e) {
      const std::size_t other = 4 * later[e];
      subtract_upwards<B>(upper[e], x + other, own);
      lanes::Pack sum = at(y + other);
      subtract_upwards<B>(lower[e], x + 4 * k, sum);
      at(y + other) = sum;
    }
    at(y + 4 * k) = own;
  }
}
TENDRIL_LANES void subtract_product_three(const BlockPattern& p, const Block<3>* d, const Block<3>* u,
                                          const Block<3>* l, const double* x, double* y) {
  subtract_product_of_blocks<3>(p, d, u, l, x, y);
}
TENDRIL_LANES void subtract_product_four(const BlockPattern& p, const Block<4>* d, const Block<4>* u,
                                         const Block<4>* l, const double* x, double* y) {
  subtract_product_of_blocks<4>(p, d, u, l, x, y);
}

template <int N, int B>
TENDRIL_INLINE void add_each(std::size_t count, const Block<N>* from, Block<B>* const* to) {
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t c = 0; c < N; ++c) four(to[k]->column[c]) += four(from[k].column[c]);
}
TENDRIL_LANES void add_three(std::size_t count, const Block<3>* from, Block<3>* const* to) {
  add_each(count, from, to);
}
TENDRIL_LANES void add_three_to_four(std::size_t count, const Block<3>* from, Block<4>* const* to) {
  add_each(count, from, to);
}
TENDRIL_LANES void add_four(std::size_t count, const Block<4>* from, Block<4>* const* to) {
  add_each(count, from, to);
}

TENDRIL_LANES void add_columns(std::size_t count, const BlockProduct* products) {
  for (std::size_t k = 0; k < count; ++k) {
    const BlockProduct& p = products[k];
    const lanes::Pack column = lanes::load<lanes::Pack>(p.column);
    for (std::size_t c = 0; c < 3; ++c) four(p.to->column[c]) += column * p.row[c];
  }
}

}  // namespace

void add_products(std::size_t count, const BlockProduct* products) {
  add_columns(count, products);
}
void add_blocks(std::size_t count, const Block<3>* from, Block<3>* const* to) {
  add_three(count, from, to);
}
void add_blocks(std::size_t count, const Block<3>* from, Block<4>* const* to) {
  add_three_to_four(count, from, to);
}
void add_blocks(std::size_t count, const Block<4>* from, Block<4>* const* to) {
  add_four(count, from, to);
}

template <int B>
void BlockMatrix<B>::set_zero() {
  for (auto* blocks : {&diagonal_, &upper_, &lower_}) std::fill(blocks->begin(), blocks->end(), Block{});
}

template <int B>
typename BlockMatrix<B>::Block* BlockMatrix<B>::find(std::size_t row_node, std::size_t column_node) {
  const std::size_t row = pattern_->pivot(row_node);
  const std::size_t column = pattern_->pivot(column_node);
  if (row == column) return &diagonal_[row];
  if (row > column && symmetric_) return nullptr;
  const std::size_t e = pattern_->entry(std::min(row, column), std::max(row, column));
  if (e == pattern_->entries()) return nullptr;
  return row < column ? &upper_[e] : &lower_[e];
}

template <int B>
void BlockMatrix<B>::set_negative(const BlockMatrix& a, double s, const BlockMatrix* b) {
  negate<B>(a.diagonal_, s, b ? &b->diagonal_ : nullptr, diagonal_);
  negate<B>(a.upper_, s, b ? &b->upper_ : nullptr, upper_);
  if (!symmetric_) negate<B>(a.lower_, s, b ? &b->lower_ : nullptr, lower_);
}

template <int B>
void BlockMatrix<B>::release(std::size_t node, std::size_t coordinate) {
  const std::size_t own = pattern_->pivot(node);
  const auto clear_row = [&](Block& b) {
    for (auto& column : b.column) column[coordinate] = 0.0;
  };
  const auto clear_column = [&](Block& b) { b.column[coordinate] = {}; };
  clear_row(diagonal_[own]);
  clear_column(diagonal_[own]);
  for (std::size_t e = pattern_->begin(own); e < pattern_->begin(own + 1); ++e) {
    clear_row(upper_[e]);
    if (!symmetric_) clear_column(lower_[e]);
  }
  for (const std::size_t e : pattern_->earlier(own)) {
    clear_column(upper_[e]);
    if (!symmetric_) clear_row(lower_[e]);
  }
}

template <int B>
void BlockMatrix<B>::project(std::size_t node, const Mat3& by) {
  const std::size_t own = pattern_->pivot(node);
  const auto rows = [&](Block& b) {
    for (auto& column : b.column) {
      const Vec3 put = by * Vec3(column[0], column[1], column[2]);
      std::copy(put.begin(), put.end(), column.begin());
    }
  };
  const auto columns = [&](Block& b) {
    const auto old = b.column;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t r = 0; r < B; ++r) {
        b.column[c][r] = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
          b.column[c][r] += old[k][r] * by(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c));
      }
  };
  rows(diagonal_[own]);
  columns(diagonal_[own]);
  for (std::size_t e = pattern_->begin(own); e < pattern_->begin(own + 1); ++e) {
    rows(upper_[e]);
    if (!symmetric_) columns(lower_[e]);
  }
  for (const std::size_t e : pattern_->earlier(own)) {
    columns(upper_[e]);
    if (!symmetric_) rows(lower_[e]);
  }
}

template <int B>
bool BlockMatrix<B>::factor() {
  const Parts<B> parts{diagonal_.data(), upper_.data(), lower_.data()};
  if constexpr (B == 4) return factor_four(*pattern_, parts);
  if constexpr (B == 3)
    return symmetric_ ? factor_symmetric(*pattern_, parts) : factor_three(*pattern_, parts);
}

template <int B>
void BlockMatrix<B>::solve(double* b) const {
  if constexpr (B == 4) solve_four(*pattern_, diagonal_.data(), upper_.data(), lower_.data(), b);
  if constexpr (B == 3) solve_three(*pattern_, diagonal_.data(), upper_.data(), lower_.data(), b);
}

template <int B>
void BlockMatrix<B>::subtract_product(const double* x, double* y) const {
  if constexpr (B == 4)
    subtract_product_four(*pattern_, diagonal_.data(), upper_.data(), lower_.data(), x, y);
  if constexpr (B == 3)
    subtract_product_three(*pattern_, diagonal_.data(), upper_.data(), lower_.data(), x, y);
}

template class BlockMatrix<3>;
template class BlockMatrix<4>;

}  // namespace tendril
