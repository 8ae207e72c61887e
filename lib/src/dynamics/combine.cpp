#include "combine.h"

#include <array>

#include "lanes.h"

namespace tendril {
namespace {

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

}  // namespace tendril
