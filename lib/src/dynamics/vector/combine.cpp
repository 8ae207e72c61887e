#include "combine.h"

#include <algorithm>
#include <array>

#include "finite.h"
#include "lanes.h"

namespace tendril {
namespace {

constexpr std::size_t kBoth = 5;

template <std::size_t N>
TENDRIL_INLINE void add_up(std::size_t size, const double* __restrict from, const Term* terms,
                           double* __restrict to) {
  std::array<const double*, N> k;
  std::array<double, N> w;
  for (std::size_t j = 0; j < N; ++j) {
    k[j] = terms[j].vector->data();
    w[j] = terms[j].weight;
  }
  TENDRIL_LOOP
  for (std::size_t i = 0; i < size; ++i) {
    double sum = w[0] * k[0][i];
    for (std::size_t j = 1; j < N; ++j) sum += w[j] * k[j][i];
    to[i] = from[i] + sum;
  }
}

TENDRIL_LANES void add_up(std::size_t size, const double* from, const Term* terms, std::size_t count,
                          double* to) {
  switch (count) {
    case 1:
      return add_up<1>(size, from, terms, to);
    case 2:
      return add_up<2>(size, from, terms, to);
    case 3:
      return add_up<3>(size, from, terms, to);
    case 4:
      return add_up<4>(size, from, terms, to);
    case 5:
      return add_up<5>(size, from, terms, to);
    default:
      return add_up<6>(size, from, terms, to);
  }
}

/// Five vectors and their weights in two sums.
struct Both {
  std::array<const double*, kBoth> k;
  std::array<double, kBoth> w, e;
};

template <bool WithError>
TENDRIL_INLINE bool add_up_both(std::size_t size, const double* __restrict from, const Both& both,
                                double* __restrict to, double* __restrict error) {
  const auto [k, w, e] = both;
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < size; ++i) {
    double sum = w[0] * k[0][i], off = 0.0;
    if constexpr (WithError) off = e[0] * k[0][i];
    for (std::size_t j = 1; j < kBoth; ++j) {
      sum += w[j] * k[j][i];
      if constexpr (WithError) off += e[j] * k[j][i];
    }
    const double at = from[i] + sum;
    to[i] = at;
    bad |= no_number(at);
    if constexpr (WithError) {
      error[i] = off;
      bad |= no_number(off);
    }
  }
  return bad == 0;
}
TENDRIL_LANES bool add_up_alone(std::size_t size, const double* from, const Both& both, double* to) {
  return add_up_both<false>(size, from, both, to, nullptr);
}
TENDRIL_LANES bool add_up_with_error(std::size_t size, const double* from, const Both& both, double* to,
                                     double* error) {
  return add_up_both<true>(size, from, both, to, error);
}

}  // namespace

void combine(const Eigen::VectorXd* from, const Term* terms, std::size_t count, Eigen::VectorXd& to) {
  const Eigen::Index size = terms[0].vector->size();
  if (from)
    to.resize(size);
  else
    to.setZero(size);
  // Without a start the sum is added to the zeros that stand there.
  add_up(static_cast<std::size_t>(size), from ? from->data() : to.data(), terms, count, to.data());
}

bool combine_both(const Eigen::VectorXd& from, const Term* terms, const double* error_weights,
                  std::size_t count, const NumbersAt& part, Eigen::VectorXd& to, Eigen::VectorXd* error) {
  Both both{};
  both.k.fill(terms[0].vector->data() + part.from);
  for (std::size_t j = 0; j < count; ++j) {
    both.k[j] = terms[j].vector->data() + part.from;
    both.w[j] = terms[j].weight;
    both.e[j] = error_weights[j];
  }
  const auto size = static_cast<std::size_t>(part.count);
  const double* start = from.data() + part.from;
  double* put = to.data() + part.to;
  return error ? add_up_with_error(size, start, both, put, error->data() + part.to)
               : add_up_alone(size, start, both, put);
}

}  // namespace tendril
