#include <tendril/base/error.h>
#include <tendril/dynamics/rodas.h>

#include <array>

#include "jacobian.h"

namespace tendril {
namespace {

constexpr double kGamma = 0.25;
constexpr std::array<double, 6> kTime{0.0, 0.386, 0.21, 0.63, 1.0, 1.0};
constexpr std::array<double, 6> kTimeSlope{0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0};
/// Arguments of the stages from the stages before (the sixth adds the fifth), and what they add to the
/// right-hand side.
constexpr std::array<std::array<double, 5>, 6> kA{{
    {},
    {0.1544000000000000e+01},
    {0.9466785280815826e+00, 0.2557011698983284e+00},
    {0.3314825187068521e+01, 0.2896124015972201e+01, 0.9986419139977817e+00},
    {0.1221224509226641e+01, 0.6019134481288629e+01, 0.1253708332932087e+02, -0.6878860361058950e+00},
    {0.1221224509226641e+01, 0.6019134481288629e+01, 0.1253708332932087e+02, -0.6878860361058950e+00, 1.0},
}};
constexpr std::array<std::array<double, 5>, 6> kC{{
    {},
    {-0.5668800000000000e+01},
    {-0.2430093356833875e+01, -0.2063599157091915e+00},
    {-0.1073529058151375e+00, -0.9594562251023355e+01, -0.2047028614809616e+02},
    {0.7496443313967647e+01, -0.1024680431464352e+02, -0.3399990352819905e+02, 0.1170890893206160e+02},
    {0.8083246795921522e+01, -0.7981132988064893e+01, -0.3152159432874371e+02, 0.1631930543123136e+02,
     -0.6058818238834054e+01},
}};

}  // namespace

struct Rodas::Implementation {
  explicit Implementation(const System& s)
      : system(s),
        work(s.make_workspace()),
        at(s.model()),
        jacobian(at, s.twist_count() > 0),
        matrix(at.size(), at.half) {
    for (const auto& force : s.scene().forces) works = works || !force->has_energy();
    for (const Anchor& anchor : s.scene().anchors) works = works || anchor.motion;
    for (const Rod& rod : s.scene().rods) works = works || rod.mass_damping > 0.0 || rod.viscosity > 0.0;
  }

  Evaluation prepare(const State& state) {
    if (known) return {};
    ++evaluations;
    if (const Evaluation ok = system.derivative(state, state.time, state.y, rate, *work); !ok.ok()) return ok;
    const long cost = differentiate(system, at, state, rate, *work, jacobian);
    if (cost < 0) return {Evaluation::Outcome::not_finite, 0};
    evaluations += cost;
    known = true;
    return {};
  }

  /// (s - a_u)(s - c_x) - a_x, factored.
  bool factor(double s) {
    matrix.data() = -jacobian.a_by_x.data() - s * jacobian.a_by_u.data();
    if (jacobian.connected) {
      matrix.data() -= s * jacobian.c_by_x.data();
      add_product();
    }
    for (Eigen::Index k = 0; k < at.size(); ++k) matrix.at(k, k) += s * s;
    return matrix.factor();
  }

  /// a_u c_x, as far as it lies in the band.
  void add_product() {
    const Eigen::Index half = matrix.half();
    for (Eigen::Index row = 0; row < at.size(); ++row)
      for (Eigen::Index k = std::max<Eigen::Index>(0, row - half); k <= std::min(at.size() - 1, row + half);
           ++k) {
        const double a = jacobian.a_by_u.at(row, k);
        if (a == 0.0) continue;
        for (Eigen::Index column = std::max<Eigen::Index>(0, k - half);
             column <= std::min(at.size() - 1, k + half); ++column)
          if (matrix.inside(row, column)) matrix.at(row, column) += a * jacobian.c_by_x.at(k, column);
      }
  }

