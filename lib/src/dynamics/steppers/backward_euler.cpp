#include <tendril/dynamics/backward_euler.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "dynamics/rhs/workspace.h"

namespace tendril {
namespace {

constexpr double kConverged = 1e-9;   // what a correction moves in the step, in shortest lengths or radians
constexpr double kDifference = 1e-5;  // of the matrix, likewise; central
constexpr int kMatrices = 6;
constexpr int kIterations = 12;           // on one matrix
constexpr double kLeastPart = 1.0 / 512;  // of a step
constexpr double kFarTurned = 0.5;        // cosine of what an edge turns by in a part of a step

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
        scale(Eigen::VectorXd::Constant(moved + turned + 2 * bodies, 1.0)),
        edges(s.node_count(), Vec3::Zero()) {
    scale.head(moved).setConstant(shortest_length(s));
    scale.segment(moved + turned, bodies).setConstant(shortest_length(s));
  }

  void assemble(const State& from, double h, const Eigen::VectorXd& z);
  Evaluation defect(const State& from, double h, const Eigen::VectorXd& z, Eigen::VectorXd& out);
  Evaluation renew_matrix(const State& from, double h, const Eigen::VectorXd& z);
  bool iterate(const State& from, double h, Eigen::VectorXd& z, Evaluation& at);
  bool solve(const State& from, double h, Eigen::VectorXd& z, Evaluation& at);
  bool follow_edges();
  Evaluation advance(State& state, double h);
  /// A step of nearly the same size is served well by its matrix.
  bool serves(double h) const { return matrix_step && std::abs(*matrix_step - h) <= 0.1 * h; }

  const System& system;
  System::WorkspacePtr work;
  Eigen::Index moved, turned, bodies;  ///< 3n, m, 3k
  Eigen::VectorXd scale;               ///< per unknown: shortest length, or 1 rad
  std::vector<Vec3> edges;             ///< by first nodes, at the part of the step that was taken last
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

Evaluation BackwardEuler::Implementation::renew_matrix(const State& from, double h,
                                                       const Eigen::VectorXd& z) {
  Eigen::MatrixXd jacobian(z.size(), z.size());
  Eigen::VectorXd beside = z;
  Eigen::VectorXd ahead, behind;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const double by = kDifference * scale[k] / h;
    beside[k] = z[k] + by;
    if (const Evaluation at = defect(from, h, beside, ahead); !at.ok()) return at;
    beside[k] = z[k] - by;
    if (const Evaluation at = defect(from, h, beside, behind); !at.ok()) return at;
    jacobian.col(k) = (ahead - behind) / (2.0 * by);
    beside[k] = z[k];
  }
  matrix.compute(jacobian);
  matrix_step = h;
  return {};
}

/// Corrects z on one matrix. True when converged; a failed evaluation is left in `at`.
bool BackwardEuler::Implementation::iterate(const State& from, double h, Eigen::VectorXd& z, Evaluation& at) {
  Eigen::VectorXd off;
  if (!serves(h))
    if (at = renew_matrix(from, h, z); !at.ok()) return false;
  if (at = defect(from, h, z, off); !at.ok()) return false;
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

/// Newton from z. True when converged, with y, rate and the kinematics at z.
bool BackwardEuler::Implementation::solve(const State& from, double h, Eigen::VectorXd& z, Evaluation& at) {
  const Eigen::VectorXd begin = z;
  for (int matrices = 0; matrices < kMatrices; ++matrices) {
    if (iterate(from, h, z, at)) return true;
    matrix_step.reset();
    if (at.ok()) continue;
    // A kept matrix may have led astray; one of its own start may not.
    if (matrices > 0) break;
    z = begin;
  }
  return false;
}

/// Takes over the edges that the kinematics have. False, and nothing taken, where one of them has turned far.
bool BackwardEuler::Implementation::follow_edges() {
  const Columns3& now = work->kinematics.e;
  for (const NodeRange& rod : model_of(system).rods)
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i)
      if (!(edges[i].dot(now[i]) >= kFarTurned * edges[i].norm() * now[i].norm())) return false;
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = now[i];
  return true;
}

Evaluation BackwardEuler::Implementation::advance(State& state, double h) {
  start.resize(moved + turned + 2 * bodies);
  start << state.y.segment(moved, moved), state.y.segment(2 * moved + turned, turned),
      state.y.segment(2 * (moved + turned + bodies), 2 * bodies);
  // The equations have other roots, with edges turned over; the step's is the one that a growing step leads
  // to. Most steps go at once.
  Eigen::VectorXd z = start;
  Evaluation at;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const auto first = 3 * static_cast<Eigen::Index>(i);
    edges[i] = state.y.segment<3>(first + 3) - state.y.segment<3>(first);
  }
  for (double done = 0.0, part = 1.0; done < 1.0;) {
    const double next = std::min(1.0, done + part);
    Eigen::VectorXd z_next = z;
    if (solve(state, next * h, z_next, at) && follow_edges()) {
      z.swap(z_next);
      done = next;
      part *= 2.0;
      continue;
    }
    matrix_step.reset();
    part *= 0.5;
    if (part < kLeastPart) return {Evaluation::Outcome::not_converged, at.node};
  }
  y[y.size() - 1] += h * rate[rate.size() - 1];
  state.y = y;
  state.time += h;
  return system.rebase(state, *work);
}

}  // namespace tendril
