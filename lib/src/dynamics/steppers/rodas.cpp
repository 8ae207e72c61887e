#include <tendril/dynamics/rodas.h>

#include <array>

#include "dynamics/body/bodies.h"
#include "dynamics/rhs/rates.h"
#include "dynamics/vector/combine.h"
#include "dynamics/vector/finite.h"
#include "stiff_solver.h"

namespace tendril {
namespace {

constexpr double kGamma = 0.25;
constexpr std::array<double, 6> kTime{0.0, 0.75, 0.321448134013046, 0.519745732277726, 1.0, 1.0};
constexpr std::array<double, 6> kTimeSlope{0.25, -0.5, -0.189532918363016, 0.085612108792769, 0.0, 0.0};
/// Arguments of the stages from the stages before (the sixth adds the fifth), and what they add to the
/// right-hand side.
constexpr std::array<std::array<double, 5>, 6> kA{{
    {},
    {3.0},
    {0.906377755268814, -0.189707390391685},
    {3.758617027739064, 1.161741776019525, -0.849258085312803},
    {7.089566927282776, 4.573591406461604, -8.423496976860259, -0.959280113459775},
    {7.089566927282776, 4.573591406461604, -8.423496976860259, -0.959280113459775, 1.0},
}};
constexpr std::array<std::array<double, 5>, 6> kC{{
    {},
    {-12.0},
    {-6.354581592719008, 0.338972550544623},
    {-8.575016317114033, -7.606483992117508, 12.22499765012482},
    {-5.888975457523102, -8.157396617841821, 24.805546872612922, 12.790401512796979},
    {-4.408651676063871, -6.692003137674639, 24.625568527593117, 16.627521966636085, -5.714285714285718},
}};
/// Of the embedded solution's error, which the step's own, of an order more, stays well below.
constexpr double kShare = 0.4;

}  // namespace

struct Rodas::Implementation {
  explicit Implementation(const System& s)
      : system(s), work(s.make_workspace()), solver(make_stiff_solver(s, *work)) {
    const Model& model = model_of(s);
    for (const auto& force : s.scene().forces) works = works || !force->has_energy();
    for (const Anchor& anchor : model.anchors) moves = moves || anchor.motion;
    for (const Model::Segment& segment : model.segments) resists = resists || segment.viscous;
    for (const Joint& joint : s.scene().joints) moves = moves || !joint.reaction;
    works = works || moves || resists || model.damped;
  }

  Evaluation prepare(const State& state) {
    if (known) return {};
    if (!arrived(state)) {
      ++evaluations;
      if (const Evaluation ok = system.derivative(state, state.time, state.y, rate, *work); !ok.ok())
        return ok;
    }
    const long cost = solver->differentiate(state, rate);
    if (cost < 0) return solver->failure();
    evaluations += cost;
    known = true;
    return {};
  }

  /// Takes over the derivative at the last step's end where the state is that end, rebased: only the angles
  /// are counted from a new reference.
  bool arrived(const State& state) {
    const Model& model = model_of(system);
    if (end.size() == 0 || state.time != end_time) return false;
    const Eigen::Index places = model.theta_begin();
    const Eigen::Index rest = model.spin_begin();
    if (state.y.head(places) != end_y.head(places)) return false;
    const auto m = static_cast<Eigen::Index>(model.twist_nodes);
    if (state.y.segment(rest, m) != end_y.segment(rest, m)) return false;
    const Eigen::Index k = model.bodies_span();
    const Eigen::Index x = model.x_begin();
    if (state.y.segment(x, k) != end_y.segment(x, k)) return false;
    if (state.y.segment(x + 2 * k, 2 * k) != end_y.segment(x + 2 * k, 2 * k)) return false;
    rate.swap(end);
    end.resize(0);
    rate.segment(x + k, k) = state.y.segment(x + 3 * k, k);
    for (std::size_t i = 0; i < model.nodes; ++i)
      if (model.has_twist(i))
        rate[model.theta_begin() + model.twist_index[i]] =
            model.turns(i) ? state.y[model.spin_begin() + model.twist_index[i]] : 0.0;
    return true;
  }

