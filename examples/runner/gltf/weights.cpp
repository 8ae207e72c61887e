#include "gltf/weights.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

namespace tendril::runner {
namespace {

using Index = Eigen::Index;

/// Some columns with the best weights for them.
struct Choice {
  std::vector<std::size_t> columns;
  Eigen::VectorXd weights;
  double value =
      std::numeric_limits<double>::infinity();  ///< w^T G w; infinite where a weight is not positive
};

/// G w = lambda 1 with 1^T w = 1: w = z / 1^T z and the value 1 / 1^T z where G z = 1. A G that is
/// singular, of joints that move alike, gets a rounding's worth of its size on its diagonal.
Choice weigh(const Eigen::MatrixXd& gram, std::vector<std::size_t> columns) {
  const auto n = static_cast<Index>(columns.size());
  Choice out;
  Eigen::MatrixXd part(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      part(i, j) = gram(static_cast<Index>(columns[static_cast<std::size_t>(i)]),
                        static_cast<Index>(columns[static_cast<std::size_t>(j)]));
  part.diagonal().array() += 1e-12 * part.trace() + std::numeric_limits<double>::min();
  const Eigen::VectorXd z = part.ldlt().solve(Eigen::VectorXd::Ones(n));
  out.columns = std::move(columns);
  if (!(z.minCoeff() > 0.0)) return out;
  out.weights = z / z.sum();
  out.value = 1.0 / z.sum();
  return out;
}

/// The best of those with each column put in at a place: `at` the end adds, another exchanges.
Choice best_with_one(const Eigen::MatrixXd& gram, const Choice& now, std::size_t at) {
  Choice best = now;
  for (std::size_t c = 0; c < static_cast<std::size_t>(gram.rows()); ++c) {
    if (std::find(now.columns.begin(), now.columns.end(), c) != now.columns.end()) continue;
    std::vector<std::size_t> columns = now.columns;
    if (at == columns.size())
      columns.push_back(c);
    else
      columns[at] = c;
    const Choice other = weigh(gram, std::move(columns));
    if (other.value < best.value) best = other;
  }
  return best;
}

}  // namespace

std::vector<std::pair<std::size_t, double>> convex_weights(const Eigen::MatrixXd& gram, std::size_t most) {
  constexpr int kExchanges = 3;
  Choice now;
  while (now.columns.size() < std::min(most, static_cast<std::size_t>(gram.rows()))) {
    Choice next = best_with_one(gram, now, now.columns.size());
    if (!(next.value < now.value)) break;
    now = std::move(next);
  }
  for (int k = 0; k < kExchanges; ++k)
    for (std::size_t at = 0; at < now.columns.size(); ++at) now = best_with_one(gram, now, at);
  std::vector<std::pair<std::size_t, double>> out;
  for (std::size_t k = 0; k < now.columns.size(); ++k)
    out.emplace_back(now.columns[k], now.weights[static_cast<Index>(k)]);
  return out;
}

}  // namespace tendril::runner
