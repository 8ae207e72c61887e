#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace tendril::runner {

/// Weights, none negative, that sum to 1 and make w^T G w small, with at most `most` of them not zero. G is
/// the Gram matrix of n differences to a target, so that w^T G w is the square of the distance of their
/// weighted mean from it.
///
/// Chosen one by one, each the one that helps most beside those there are, then exchanged while that helps:
/// the exact minimum over all choices would take n^most of them.
/// \return  index and weight, of at least one
std::vector<std::pair<std::size_t, double>> convex_weights(const Eigen::MatrixXd& gram, std::size_t most);

}  // namespace tendril::runner
