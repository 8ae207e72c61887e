#include <tendril/dynamics/backward_euler.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tendril {
namespace {

constexpr double kConverged = 1e-9;   // what a correction moves in the step, in shortest lengths or radians
constexpr double kDifference = 1e-7;  // of the matrix, likewise
constexpr int kMatrices = 12;
constexpr int kIterations = 12;  // on one matrix

/// Of the bodies, the radius of gyration counts.
double shortest_length(const System& system) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Body& body : system.scene().bodies)
    shortest = std::min(shortest, std::sqrt(body.inertia.trace() / 3.0 / body.mass));
  for (const Rod& rod : system.scene().rods)
    for (std::size_t i = 0; i + 1 < rod.p.size(); ++i)
      shortest = std::min(shortest, (rod.p[i + 1] - rod.p[i]).norm());
  return shortest;
}

}  // namespace

struct BackwardEuler::Implementation {
  explicit Implementation(const System& s)
      : system(s),
        work(s.make_workspace()),
        moved(3 * static_cast<Eigen::Index>(s.node_count())),
        turned(static_cast<Eigen::Index>(s.twist_count())),
        bodies(3 * static_cast<Eigen::Index>(s.body_count())),
        scale(Eigen::VectorXd::Constant(moved + turned + 2 * bodies, 1.0)) {
    scale.head(moved).setConstant(shortest_length(s));
    scale.segment(moved + turned, bodies).setConstant(shortest_length(s));
  }

  void assemble(const State& from, double h, const Eigen::VectorXd& z);
  Evaluation defect(const State& from, double h, const Eigen::VectorXd& z, Eigen::VectorXd& out);
  Evaluation renew_matrix(const State& from, double h, const Eigen::VectorXd& z, const Eigen::VectorXd& at_z);
  bool iterate(const State& from, double h, Eigen::VectorXd& z, Evaluation& at);
  Evaluation advance(State& state, double h);
  /// A step of nearly the same size is served well by its matrix.
  bool serves(double h) const { return matrix_step && std::abs(*matrix_step - h) <= 0.1 * h; }

  const System& system;
  System::WorkspacePtr work;
  Eigen::Index moved, turned, bodies;  ///< 3n, m, 3k
  Eigen::VectorXd scale;               ///< per unknown: shortest length, or 1 rad
  Eigen::VectorXd rate, y, start;
  Eigen::PartialPivLU<Eigen::MatrixXd> matrix;
  std::optional<double> matrix_step;  ///< the step the matrix was made for
  long evaluations = 0;
};

BackwardEuler::BackwardEuler(const System& system) : self_(std::make_unique<Implementation>(system)) {}
BackwardEuler::~BackwardEuler() = default;

Evaluation BackwardEuler::advance(State& state, double h) {
  return self_->advance(state, h);
}

void BackwardEuler::restart() {
  self_->matrix_step.reset();
}

long BackwardEuler::evaluations() const {
  return self_->evaluations;
}

/// The state that velocities and spins z = (v | w | u | omega) lead to.
void BackwardEuler::Implementation::assemble(const State& from, double h, const Eigen::VectorXd& z) {
  y = from.y;
  y.head(moved) += h * z.head(moved);
  y.segment(moved, moved) = z.head(moved);
  y.segment(2 * moved, turned) = h * z.segment(moved, turned);
  y.segment(2 * moved + turned, turned) = z.segment(moved, turned);
  // About its spin at the step's end a body turns by h omega: there phi' = omega.
  const Eigen::Index x = 2 * (moved + turned);
  y.segment(x, bodies) += h * z.segment(moved + turned, bodies);
  y.segment(x + bodies, bodies) = h * z.tail(bodies);
  y.segment(x + 2 * bodies, 2 * bodies) = z.tail(2 * bodies);
}

/// z - z_start - h z'(z); leaves y and rate at z.
Evaluation BackwardEuler::Implementation::defect(const State& from, double h, const Eigen::VectorXd& z,
                                                 Eigen::VectorXd& out) {
  assemble(from, h, z);
  ++evaluations;
  const Evaluation at = system.derivative(from, from.time + h, y, rate, *work);
  if (!at.ok()) return at;
  out = z - start;
  out.head(moved) -= h * rate.segment(moved, moved);
  out.segment(moved, turned) -= h * rate.segment(2 * moved + turned, turned);
  out.tail(2 * bodies) -= h * rate.segment(2 * (moved + turned + bodies), 2 * bodies);
  return at;
}

Evaluation BackwardEuler::Implementation::renew_matrix(const State& from, double h, const Eigen::VectorXd& z,
                                                       const Eigen::VectorXd& at_z) {
  Eigen::MatrixXd jacobian(z.size(), z.size());
  Eigen::VectorXd beside = z;
  Eigen::VectorXd there;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    beside[k] = z[k] + kDifference * scale[k] / h;
    if (const Evaluation at = defect(from, h, beside, there); !at.ok()) return at;
    jacobian.col(k) = (there - at_z) / (beside[k] - z[k]);
    beside[k] = z[k];
  }
  matrix.compute(jacobian);
  matrix_step = h;
  return {};
}

/// Corrects z on one matrix. True when converged; a failed evaluation is left in `at`.
bool BackwardEuler::Implementation::iterate(const State& from, double h, Eigen::VectorXd& z, Evaluation& at) {
  Eigen::VectorXd off;
  if (at = defect(from, h, z, off); !at.ok()) return false;
  if (!serves(h))
    if (at = renew_matrix(from, h, z, off); !at.ok()) return false;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd correction = matrix.solve(off);
    const double moved_by = h * correction.cwiseQuotient(scale).cwiseAbs().maxCoeff();
    if (!(moved_by < 0.5 * before)) return false;
    z -= correction;
    if (at = defect(from, h, z, off); !at.ok()) return false;
    if (moved_by <= kConverged) return true;
    before = moved_by;
  }
  return false;
}

Evaluation BackwardEuler::Implementation::advance(State& state, double h) {
  start.resize(moved + turned + 2 * bodies);
  start << state.y.segment(moved, moved), state.y.segment(2 * moved + turned, turned),
      state.y.segment(2 * (moved + turned + bodies), 2 * bodies);
  Eigen::VectorXd z = start;
  Evaluation at;
  for (int matrices = 0; matrices < kMatrices; ++matrices) {
    if (iterate(state, h, z, at)) {
      y[y.size() - 1] += h * rate[rate.size() - 1];
      state.y = y;
      state.time += h;
      return system.rebase(state, *work);
    }
    matrix_step.reset();
    if (at.ok()) continue;
    // A kept matrix may have led astray; one of its own start may not.
    if (matrices > 0) break;
    z = start;
  }
  matrix_step.reset();
  return {Evaluation::Outcome::not_converged, at.node};
}

}  // namespace tendril
