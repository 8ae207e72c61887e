#include <tendril/base/error.h>
#include <tendril/dynamics/stiffness.h>

#include "edge_stiffness.h"
#include "elastic.h"

namespace tendril {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Places of an edge's fourteen variables in the whole, -1 for those that are not there.
std::array<Eigen::Index, 14> places(const System::Model& model, const NodeRange& rod, std::size_t i) {
  std::array<Eigen::Index, 14> at;
  at.fill(-1);
  for (std::size_t k = 0; k < 4; ++k) {
    if ((k == 0 && i == rod.first) || i + k >= rod.first + rod.count + 1) continue;
    const auto node = static_cast<Eigen::Index>(i + k - 1);
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[3 * k + axis] = 3 * node + static_cast<Eigen::Index>(axis);
  }
  for (std::size_t side = 0; side < 2; ++side)
    if (model.has_twist(i + side)) at[12 + side] = model.v_begin() + model.twist_index[i + side];
  return at;
}

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
      add(edge_stiffness(model, rod, i, state, work), places(model, rod, i), triplets);
  stiffness.resize(gradient.size(), gradient.size());
  stiffness.setFromTriplets(triplets.begin(), triplets.end());
  return {};
}

}  // namespace tendril
