#include <tendril/dynamics/cash_karp.h>

#include "dynamics/vector/combine.h"

namespace tendril {

CashKarp::CashKarp(const System& system) : system_(system), work_(system.make_workspace()) {}

Evaluation CashKarp::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  using T = CashKarpTableau;
  for (std::size_t s = 0; s < k_.size(); ++s) {
    if (s == 0 && first_known_) continue;
    const Eigen::VectorXd& at_stage = s == 0 ? state.y : stage_;
    Term terms[5];
    std::size_t count = 0;
    for (std::size_t j = 0; j < s; ++j)
      if (T::b[s][j] != 0.0) terms[count++] = {h * T::b[s][j], &k_[j]};
    if (s > 0) combine(&state.y, terms, count, stage_);
    ++evaluations_;
    const Evaluation at = system_.derivative(state, state.time + T::a[s] * h, at_stage, k_[s], *work_);
    if (!at.ok()) return at;
    if (s == 0) first_known_ = true;
  }
  Term terms[5];
  double error_weights[5];
  std::size_t count = 0;
  for (std::size_t s = 0; s < k_.size(); ++s) {
    if (T::c[s] == 0.0 && T::c_star[s] == 0.0) continue;
    terms[count] = {h * T::c[s], &k_[s]};
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
  return system_.rebase(state, *work_);
}

void CashKarp::restart() {
  first_known_ = false;
}

}  // namespace tendril