  Evaluation stages(const State& state, double h, Eigen::VectorXd& y) {
    Eigen::VectorXd r = rate;
    for (std::size_t i = 0; i < 6; ++i) {
      Term terms[6];
      for (std::size_t j = 0; j < i; ++j) terms[j] = {kA[i][j], &stage[j]};
      if (i > 0) {
        combine(&state.y, terms, i, y);
        ++evaluations;
        const Evaluation ok = system.derivative(state, state.time + kTime[i] * h, y, r, *work);
        if (!ok.ok()) return ok;
      }
      for (std::size_t j = 0; j < i; ++j) terms[j].weight = kC[i][j] / h;
      if (i > 0) combine(&r, terms, i, r);
      if (solver->by_time().size() > 0 && kTimeSlope[i] != 0.0)
        r.noalias() += (h * kTimeSlope[i]) * solver->by_time();
      solver->solve(1.0 / (h * kGamma), r, stage[i]);
    }
    y += stage[5];
    return {};
  }

  /// Springs that only store energy do no work; they are left out where nothing else asks for their forces.
  Evaluation power_half_way(const Model& model, const State& state, double h, double& power) {
    if (!moves && !resists) return power_of_loads(model, state, state.time + h / 2, middle, power, *work);
    const Evaluation ok = rates(model, state, state.time + h / 2, middle, middle_rate, *work);
    if (ok.ok()) power = middle_rate[model.work_index()];
    return ok;
  }

  /// Work done over the step, by Simpson's rule with the cubic through both ends' positions and velocities.
  Evaluation add_work(const State& state, double h, Eigen::VectorXd& y) {
    if (!works) return {};
    const Model& model = model_of(system);
    const Eigen::Index last = y.size() - 1;
    const auto n = model.v_begin();
    const auto m = static_cast<Eigen::Index>(model.twist_nodes);
    middle = 0.5 * (state.y + y);
    const auto bend = [&](Eigen::Index x, Eigen::Index u, Eigen::Index count) {
      middle.segment(x, count) += h / 8 * (state.y.segment(u, count) - y.segment(u, count));
      middle.segment(u, count) = 1.5 / h * (y.segment(x, count) - state.y.segment(x, count)) -
                                 0.25 * (state.y.segment(u, count) + y.segment(u, count));
    };
    bend(0, n, n);
    if (m > 0) bend(model.theta_begin(), model.spin_begin(), m);
    bend(model.x_begin(), model.x_begin() + 2 * model.bodies_span(), model.bodies_span());
    bend_turns(model, h, state.y, y, middle);
    evaluations += 2;
    double half_way = 0.0;
    if (const Evaluation ok = power_half_way(model, state, h, half_way); !ok.ok()) return ok;
    if (const Evaluation ok = system.derivative(state, state.time + h, y, end, *work); !ok.ok()) return ok;
    y[last] = state.y[last] + h / 6 * (rate[last] + 4 * half_way + end[last]);
    end_time = state.time + h;
    end_y = y;
    return {};
  }

  const System& system;
  System::WorkspacePtr work;
  std::unique_ptr<StiffSolver> solver;
  Eigen::VectorXd rate;
  std::array<Eigen::VectorXd, 6> stage;
  Eigen::VectorXd middle, middle_rate;
  Eigen::VectorXd end, end_y;  ///< derivative at the end of the last step tried; empty when there is none
  double end_time = 0.0;
  bool works = false;    ///< whether anything but springs and energies acts
  bool moves = false;    ///< what is held may do work on the springs
  bool resists = false;  ///< springs turn work into heat
  bool known = false;    ///< rate and Jacobian belong to the present state
  long evaluations = 0;
};

Rodas::Rodas(const System& system) : self_(std::make_unique<Implementation>(system)) {}
Rodas::~Rodas() = default;

Evaluation Rodas::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  if (const Evaluation ok = self_->prepare(state); !ok.ok()) return ok;
  if (!self_->solver->factor(1.0 / (h * kGamma))) return {Evaluation::Outcome::not_converged, 0};
  if (const Evaluation ok = self_->stages(state, h, y); !ok.ok()) return ok;
  if (const Evaluation ok = self_->add_work(state, h, y); !ok.ok()) return ok;
  error = kShare * self_->stage[5];
  return all_finite(y) && all_finite(error) ? Evaluation{} : Evaluation{Evaluation::Outcome::not_finite, 0};
}

Evaluation Rodas::advance(State& state, double h) {
  Eigen::VectorXd y;
  Eigen::VectorXd error;
  if (const Evaluation ok = step(state, h, y, error); !ok.ok()) return ok;
  state.y = std::move(y);
  state.time += h;
  go_on();
  return self_->system.rebase(state, *self_->work);
}

void Rodas::go_on() {
  self_->known = false;
}

void Rodas::restart() {
  self_->known = false;
  self_->end.resize(0);
}

long Rodas::evaluations() const {
  return self_->evaluations;
}

}  // namespace tendril
