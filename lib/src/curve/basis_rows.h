#pragma once

#include <tendril/curve/knots.h>

#include "base/vector_loops.h"

/// The basis functions of one span for a degree known when compiled: written out, so that a vector loop may
/// hold them.
namespace tendril::basis {

using Row = std::array<double, kMaxDegree + 1>;
using Rows = std::array<Row, kMaxDegree + 1>;

TENDRIL_INLINE std::size_t idx(int i) {
  return static_cast<std::size_t>(i);
}

/// Values of degree D from those of degree D - 1 (Cox, de Boor). `knot` points at the span's first knot.
template <int D>
TENDRIL_INLINE Row raise_value(const Row& lower, const double* knot, double t) {
  Row row{};
#pragma GCC unroll 8
  for (int j = 0; j < D; ++j) {
    const double left = knot[j + 1 - D];
    const double right = knot[j + 1];
    const double share = lower[idx(j)] / (right - left);
    row[idx(j)] += (right - t) * share;
    row[idx(j + 1)] = (t - left) * share;
  }
  return row;
}

/// One differentiation: N'_{i,D} = D (N_{i,D-1} / (k_{i+D} - k_i) - N_{i+1,D-1} / (k_{i+D+1} - k_{i+1})),
/// applied to any linear combination of derivatives of the lower row.
template <int D>
TENDRIL_INLINE Row raise_derivative(const Row& lower, const double* knot) {
  Row row{};
#pragma GCC unroll 8
  for (int j = 0; j < D; ++j) {
    const double share = D * lower[idx(j)] / (knot[j + 1] - knot[j + 1 - D]);
    row[idx(j)] -= share;
    row[idx(j + 1)] += share;
  }
  return row;
}

/// rows[d] for d = 1 to P: the d + 1 functions of degree d that live in the span.
template <int P>
TENDRIL_INLINE void fill_values(Rows& rows, const double* knot, double t) {
  if constexpr (P > 0) {
    fill_values<P - 1>(rows, knot, t);
    rows[P] = raise_value<P>(rows[P - 1], knot, t);
  }
}

/// A row of degree D raised to degree P by differentiations.
template <int P, int D>
TENDRIL_INLINE Row differentiate(const Row& row, const double* knot) {
  if constexpr (D == P)
    return row;
  else
    return differentiate<P, D + 1>(raise_derivative<D + 1>(row, knot), knot);
}

}  // namespace tendril::basis
