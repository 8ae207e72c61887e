#include <tendril/dynamics/stiffness.h>

#include <Eigen/SparseLU>

#include "bench/clock.h"
#include "bench/contest.h"

namespace tendril::bench {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Linearly implicit Euler on a clamped rod without twist, v' = v + dv, p' = p + h v', with
///   (M (1 + h alpha) + h^2 K) dv = h (M a(p, v) - h K v),
/// the exact K, and the clamped node left out. Stable at any step; its error is a series in powers of h.
class LinearlyImplicit {
 public:
  explicit LinearlyImplicit(const Problem& problem)
      : problem_(problem),
        rod_(problem.system.scene().rods[0]),
        size_(3 * static_cast<Eigen::Index>(problem.system.node_count())),
        work_(problem.system.make_workspace()),
        rate_(problem.start.y),
        mass_(size_) {
    for (Eigen::Index i = 0; i < size_; ++i) mass_[i] = rod_.mass[static_cast<std::size_t>(i / 3)];
  }

  bool step(State& state, double h) {
    if (!problem_.system.derivative(state, state.time, state.y, rate_, *work_).ok()) return false;
    if (!elastic_stiffness(problem_.system, state, stiffness_, *work_).ok()) return false;
    const Eigen::Index free = size_ - 3;
    const Matrix k = stiffness_.bottomRightCorner(free, free);
    Matrix left = h * h * k;
    left.diagonal() += (1.0 + h * rod_.mass_damping) * mass_.tail(free);
    const auto v = state.y.segment(size_ + 3, free);
    const Eigen::VectorXd right =
        h * (mass_.tail(free).cwiseProduct(rate_.segment(size_ + 3, free)) - h * (k * v));
    if (!analysed_) solver_.analyzePattern(left);
    analysed_ = true;
    solver_.factorize(left);
    if (solver_.info() != Eigen::Success) return false;
    state.y.segment(size_ + 3, free) += solver_.solve(right);
    state.y.segment(3, free) += h * state.y.segment(size_ + 3, free);
    state.time += h;
    return problem_.system.rebase(state, *work_).ok();
  }

 private:
  const Problem& problem_;
  const Rod& rod_;
  Eigen::Index size_;
  System::WorkspacePtr work_;
  Eigen::VectorXd rate_, mass_;
  Matrix stiffness_;
  Eigen::SparseLU<Matrix, Eigen::NaturalOrdering<int>> solver_;
  bool analysed_ = false;
};

std::optional<Eigen::VectorXd> end_of(const Problem& problem, int steps, Deadline& deadline) {
  LinearlyImplicit method(problem);
  State state = problem.start;
  for (int i = 0; i < steps; ++i)
    if (deadline.passed() || !method.step(state, problem.duration / steps)) return std::nullopt;
  return state.y.head(3 * static_cast<Eigen::Index>(problem.system.node_count()));
}

}  // namespace

std::optional<Extrapolated> extrapolated_euler(const Problem& problem, double seconds) {
  if (problem.system.twist_count() > 0) return std::nullopt;
  std::vector<Eigen::VectorXd> row;
  std::optional<Extrapolated> out;
  Deadline deadline(seconds);
  for (int steps = 256; steps <= 65536; steps *= 2) {
    const std::optional<Eigen::VectorXd> end = end_of(problem, steps, deadline);
    if (!end) break;
    std::vector<Eigen::VectorXd> next{*end};
    for (std::size_t j = 0; j < row.size(); ++j)
      next.push_back(next[j] + (next[j] - row[j]) / (std::exp2(static_cast<double>(j) + 1.0) - 1.0));
    if (!row.empty()) {
      const double settled = distance(problem, next.back(), row.back());
      if (!out || settled < out->settled) out = {next.back(), settled, steps};
      if (settled < 1e-9) break;
    }
    row = std::move(next);
  }
  return out;
}

}  // namespace tendril::bench
