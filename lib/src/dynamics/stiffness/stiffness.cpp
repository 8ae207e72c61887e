#include <tendril/dynamics/stiffness.h>

#include "stiffness_elements.h"

namespace tendril {
namespace {

/// Gathers entries in the order of System::elastic_gradient.
struct Triplets {
  explicit Triplets(const Model& m) : model(m) { entries.reserve(196 * m.nodes); }

  template <int B, class Place>
  void blocks(std::size_t count, const Block<B>* from, const Place& place) {
    for (std::size_t k = 0; k < count; ++k) {
      const BlockPlace at = place(k);
      if (!at.counts) continue;
      const auto& numbers = from[k].column;
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) add(position(at.row) + r, position(at.column) + c, numbers[c][r]);
        if (at.row_angle) add(angle(at.row), position(at.column) + c, numbers[c][3]);
      }
      if (!at.column_angle) continue;
      for (std::size_t r = 0; r < 3; ++r) add(position(at.row) + r, angle(at.column), numbers[B - 1][r]);
      if (at.row_angle) add(angle(at.row), angle(at.column), numbers[B - 1][3]);
    }
  }
  void block(std::size_t row, std::size_t column, const Mat3& k) {
    for (Eigen::Index r = 0; r < 3; ++r)
      for (Eigen::Index c = 0; c < 3; ++c)
        entries.emplace_back(position(row) + r, position(column) + c, k(r, c));
  }
  void column(std::size_t row, std::size_t node, const Vec3& k) {
    for (Eigen::Index r = 0; r < 3; ++r) entries.emplace_back(position(row) + r, angle(node), k[r]);
  }
  void row(std::size_t node, std::size_t column, const Vec3& k) {
    for (Eigen::Index c = 0; c < 3; ++c) entries.emplace_back(angle(node), position(column) + c, k[c]);
  }
  void angles(std::size_t row, std::size_t column, double k) {
    entries.emplace_back(angle(row), angle(column), k);
  }

  const Model& model;
  std::vector<Eigen::Triplet<double>> entries;

 private:
  void add(Eigen::Index row, Eigen::Index column, double k) { entries.emplace_back(row, column, k); }
  static Eigen::Index position(std::size_t node) { return 3 * static_cast<Eigen::Index>(node); }
  Eigen::Index angle(std::size_t node) const { return model.v_begin() + model.twist_index[node]; }
};

}  // namespace

Evaluation elastic_stiffness(const System& system, const State& state, Eigen::SparseMatrix<double>& stiffness,
                             System::Workspace& work) {
  const Model& model = model_of(system);
  double energy = 0.0;
  Eigen::VectorXd gradient;
  if (const Evaluation at = system.elastic_gradient(state, state.time, state.y, energy, gradient, work);
      !at.ok())
    return at;
  Triplets triplets(model);
  visit_stiffness(model, state, work.kinematics, work.gradient, false, 1.0, triplets);
  stiffness.resize(gradient.size(), gradient.size());
  stiffness.setFromTriplets(triplets.entries.begin(), triplets.entries.end());
  return {};
}

}  // namespace tendril
