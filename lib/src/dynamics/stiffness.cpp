#include <tendril/base/error.h>
#include <tendril/dynamics/stiffness.h>

#include "edge_stiffness.h"
#include "elastic.h"

namespace tendril {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

void add(const EdgeStiffness& k, const std::array<Eigen::Index, 14>& at, Triplets& triplets) {
  for (Eigen::Index column = 0; column < 14; ++column)
    for (Eigen::Index row = 0; row < 14; ++row) {
      const Eigen::Index r = at[static_cast<std::size_t>(row)];
      const Eigen::Index c = at[static_cast<std::size_t>(column)];
      if (r >= 0 && c >= 0) triplets.emplace_back(r, c, k(row, column));
    }
}

}  // namespace

Evaluation elastic_stiffness(const System& system, const State& state, Eigen::SparseMatrix<double>& stiffness,
                             System::Workspace& work) {
  const System::Model& model = system.model();
  if (!model.rides.empty()) throw InvalidInput("joints", "the scene has some", "rods on their own");
  double energy = 0.0;
  Eigen::VectorXd gradient;
  if (const Evaluation at = system.elastic_gradient(state, state.time, state.y, energy, gradient, work);
      !at.ok())
    return at;
  Triplets triplets;
  triplets.reserve(196 * model.nodes);
  for (const NodeRange& rod : model.rods)
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i)
      add(edge_stiffness(model, rod, i, state, work), edge_places(model, rod, i), triplets);
  stiffness.resize(gradient.size(), gradient.size());
  stiffness.setFromTriplets(triplets.begin(), triplets.end());
  return {};
}

}  // namespace tendril
