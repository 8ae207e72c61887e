#pragma once

#include <Eigen/Core>

#include <initializer_list>

namespace tendril {

/// One term of a sum of vectors.
struct Term {
  double weight;
  const Eigen::VectorXd* vector;
};

/// to = from + the sum of at most six terms, in their order and in one pass; `from` may be null, for 0. Terms
/// of weight 0 must be left out.
void combine(const Eigen::VectorXd* from, const Term* terms, std::size_t count, Eigen::VectorXd& to);

}  // namespace tendril