  /// Solves (s - J) U = r for U, both laid out like y.
  void solve(double s, const Eigen::VectorXd& r, Eigen::VectorXd& result) {
    const Eigen::VectorXd rx = r(at.x);
    Eigen::VectorXd b = r(at.u) + s * rx;
    jacobian.a_by_u.multiply_add(-1.0, rx, b);
    matrix.solve(b);
    Eigen::VectorXd u = s * b - rx;
    if (jacobian.connected) jacobian.c_by_x.multiply_add(-1.0, b, u);
    result.setZero(r.size());
    result(at.x) = b;
    result(at.u) = u;
  }

  Evaluation stages(const State& state, double h, Eigen::VectorXd& y) {
    Eigen::VectorXd r = rate;
    for (std::size_t i = 0; i < 6; ++i) {
      y = state.y;
      for (std::size_t j = 0; j < i; ++j) y.noalias() += kA[i][j] * stage[j];
      if (i > 0) {
        ++evaluations;
        const Evaluation ok = system.derivative(state, state.time + kTime[i] * h, y, r, *work);
        if (!ok.ok()) return ok;
      }
      for (std::size_t j = 0; j < i; ++j) r.noalias() += (kC[i][j] / h) * stage[j];
      if (jacobian.by_time.size() > 0 && kTimeSlope[i] != 0.0)
        r.noalias() += (h * kTimeSlope[i]) * jacobian.by_time;
      solve(1.0 / (h * kGamma), r, stage[i]);
    }
    y += stage[5];
    return {};
  }

  /// Work done over the step, by Simpson's rule with the cubic through both ends' positions and velocities.
  Evaluation add_work(const State& state, double h, Eigen::VectorXd& y) {
    const Eigen::Index last = y.size() - 1;
    if (!works) return {};
    Eigen::VectorXd middle = 0.5 * (state.y + y);
    middle(at.x) += h / 8 * (state.y(at.u) - y(at.u));
    middle(at.u) = 1.5 / h * (y(at.x) - state.y(at.x)) - 0.25 * (state.y(at.u) + y(at.u));
    Eigen::VectorXd half_way;
    Eigen::VectorXd end;
    evaluations += 2;
    if (const Evaluation ok = system.derivative(state, state.time + h / 2, middle, half_way, *work); !ok.ok())
      return ok;
    if (const Evaluation ok = system.derivative(state, state.time + h, y, end, *work); !ok.ok()) return ok;
    y[last] = state.y[last] + h / 6 * (rate[last] + 4 * half_way[last] + end[last]);
    return {};
  }

  const System& system;
  System::WorkspacePtr work;
  ChainCoordinates at;
  ChainJacobian jacobian;
  BandMatrix matrix;
  Eigen::VectorXd rate;
  std::array<Eigen::VectorXd, 6> stage;
  bool works = false;  ///< whether anything but springs and energies acts
  bool known = false;  ///< rate and jacobian belong to the present state
  long evaluations = 0;
};

Rodas::Rodas(const System& system) {
  if (!system.scene().joints.empty())
    throw InvalidInput("joints", "the scene has some", "rods on their own for RODAS");
  self_ = std::make_unique<Implementation>(system);
}
Rodas::~Rodas() = default;

Evaluation Rodas::step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) {
  if (const Evaluation ok = self_->prepare(state); !ok.ok()) return ok;
  if (!self_->factor(1.0 / (h * kGamma))) return {Evaluation::Outcome::not_converged, 0};
  if (const Evaluation ok = self_->stages(state, h, y); !ok.ok()) return ok;
  if (const Evaluation ok = self_->add_work(state, h, y); !ok.ok()) return ok;
  error = self_->stage[5];
  return y.allFinite() && error.allFinite() ? Evaluation{} : Evaluation{Evaluation::Outcome::not_finite, 0};
}

Evaluation Rodas::advance(State& state, double h) {
  Eigen::VectorXd y;
  Eigen::VectorXd error;
  if (const Evaluation ok = step(state, h, y, error); !ok.ok()) return ok;
  state.y = std::move(y);
  state.time += h;
  restart();
  return self_->system.rebase(state, *self_->work);
}

void Rodas::restart() {
  self_->known = false;
}

long Rodas::evaluations() const {
  return self_->evaluations;
}

}  // namespace tendril
