#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

#include "elastic.h"

namespace tendril {
namespace {

/// The free coordinates of a system weighted by the square roots of their masses, so that M^-1 K becomes
/// symmetric.
struct MassMetric {
  explicit MassMetric(const System::Model& model) {
    for (std::size_t i = 0; i < model.nodes; ++i) {
      if (model.holds_position(i)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        position.push_back(3 * static_cast<Eigen::Index>(i) + axis);
        rate.push_back(model.v_begin() + position.back());
        root.push_back(std::sqrt(model.mass[i]));
      }
    }
    for (std::size_t i = 0; i < model.nodes; ++i) {
      if (!model.has_twist(i) || model.holds_frame(i)) continue;
      position.push_back(model.theta_begin() + model.twist_index[i]);
      rate.push_back(model.spin_begin() + model.twist_index[i]);
      root.push_back(std::sqrt(model.inertia[i]));
    }
  }
  std::vector<Eigen::Index> position, rate;
  std::vector<double> root;
};

/// Fixed start vector without a preferred direction.
Eigen::VectorXd start_vector(Eigen::Index size) {
  Eigen::VectorXd x(size);
  std::uint64_t state = 1;
  for (Eigen::Index i = 0; i < size; ++i) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    x[i] = static_cast<double>(state >> 11) * 0x1.0p-52 - 1.0;
  }
  return x.normalized();
}

}  // namespace

double System::largest_frequency(const State& state, int vectors, Workspace& work) const {
  const Model& model = *model_;
  const MassMetric metric(model);
  const auto size = static_cast<Eigen::Index>(metric.root.size());
  if (size == 0) return 0.0;
  double edge = model.rest_length[model.rods.front().first];
  for (const NodeRange& rod : model.rods)
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i)
      edge = std::min(edge, model.rest_length[i]);

  Eigen::VectorXd y = state.y;
  y.segment(model.v_begin(), model.v_begin()).setZero();
  y.segment(model.spin_begin(), static_cast<Eigen::Index>(model.twist_nodes)).setZero();
  // Accelerations at rest around the state, by central differences along x: -M^-1/2 K M^-1/2 x.
  const auto apply = [&](const Eigen::VectorXd& x, Eigen::VectorXd& out) {
    double reach = 0.0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double scale = metric.position[k] < model.v_begin() ? edge : 1.0;
      reach = std::max(reach, std::abs(x[i]) / metric.root[k] / scale);
    }
    const double step = 1e-6 / reach;
    Eigen::VectorXd dy[2];
    for (int side = 0; side < 2; ++side) {
      Eigen::VectorXd moved = y;
      for (Eigen::Index i = 0; i < size; ++i) {
        const auto k = static_cast<std::size_t>(i);
        moved[metric.position[k]] += (side == 0 ? step : -step) * x[i] / metric.root[k];
      }
      if (!derivative(state, state.time, moved, dy[side], work).ok()) return false;
    }
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      out[i] = (dy[0][metric.rate[k]] - dy[1][metric.rate[k]]) / (2 * step) * metric.root[k];
    }
    return true;
  };

  std::vector<double> diagonal;
  std::vector<double> beside;
  Eigen::VectorXd x = start_vector(size);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd next(size);
  const int count = static_cast<int>(std::min<Eigen::Index>(vectors, size));
  for (int j = 0; j < count; ++j) {
    if (!apply(x, next)) break;
    diagonal.push_back(next.dot(x));
    next -= diagonal.back() * x;
    if (j > 0) next -= beside.back() * before;
    beside.push_back(next.norm());
    if (beside.back() < 1e-9 * std::abs(diagonal.front())) break;
    before = x;
    x = next / beside.back();
  }
  if (diagonal.empty()) return 0.0;
  const auto k = static_cast<Eigen::Index>(diagonal.size());
  const Eigen::Map<const Eigen::VectorXd> d(diagonal.data(), k);
  const Eigen::Map<const Eigen::VectorXd> b(beside.data(), k - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(d, b);
  if (solver.info() != Eigen::Success) return 0.0;
  Eigen::Index largest = 0;
  solver.eigenvalues().cwiseAbs().maxCoeff(&largest);
  // The residual of the Ritz pair bounds how far the true value may lie.
  const double residual = beside.back() * std::abs(solver.eigenvectors()(k - 1, largest));
  return std::sqrt(std::abs(solver.eigenvalues()[largest]) + residual);
}

}  // namespace tendril
