#include <tendril/dynamics/cash_karp.h>

#include <array>
#include <cmath>
#include <utility>

#include "dynamics/rhs/kinematics.h"
#include "dynamics/rhs/rates.h"
#include "dynamics/tiles/rebase.h"
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
    const Model& of_tile = scratch.model(tile);
    if (!differentiate(of_tile, part, h, scratch.workspace(tile), stages).ok()) return false;
    const Sums sums(stages, h);
    for (const NumbersAt& own : tile.own)
      if (!sums.put(part.y, own, y, error)) return false;
    sums.add(of_tile.work_index(), model.work_index(), y, error);
  }
  return std::isfinite(y[model.work_index()]);
}

/// Steps of all tiles in place, frames renewed. What a tile comes to waits until the next one is stepped:
/// that begins with numbers as they were, and the frames of the one before depend on its first nodes.
class TilesInPlace {
 public:
  /// On failure the state is not to be used.
  Evaluation advance(const Model& model, State& state, double h, System::Workspace& work) {
    TileScratch& scratch = TileScratch::of(model, work);
    const std::vector<Tiles::Tile>& tiles = model.tiles->all();
    std::size_t rod = 0;
    double done = state.y[model.work_index()];
    for (std::size_t k = 0; k <= tiles.size(); ++k) {
      if (k < tiles.size())
        if (const Evaluation at = step(tiles[k], scratch, state, h, done); !at.ok())
          return of_scene(tiles[k], at);
      if (k > 0)
        if (const Evaluation at = finish(model, tiles[k - 1], scratch, state, h, rod); !at.ok())
          return of_scene(tiles[k - 1], at);
      std::swap(now_, next_);
    }
    state.y[model.work_index()] = done;
    state.time += h;
    if (!std::isfinite(done)) return {Evaluation::Outcome::not_finite, 0};
    return {};
  }

 private:
  static Evaluation of_scene(const Tiles::Tile& tile, const Evaluation& at) {
    return {at.outcome, at.node + tile.begin};
  }

  /// Into next_.
  Evaluation step(const Tiles::Tile& tile, TileScratch& scratch, const State& state, double h, double& done) {
    const State& part = scratch.take(tile, state);
    const Model& model = scratch.model(tile);
    const Eigen::Index work = model.work_index();
    stages_.first_known = false;
    if (const Evaluation at = differentiate(model, part, h, scratch.workspace(tile), stages_); !at.ok())
      return at;
    next_.resize(part.y.size());
    next_[work] = 0.0;
    const Sums sums(stages_, h);
    for (const NumbersAt& own : tile.own)
      if (!sums.put(part.y, {own.from, own.from, own.count}, next_, nullptr))
        return {Evaluation::Outcome::not_finite, 0};
    sums.add(work, work, next_, nullptr);
    done += next_[work];
    return {};
  }

  /// Of the tile in now_, with the one in next_ behind it.
  Evaluation finish(const Model& model, const Tiles::Tile& tile, TileScratch& scratch, State& state, double h,
                    std::size_t& rod) {
    for (const NumbersAt& before : tile.before) copy(state.y, before, now_);
    for (const NumbersAt& after : tile.after) copy(next_, after, now_);
    Kinematics& kin = scratch.workspace(tile).kinematics;
    const State& reference = scratch.take_reference(tile, state);
    const Model& part = scratch.model(tile);  // with the next one's constants, which do not matter here
    if (const Evaluation at = kinematics(part, reference, state.time + h, now_, Motion::positions, kin);
        !at.ok())
      return at;
    for (const NumbersAt& own : tile.own) copy(now_, own, state.y);
    rebase_seen(model, {part, kin, tile.begin, tile.first, tile.end}, rod, state);
    return {};
  }

  Stages stages_;
  Eigen::VectorXd now_, next_;
};

}  // namespace

struct CashKarp::Implementation {
  const System& system;
  System::WorkspacePtr work = {};  ///< of the first step on: a run that begins with another has no use for it
  Stages whole = {}, tile = {};
  TilesInPlace in_place = {};
  Eigen::VectorXd next = {};  ///< of a step that is taken as it is

  System::Workspace& space() {
    if (!work) work = system.make_workspace();
    return *work;
  }

  Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd* error) {
    const Model& model = model_of(system);
    y.resize(model.size());
    if (error) error->resize(model.size());
    if (model.tiles && step_tiles(model, state, h, space(), tile, y, error)) {
      whole.evaluations += static_cast<long>(whole.k.size());
      return {};
    }
    return step_whole(model, state, h, space(), whole, y, error);
  }
};

CashKarp::CashKarp(const System& system) : self_(new Implementation{system}) {}
CashKarp::~CashKarp() = default;

Evaluation CashKarp::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  return self_->step(state, h, y, &error);
}

Evaluation CashKarp::advance(State& state, double h) {
  const Model& model = model_of(self_->system);
  if (model.tiles) {
    self_->whole.evaluations += static_cast<long>(self_->whole.k.size());
    restart();
    return self_->in_place.advance(model, state, h, self_->space());
  }
  if (const Evaluation at = self_->step(state, h, self_->next, nullptr); !at.ok()) return at;
  state.y.swap(self_->next);
  state.time += h;
  restart();
  return self_->system.rebase(state, self_->space());
}

void CashKarp::restart() {
  self_->whole.first_known = false;
}

long CashKarp::evaluations() const {
  return self_->whole.evaluations;
}

System::Workspace& CashKarp::workspace() {
  return self_->space();
}

}  // namespace tendril
