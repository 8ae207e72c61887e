#include <tendril/dynamics/fixed_steppers.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tendril {
namespace {

constexpr double kConverged = 1e-9;   // a correction's way over the step, in shortest edges or radians
constexpr double kDifference = 1e-7;  // of the matrix, likewise
constexpr int kMatrices = 12;
constexpr int kIterations = 12;  // on one matrix

double shortest_edge(const System& system) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Rod& rod : system.scene().rods)
    for (std::size_t i = 0; i + 1 < rod.p.size(); ++i)
      shortest = std::min(shortest, (rod.p[i + 1] - rod.p[i]).norm());
  return shortest;
}

}  // namespace

BackwardEuler::BackwardEuler(const System& system)
    : system_(system),
      work_(system.make_workspace()),
      moved_(3 * static_cast<Eigen::Index>(system.node_count())),
      turned_(static_cast<Eigen::Index>(system.twist_count())),
      scale_(moved_ + turned_) {
  scale_.head(moved_).setConstant(shortest_edge(system));
  scale_.tail(turned_).setConstant(1.0);
}

/// The state that velocities and spins z lead to.
void BackwardEuler::place(const State& start, double h, const Eigen::VectorXd& z, Eigen::VectorXd& y) const {
  y = start.y;
  y.head(moved_) += h * z.head(moved_);
  y.segment(moved_, moved_) = z.head(moved_);
  y.segment(2 * moved_, turned_) = h * z.tail(turned_);
  y.segment(2 * moved_ + turned_, turned_) = z.tail(turned_);
}

/// z - z_start - h z'(z); leaves y_ and rate_ at z.
Evaluation BackwardEuler::defect(const State& start, double h, const Eigen::VectorXd& z,
                                 Eigen::VectorXd& out) {
  place(start, h, z, y_);
  ++evaluations_;
  const Evaluation at = system_.derivative(start, start.time + h, y_, rate_, *work_);
  if (!at.ok()) return at;
  out = z - start_;
  out.head(moved_) -= h * rate_.segment(moved_, moved_);
  out.tail(turned_) -= h * rate_.segment(2 * moved_ + turned_, turned_);
  return at;
}

Evaluation BackwardEuler::renew_matrix(const State& start, double h, const Eigen::VectorXd& z,
                                       const Eigen::VectorXd& at_z) {
  Eigen::MatrixXd jacobian(z.size(), z.size());
  Eigen::VectorXd beside = z;
  Eigen::VectorXd there;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    beside[k] = z[k] + kDifference * scale_[k] / h;
    if (const Evaluation at = defect(start, h, beside, there); !at.ok()) return at;
    jacobian.col(k) = (there - at_z) / (beside[k] - z[k]);
    beside[k] = z[k];
  }
  matrix_.compute(jacobian);
  matrix_step_ = h;
  return {};
}

/// Corrects z on one matrix. True when converged; a failed evaluation is left in `at`.
bool BackwardEuler::iterate(const State& start, double h, Eigen::VectorXd& z, Evaluation& at) {
  Eigen::VectorXd off;
  if (at = defect(start, h, z, off); !at.ok()) return false;
  // A step of nearly the same size is served well by its matrix.
  if (!(std::abs(matrix_step_ - h) <= 0.1 * h))
    if (at = renew_matrix(start, h, z, off); !at.ok()) return false;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd correction = matrix_.solve(off);
    const double way = h * correction.cwiseQuotient(scale_).cwiseAbs().maxCoeff();
    if (!(way < 0.5 * before)) return false;
    z -= correction;
    if (at = defect(start, h, z, off); !at.ok()) return false;
    if (way <= kConverged) return true;
    before = way;
  }
  return false;
}

Evaluation BackwardEuler::advance(State& state, double h) {
  start_.resize(moved_ + turned_);
  start_ << state.y.segment(moved_, moved_), state.y.segment(2 * moved_ + turned_, turned_);
  Eigen::VectorXd z = start_;
  Evaluation at;
  for (int matrices = 0; matrices < kMatrices; ++matrices) {
    if (iterate(state, h, z, at)) {
      y_[y_.size() - 1] += h * rate_[rate_.size() - 1];
      state.y = y_;
      state.time += h;
      return system_.rebase(state, *work_);
    }
    matrix_step_ = 0.0;
    if (at.ok()) continue;
    // A kept matrix may have led astray; one of its own start may not.
    if (matrices > 0) break;
    z = start_;
  }
  matrix_step_ = 0.0;
  return {Evaluation::Outcome::not_converged, at.node};
}

}  // namespace tendril
