#include <tendril/dynamics/cash_karp.h>

#include <array>
#include <cmath>

#include "dynamics/rhs/rates.h"
#include "dynamics/tiles/tiles.h"
#include "dynamics/vector/combine.h"

namespace tendril {

namespace {

/// The stages of a step.
struct Stages {
  std::array<Eigen::VectorXd, 6> k = {};
  Eigen::VectorXd argument = {};
  bool first_known = false;  ///< k[0] is the derivative at the present state
  long evaluations = 0;
};

/// The derivatives at all stages.
Evaluation differentiate(const Model& model, const State& from, double h, System::Workspace& work,
                         Stages& stages) {
  using T = CashKarpTableau;
  auto& [k, argument, first_known, evaluations] = stages;
  for (std::size_t s = 0; s < k.size(); ++s) {
    if (s == 0 && first_known) continue;
    const Eigen::VectorXd& at_stage = s == 0 ? from.y : argument;
    Term terms[5];
    std::size_t count = 0;
    for (std::size_t j = 0; j < s; ++j)
      if (T::b[s][j] != 0.0) terms[count++] = {h * T::b[s][j], &k[j]};
    if (s > 0) combine(&from.y, terms, count, argument);
    ++evaluations;
    const Evaluation at = rates(model, from, from.time + T::a[s] * h, at_stage, k[s], work);
    if (!at.ok()) return at;
    if (s == 0) first_known = true;
  }
  return {};
}

/// A step from its stages, and its error where that is asked for.
struct Sums {
  Sums(const Stages& stages, double h) {
    using T = CashKarpTableau;
    for (std::size_t s = 0; s < stages.k.size(); ++s) {
      if (T::c[s] == 0.0 && T::c_star[s] == 0.0) continue;
      terms[count] = {h * T::c[s], &stages.k[s]};
      error_weights[count++] = h * (T::c[s] - T::c_star[s]);
    }
  }
  bool put(const Eigen::VectorXd& from, const NumbersAt& part, Eigen::VectorXd& y,
           Eigen::VectorXd* error) const {
    return combine_both(from, terms, error_weights, count, part, y, error);
  }
  /// One number more, beside what is there.
  void add(Eigen::Index from, Eigen::Index to, Eigen::VectorXd& y, Eigen::VectorXd* error) const {
    for (std::size_t j = 0; j < count; ++j) {
      y[to] += terms[j].weight * (*terms[j].vector)[from];
      if (error) (*error)[to] += error_weights[j] * (*terms[j].vector)[from];
    }
  }

  Term terms[5];
  double error_weights[5];
  std::size_t count = 0;
};

Evaluation step_whole(const Model& model, const State& from, double h, System::Workspace& work,
                      Stages& stages, Eigen::VectorXd& y, Eigen::VectorXd* error) {
  if (const Evaluation at = differentiate(model, from, h, work, stages); !at.ok()) return at;
  if (!Sums(stages, h).put(from.y, {0, 0, model.size()}, y, error))
    return {Evaluation::Outcome::not_finite, 0};
  return {};
}

/// A tile at a time. False where one cannot be stepped: the whole says why.
bool step_tiles(const Model& model, const State& from, double h, System::Workspace& work, Stages& stages,
                Eigen::VectorXd& y, Eigen::VectorXd* error) {
  TileScratch& scratch = TileScratch::of(model, work);
  y[model.work_index()] = from.y[model.work_index()];
  if (error) (*error)[model.work_index()] = 0.0;
  for (const Tiles::Tile& tile : model.tiles->all()) {
    const State& part = scratch.take(tile, from);
    stages.first_known = false;
    if (!differentiate(*tile.part, part, h, scratch.workspace(tile), stages).ok()) return false;
    const Sums sums(stages, h);
    for (const NumbersAt& own : tile.own)
      if (!sums.put(part.y, own, y, error)) return false;
    sums.add(tile.part->work_index(), model.work_index(), y, error);
  }
  return std::isfinite(y[model.work_index()]);
}

}  // namespace

struct CashKarp::Implementation {
  const System& system;
  System::WorkspacePtr work = system.make_workspace();
  Stages whole = {}, tile = {};
  Eigen::VectorXd next = {};  ///< of a step that is taken as it is

  Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd* error) {
    const Model& model = model_of(system);
    y.resize(model.size());
    if (error) error->resize(model.size());
    if (model.tiles && step_tiles(model, state, h, *work, tile, y, error)) {
      whole.evaluations += static_cast<long>(whole.k.size());
      return {};
    }
    return step_whole(model, state, h, *work, whole, y, error);
  }
};

CashKarp::CashKarp(const System& system) : self_(new Implementation{system}) {}
CashKarp::~CashKarp() = default;

Evaluation CashKarp::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  return self_->step(state, h, y, &error);
}

Evaluation CashKarp::advance(State& state, double h) {
  if (const Evaluation at = self_->step(state, h, self_->next, nullptr); !at.ok()) return at;
  state.y.swap(self_->next);
  state.time += h;
  restart();
  return self_->system.rebase(state, *self_->work);
}

void CashKarp::restart() {
  self_->whole.first_known = false;
}

long CashKarp::evaluations() const {
  return self_->whole.evaluations;
}

System::Workspace& CashKarp::workspace() {
  return *self_->work;
}

}  // namespace tendril
