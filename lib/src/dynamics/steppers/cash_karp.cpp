#include <tendril/dynamics/cash_karp.h>

#include <array>

#include "dynamics/vector/combine.h"

namespace tendril {

struct CashKarp::Implementation {
  const System& system;
  System::WorkspacePtr work = system.make_workspace();
  std::array<Eigen::VectorXd, 6> k = {};
  Eigen::VectorXd stage = {};
  bool first_known = false;  ///< k[0] is the derivative at the present state
  long evaluations = 0;
};

CashKarp::CashKarp(const System& system) : self_(new Implementation{system}) {}
CashKarp::~CashKarp() = default;

Evaluation CashKarp::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  using T = CashKarpTableau;
  auto& [system, work, k, stage, first_known, evaluations] = *self_;
  for (std::size_t s = 0; s < k.size(); ++s) {
    if (s == 0 && first_known) continue;
    const Eigen::VectorXd& at_stage = s == 0 ? state.y : stage;
    Term terms[5];
    std::size_t count = 0;
    for (std::size_t j = 0; j < s; ++j)
      if (T::b[s][j] != 0.0) terms[count++] = {h * T::b[s][j], &k[j]};
    if (s > 0) combine(&state.y, terms, count, stage);
    ++evaluations;
    const Evaluation at = system.derivative(state, state.time + T::a[s] * h, at_stage, k[s], *work);
    if (!at.ok()) return at;
    if (s == 0) first_known = true;
  }
  Term terms[5];
  double error_weights[5];
  std::size_t count = 0;
  for (std::size_t s = 0; s < k.size(); ++s) {
    if (T::c[s] == 0.0 && T::c_star[s] == 0.0) continue;
    terms[count] = {h * T::c[s], &k[s]};
    error_weights[count++] = h * (T::c[s] - T::c_star[s]);
  }
  if (!combine_both(state.y, terms, error_weights, count, y, error))
    return {Evaluation::Outcome::not_finite, 0};
  return {};
}

Evaluation CashKarp::advance(State& state, double h) {
  Eigen::VectorXd y;
  Eigen::VectorXd error;
  if (const Evaluation at = step(state, h, y, error); !at.ok()) return at;
  state.y = std::move(y);
  state.time += h;
  restart();
  return self_->system.rebase(state, *self_->work);
}

void CashKarp::restart() {
  self_->first_known = false;
}

long CashKarp::evaluations() const {
  return self_->evaluations;
}

System::Workspace& CashKarp::workspace() {
  return *self_->work;
}

}  // namespace tendril
