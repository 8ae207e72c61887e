#include <tendril/dynamics/nystrom.h>
#include <tendril/dynamics/stability.h>

#include <utility>

#include "dynamics/rhs/rates.h"
#include "dynamics/vector/second_order.h"

namespace tendril {
namespace {

using T = NystromTableau;
constexpr std::size_t kStages = T::c.size();

/// Numbers of y whose rates stand `count` behind them, and of which the derivative is that and more: angles
/// of twist, whose frames turn with edges, and places and turns of bodies. Taken as first-order numbers alone
/// they would ring with a lower order than the masses do; so the rates go in as accelerations' sums, and the
/// rest, which is small, by the weights of rates.
struct Turned {
  Eigen::Index begin, count;
};
std::array<Turned, 2> turned(const Model& model) {
  return {Turned{model.theta_begin(), static_cast<Eigen::Index>(model.twist_nodes)},
          Turned{model.x_begin(), 2 * model.bodies_span()}};
}

/// What a sum of the stages adds to them and their rates.
void add_turned(const Model& model, const SecondOrder& sum, Eigen::VectorXd& to) {
  for (const auto& [begin, count] : turned(model)) {
    if (count == 0) continue;
    for (std::size_t j = 0; j < sum.count; ++j) {
      const auto rest = sum.k[j]->segment(begin, count), faster = sum.k[j]->segment(begin + count, count);
      to.segment(begin, count) += sum.rate[j] * rest + sum.place[j] * faster;
      to.segment(begin + count, count) += sum.rate[j] * faster;
    }
  }
}

/// Where they begin, moved on with the rates that they begin with.
void begin_turned(const Model& model, const Eigen::VectorXd& y, double time, Eigen::VectorXd& to) {
  for (const auto& [begin, count] : turned(model)) {
    to.segment(begin, count) = y.segment(begin, count) + time * y.segment(begin + count, count);
    to.segment(begin + count, count) = y.segment(begin + count, count);
  }
}

}  // namespace

struct Nystrom::Implementation {
  const System& system;
  System::WorkspacePtr work = system.make_workspace();
  /// Derivatives at the stages, of turned() without the rates that stand in y.
  std::array<Eigen::VectorXd, kStages> k = {};
  Eigen::VectorXd argument = {}, next = {}, next_error = {};
  bool first_known = false;  ///< k[0] is that of the present state
  long evaluations = 0;

  /// Into one of k.
  Evaluation differentiate(const State& from, double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    const Model& model = model_of(system);
    ++evaluations;
    if (const Evaluation at = rates(model, from, t, y, dy, *work); !at.ok()) return at;
    for (const auto& [begin, count] : turned(model))
      dy.segment(begin, count) -= y.segment(begin + count, count);
    return {};
  }

  Evaluation stages_from(const State& from, double h) {
    const Model& model = model_of(system);
    if (!first_known)
      if (const Evaluation at = differentiate(from, from.time, from.y, k[0]); !at.ok()) return at;
    first_known = true;
    argument.resize(model.size());
    // No force depends on the work done: stages need not know it.
    argument[model.work_index()] = from.y[model.work_index()];
    for (std::size_t s = 1; s < kStages; ++s) {
      SecondOrder sum{h * T::c[s], s, {}, {}, {}};
      for (std::size_t j = 0; j < s; ++j) {
        sum.k[j] = &k[j];
        sum.place[j] = h * h * T::place[s][j];
        sum.rate[j] = h * T::rate[s][j];
      }
      second_order(from.y, k[0], sum, model.v_begin(), argument);
      begin_turned(model, from.y, sum.time, argument);
      add_turned(model, sum, argument);
      if (const Evaluation at = differentiate(from, from.time + sum.time, argument, k[s]); !at.ok())
        return at;
    }
    return {};
  }

  Evaluation step(const State& from, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
    const Model& model = model_of(system);
    if (const Evaluation at = stages_from(from, h); !at.ok()) return at;
    SecondOrder sum{h, kStages, {}, {}, {}}, off{0.0, kStages, {}, {}, {}};
    for (std::size_t j = 0; j < kStages; ++j) {
      sum.k[j] = off.k[j] = &k[j];
      sum.rate[j] = h * T::b[j];
      off.rate[j] = h * T::difference[j] / T::kErrorShare;
      sum.place[j] = h * (1.0 - T::c[j]) * sum.rate[j];
      off.place[j] = h * (1.0 - T::c[j]) * off.rate[j];
    }
    y.resize(model.size());
    error.resize(model.size());
    bool finite = second_order_both(from.y, k[0], sum, off, model.v_begin(), y, error);
    // Few numbers, or none: they are not worth a vector loop.
    const Eigen::Index rest = model.theta_begin(), w = model.work_index();
    begin_turned(model, from.y, h, y);
    error.tail(error.size() - rest).setZero();
    add_turned(model, sum, y);
    add_turned(model, off, error);
    y[w] = from.y[w];
    for (std::size_t j = 0; j < kStages; ++j) {
      y[w] += sum.rate[j] * (*sum.k[j])[w];
      error[w] += off.rate[j] * (*off.k[j])[w];
    }
    finite = finite && y.tail(y.size() - rest).allFinite() && error.tail(y.size() - rest).allFinite();
    return finite ? Evaluation{} : Evaluation{Evaluation::Outcome::not_finite, 0};
  }
};

Nystrom::Nystrom(const System& system) : self_(new Implementation{system}) {}
Nystrom::~Nystrom() = default;

Evaluation Nystrom::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  return self_->step(state, h, y, error);
}

Evaluation Nystrom::advance(State& state, double h) {
  if (const Evaluation at = self_->step(state, h, self_->next, self_->next_error); !at.ok()) return at;
  state.y.swap(self_->next);
  state.time += h;
  restart();
  return self_->system.rebase(state, *self_->work);
}

void Nystrom::restart() {
  self_->first_known = false;
}

long Nystrom::evaluations() const {
  return self_->evaluations;
}

double Nystrom::growth(double w, double alpha, double beta, double h) const {
  return nystrom_growth(w, alpha, beta, h);
}

}  // namespace tendril
