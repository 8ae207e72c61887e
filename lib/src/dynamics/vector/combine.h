#pragma once

#include <Eigen/Core>

#include <algorithm>
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

/// `count` numbers of vectors, from `from` on, that stand at `to` and after it in another.
struct NumbersAt {
  Eigen::Index from, to, count;
};

/// From one vector into another. Much faster than an expression of segments, which is not vector code.
inline void copy(const Eigen::VectorXd& from, const NumbersAt& numbers, Eigen::VectorXd& to) {
  std::copy_n(from.data() + numbers.from, numbers.count, to.data() + numbers.to);
}

/// A part of two sums of the same vectors in one pass, `from` added to the first: a step and its error,
/// which may be null where nobody asks. Five vectors at most. False when a number is not finite.
bool combine_both(const Eigen::VectorXd& from, const Term* terms, const double* error_weights,
                  std::size_t count, const NumbersAt& part, Eigen::VectorXd& to, Eigen::VectorXd* error);

}  // namespace tendril
