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

/// The sums of five vectors.
TENDRIL_LANES void add_up_both(std::size_t size, const double* __restrict from, const Term* terms,
                               const double* error_weights, double* __restrict to, double* __restrict error) {
  std::array<const double*, kBoth> k;
  std::array<double, kBoth> w, e;
  for (std::size_t j = 0; j < kBoth; ++j) {
    k[j] = terms[j].vector->data();
    w[j] = terms[j].weight;
    e[j] = error_weights[j];
  }
  TENDRIL_LOOP
  for (std::size_t i = 0; i < size; ++i) {
    double sum = w[0] * k[0][i], off = e[0] * k[0][i];
    for (std::size_t j = 1; j < kBoth; ++j) {
      sum += w[j] * k[j][i];
      off += e[j] * k[j][i];
    }
    to[i] = from[i] + sum;
    error[i] = off;
  }
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
                  std::size_t count, Eigen::VectorXd& to, Eigen::VectorXd& error) {
  std::array<Term, kBoth> all;
  std::array<double, kBoth> weights{};
  all.fill({0.0, terms[0].vector});
  std::copy(terms, terms + count, all.begin());
  std::copy(error_weights, error_weights + count, weights.begin());
  to.resize(from.size());
  error.resize(from.size());
  add_up_both(static_cast<std::size_t>(from.size()), from.data(), all.data(), weights.data(), to.data(),
              error.data());
  return all_finite(to) && all_finite(error);
}

}  // namespace tendril
