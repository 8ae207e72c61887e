#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/body/bodies.h"
#include "dynamics/rhs/elastic.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/rhs/pull_back.h"
#include "dynamics/rhs/rates.h"

namespace tendril {
namespace {

/// The free coordinates of a system, weighted by the square roots of their masses: there M^-1 K is symmetric.
struct MassMetric {
  explicit MassMetric(const Model& model) {
    for (std::size_t i = 0; i < model.nodes; ++i) {
      if (model.holds_position(i)) continue;
      const auto at = 3 * static_cast<Eigen::Index>(i);
      for (int axis = 0; axis < 3; ++axis) add(at + axis, model.v_begin() + at + axis, model.moved_mass[i]);
    }
    const Eigen::Index k = model.bodies_span();
    for (Eigen::Index i = 0; i < k; ++i)
      add(model.x_begin() + i, model.x_begin() + 2 * k + i,
          model.bodies[static_cast<std::size_t>(i / 3)].mass);
    turns_from = position.size();
    for (std::size_t i = 0; i < model.nodes; ++i) {
      if (!model.turns(i)) continue;
      add(model.theta_begin() + model.twist_index[i], model.spin_begin() + model.twist_index[i],
          model.inertia[i]);
    }
    // The turns of bodies, about their principal axes.
    for (Eigen::Index i = 0; i < k; ++i)
      add(model.x_begin() + k + i, model.x_begin() + 3 * k + i,
          model.bodies[static_cast<std::size_t>(i / 3)].moments[i % 3]);
  }
  void add(Eigen::Index index, Eigen::Index its_rate, double mass) {
    position.push_back(index);
    rate.push_back(its_rate);
    root.push_back(std::sqrt(mass));
  }
  Eigen::Index size() const { return static_cast<Eigen::Index>(root.size()); }

  std::vector<Eigen::Index> position, rate;  ///< indices in y
  std::vector<double> root;
  std::size_t turns_from = 0;  ///< coordinates from here on are angles
};

/// -M^-1/2 K M^-1/2 about a state, by central differences of the accelerations at rest.
class WeightedStiffness {
 public:
  WeightedStiffness(const System& system, const Model& model, const State& state, System::Workspace& work)
      : metric(model), system_(system), model_(model), state_(state), work_(work), y_(state.y) {
    y_.segment(model.v_begin(), model.v_begin()).setZero();
    y_.segment(model.spin_begin(), static_cast<Eigen::Index>(model.twist_nodes)).setZero();
    y_.segment(model.x_begin() + 2 * model.bodies_span(), 2 * model.bodies_span()).setZero();
    shortest_edge_ = std::numeric_limits<double>::infinity();
    for (const RigidBody& body : model.bodies) shortest_edge_ = std::min(shortest_edge_, body.size);
    for (const NodeRange& rod : model.rods)
      for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i)
        shortest_edge_ = std::min(shortest_edge_, model.rest_length[i]);
  }

  /// False when the equations cannot be evaluated beside the state.
  bool apply(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
    double reach = 0.0;
    for (std::size_t k = 0; k < metric.root.size(); ++k) {
      const double scale = k < metric.turns_from ? shortest_edge_ : 1.0;
      reach = std::max(reach, std::abs(x[static_cast<Eigen::Index>(k)]) / metric.root[k] / scale);
    }
    const double step = 1e-6 / reach;
    if (!accelerations(x, step, up_) || !accelerations(x, -step, down_)) return false;
    for (std::size_t k = 0; k < metric.root.size(); ++k)
      out[static_cast<Eigen::Index>(k)] =
          (up_[metric.rate[k]] - down_[metric.rate[k]]) / (2 * step) * metric.root[k];
    return true;
  }

  const MassMetric metric;

 private:
  bool accelerations(const Eigen::VectorXd& x, double step, Eigen::VectorXd& dy) {
    moved_ = y_;
    for (std::size_t k = 0; k < metric.root.size(); ++k)
      moved_[metric.position[k]] += step * x[static_cast<Eigen::Index>(k)] / metric.root[k];
    turn_from_principal_axes(model_, state_, moved_);
    if (!system_.derivative(state_, state_.time, moved_, dy, work_).ok()) return false;
    turn_to_principal_axes(model_, state_, dy);
    return true;
  }

  const System& system_;
  const Model& model_;
  const State& state_;
  System::Workspace& work_;
  Eigen::VectorXd y_, moved_, up_, down_;
  double shortest_edge_;  ///< or smallest body
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

/// Largest |eigenvalue| of Lanczos's tridiagonal matrix [Lanczos 1950], plus the residual of its vector: how
/// far beyond it the true value may lie.
double largest_ritz_value(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  const auto k = static_cast<Eigen::Index>(diagonal.size());
  const Eigen::Map<const Eigen::VectorXd> d(diagonal.data(), k);
  const Eigen::Map<const Eigen::VectorXd> b(beside.data(), k - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(d, b);
  if (solver.info() != Eigen::Success) return 0.0;
  Eigen::Index largest = 0;
  solver.eigenvalues().cwiseAbs().maxCoeff(&largest);
  return std::abs(solver.eigenvalues()[largest]) +
         beside.back() * std::abs(solver.eigenvectors()(k - 1, largest));
}

}  // namespace

double System::largest_frequency(const State& state, int vectors, Workspace& work) const {
  WeightedStiffness stiffness(*this, *model_, state, work);
  const Eigen::Index size = stiffness.metric.size();
  if (size == 0) return fastest_nutation(*model_, state);
  std::vector<double> diagonal;
  std::vector<double> beside;
  Eigen::VectorXd x = start_vector(size);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd next(size);
  const Eigen::Index count = std::min<Eigen::Index>(vectors, size);
  for (Eigen::Index j = 0; j < count && stiffness.apply(x, next); ++j) {
    diagonal.push_back(next.dot(x));
    next -= diagonal.back() * x;
    if (j > 0) next -= beside.back() * before;
    beside.push_back(next.norm());
    if (beside.back() < 1e-9 * std::abs(diagonal.front())) break;
    before = x;
    x = next / beside.back();
  }
  const double nutation = fastest_nutation(*model_, state);
  return diagonal.empty() ? nutation : std::max(nutation, std::sqrt(largest_ritz_value(diagonal, beside)));
}

}  // namespace tendril
