#include <tendril/dynamics/cash_karp.h>

namespace tendril {

CashKarp::CashKarp(const System& system) : system_(system), work_(system.make_workspace()) {}

Evaluation CashKarp::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  using T = CashKarpTableau;
  for (std::size_t s = 0; s < k_.size(); ++s) {
    if (s == 0 && first_known_) continue;
    stage_ = state.y;
    for (std::size_t j = 0; j < s; ++j)
      if (T::b[s][j] != 0.0) stage_.noalias() += (h * T::b[s][j]) * k_[j];
    ++evaluations_;
    const Evaluation at = system_.derivative(state, state.time + T::a[s] * h, stage_, k_[s], *work_);
    if (!at.ok()) return at;
    if (s == 0) first_known_ = true;
  }
  y = state.y;
  error.setZero(state.y.size());
  for (std::size_t s = 0; s < k_.size(); ++s) {
    if (T::c[s] != 0.0) y.noalias() += (h * T::c[s]) * k_[s];
    if (T::c[s] != T::c_star[s]) error.noalias() += (h * (T::c[s] - T::c_star[s])) * k_[s];
  }
  return y.allFinite() && error.allFinite() ? Evaluation{} : Evaluation{Evaluation::Outcome::not_finite, 0};
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
