#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rodas.h>
#include <tendril/dynamics/simulation.h>

#include <numbers>

#include "support/rods.h"

namespace tendril {
namespace {

constexpr double kG = 9.81;
constexpr double kTolerance = 1e-3;

/// A rod so stiff that it moves as a rigid one does: about its hinge, as a pendulum let go horizontally, or
/// about its centre.
struct Stiff {
  std::string name;
  int edges = 8;
  double young = 1e10, density = 1000.0;
  double damping = 0.0, viscosity = 0.0, end_mass = 1.0;
  double duration = 10.0;
  double spin = 0.0;      ///< held by nothing where it is not 0
  double let_go = 1e300;  ///< by its hinge
  double gravity = kG;
  double air = 0.0;        ///< density of air at rest
  bool remembers = false;  ///< beside a force that remembers and does nothing, as a contact before it is one
};
void PrintTo(const Stiff& stiff, std::ostream* out) {
  *out << stiff.name;
}

struct Idle : Force {
  void add(const StateView&, const Loads&) const override {}
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  std::shared_ptr<const ForceMemory> remember(const StateView&,
                                              const std::shared_ptr<const ForceMemory>&) const override {
    return std::make_shared<ForceMemory>();
  }
};

System system_of(const Stiff& stiff) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(stiff.edges, stiff.young, 0.01, stiff.density));
  scene.rods[0].mass_damping = stiff.damping;
  scene.rods[0].viscosity = stiff.viscosity;
  scene.rods[0].mass.back() *= stiff.end_mass;
  if (stiff.spin == 0.0) {
    scene.anchors.push_back({.rod = 0, .node = 0, .holds_frame = false});
    if (stiff.let_go < stiff.duration) scene.anchors[0].until = stiff.let_go;
  }
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, -stiff.gravity, 0)));
  if (stiff.air > 0.0) scene.forces.push_back(std::make_shared<Wind>(WindOptions{.air_density = stiff.air}));
  if (stiff.remembers) scene.forces.push_back(std::make_shared<Idle>());
  return System(scene);
}

/// Mass, first and second moment about the first node; third moment of the edges' middles.
struct Moments {
  double mass = 0.0, first = 0.0, second = 0.0, third = 0.0;
};
Moments moments_of(const Rod& rod) {
  Moments sum;
  for (std::size_t i = 0; i < rod.p.size(); ++i) {
    sum.mass += rod.mass[i];
    sum.first += rod.mass[i] * rod.p[i].x();
    sum.second += rod.mass[i] * rod.p[i].x() * rod.p[i].x();
    if (i > 0)
      sum.third += (rod.p[i].x() - rod.p[i - 1].x()) * std::pow(0.5 * (rod.p[i].x() + rod.p[i - 1].x()), 3);
  }
  return sum;
}

/// theta'' = -(first g / second) cos theta - damping theta' - drag |theta'| theta', each edge dragged at its
/// middle, by Runge-Kutta's classic method at steps far below what could matter.
Eigen::Vector2d pendulum(const Stiff& stiff, const Moments& m, double until) {
  Eigen::Vector2d y(0.0, 0.0);
  const int steps = 20000;
  const double h = until / steps;
  const double width = 2 * 0.01,
               drag = 0.5 * stiff.air * width * WindOptions{}.normal_drag * m.third / m.second;
  const auto rate = [&](const Eigen::Vector2d& at) {
    return Eigen::Vector2d(at[1], -m.first * stiff.gravity / m.second * std::cos(at[0]) -
                                      (stiff.damping + drag * std::abs(at[1])) * at[1]);
  };
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2d a = rate(y), b = rate(y + h / 2 * a), c = rate(y + h / 2 * b), d = rate(y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

/// Where the first node and the tip are at the end.
std::pair<Vec3, Vec3> rigid(const Stiff& stiff, const Rod& rod) {
  const Moments m = moments_of(rod);
  const double centre = m.first / m.mass;
  const auto along = [](double angle) { return Vec3(std::cos(angle), std::sin(angle), 0); };
  const double t = stiff.spin != 0.0 ? 0.0 : std::min(stiff.let_go, stiff.duration);
  const Eigen::Vector2d swung = stiff.spin != 0.0 ? Eigen::Vector2d(0, stiff.spin) : pendulum(stiff, m, t);
  const Vec3 velocity = stiff.spin != 0.0 ? Vec3(Vec3::Zero())
                                          : Vec3(centre * swung[1] * along(swung[0] + std::numbers::pi / 2));
  const double left = stiff.duration - t;
  const Vec3 middle =
      centre * along(swung[0]) + left * velocity - Vec3(0, 0.5 * stiff.gravity * left * left, 0);
  const Vec3 way = along(swung[0] + swung[1] * left);
  return {middle - centre * way, middle + (1.0 - centre) * way};
}

State start_of(const Stiff& stiff, const System& system) {
  State state = system.rest_state();
  const double centre = moments_of(system.scene().rods[0]).first / moments_of(system.scene().rods[0]).mass;
  const auto n = static_cast<Eigen::Index>(system.node_count());
  for (Eigen::Index i = 0; i < n; ++i) state.y[3 * n + 3 * i + 1] = stiff.spin * (state.y[3 * i] - centre);
  return state;
}

class NearlyRigid : public testing::TestWithParam<Stiff> {};

TEST_P(NearlyRigid, MovesAsRigidOnesDo) {
  const System system = system_of(GetParam());
  SimulationOptions options;
  options.method = Method::automatic;
  options.tolerance = kTolerance;
  Simulation simulation(system, start_of(GetParam(), system), options);
  const Report report = simulation.run(GetParam().duration);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const auto [root, tip] = rigid(GetParam(), system.scene().rods[0]);
  const double error = std::max((test::at(simulation.state().y, 0) - root).norm(),
                                (test::at(simulation.state().y, system.node_count() - 1) - tip).norm());
  std::printf("%s: error %.1e of the length, %.1e told, %ld steps, %s\n", GetParam().name.c_str(), error,
              report.drift, report.accepted, report.method.c_str());
  EXPECT_LT(error, 10 * kTolerance);
  // What it tells of its drift is about the error.
  EXPECT_LT(report.drift, 20 * kTolerance);
}

INSTANTIATE_TEST_SUITE_P(
    Rods, NearlyRigid,
    testing::Values(
        Stiff{.name = "hinged"}, Stiff{.name = "hinged_for_longer", .duration = 40.0},
        Stiff{.name = "lightly_damped", .damping = 0.05},
        Stiff{.name = "viscous", .viscosity = 1e-4, .duration = 4.0},
        Stiff{.name = "steel", .edges = 32, .young = 2e11, .density = 7800, .duration = 5.0},
        Stiff{.name = "heavy_end", .end_mass = 200.0},
        Stiff{.name = "stiffer", .young = 1e12, .duration = 5.0}, Stiff{.name = "in_thin_air", .air = 1e-6},
        Stiff{.name = "in_air", .air = 1.2},
        Stiff{.name = "in_air_for_longer", .edges = 16, .young = 1e11, .duration = 40.0, .air = 1.2},
        Stiff{.name = "beside_what_remembers", .remembers = true}, Stiff{.name = "spun", .spin = 3.32},
        Stiff{.name = "spun_faster", .duration = 3.0, .spin = 20.0},
        Stiff{.name = "spun_in_space", .spin = 3.32, .gravity = 0.0}),
    [](const auto& at) { return at.param.name; });

TEST(LetGo, FliesOnAsARigidRodDoes) {
  const Stiff stiff{.name = "let go", .duration = 2.0, .let_go = 1.0};
  const System system = system_of(stiff);
  SimulationOptions options;
  options.method = Method::automatic;
  options.tolerance = kTolerance;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(stiff.duration);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const auto [root, tip] = rigid(stiff, system.scene().rods[0]);
  const double error = std::max((test::at(simulation.state().y, 0) - root).norm(),
                                (test::at(simulation.state().y, 8) - tip).norm());
  std::printf("let go: error %.1e of the length, %.1e told\n", error, report.drift);
  EXPECT_LT(error, 20 * kTolerance);
}

/// What no implicit step can follow to its end is refused, and soon.
TEST(Refusal, OfARingingRodForAMillionSeconds) {
  for (const double young : {1e8, 1e10}) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(8, young, 0.01));
    scene.anchors.push_back({.rod = 0, .node = 0});
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, -kG, 0)));
    const System system(scene);
    SimulationOptions options;
    options.method = Method::automatic;
    options.tolerance = kTolerance;
    const Report report = Simulation(system, system.rest_state(), options).run(1e6);
    EXPECT_EQ(report.stop, Stop::too_stiff) << report.reason;
    EXPECT_LT(report.evaluations, 20'000);
    EXPECT_NE(report.reason.find("evaluations a time unit"), std::string::npos) << report.reason;
  }
}

TEST(Refusal, OfPullsBeyondAllStiffness) {
  for (const double pull : {1e9, 1e12, 1e30})
    for (const bool frame : {false, true}) {
      Scene scene;
      scene.rods.push_back(test::straight_rod(8, 1e10, 0.01));
      scene.anchors.push_back({.rod = 0, .node = 0, .holds_frame = frame});
      scene.forces.push_back(
          std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 8, Vec3(1, 0.3, 0), Signal::constant(pull)));
      const System system(scene);
      SimulationOptions options;
      options.method = Method::automatic;
      options.tolerance = kTolerance;
      const Report report = Simulation(system, system.rest_state(), options).run(1.0);
      EXPECT_NE(report.stop, Stop::finished);
      EXPECT_FALSE(report.reason.empty());
      EXPECT_LT(report.evaluations, 200'000) << report.reason;
    }
}

/// Steps as RODAS takes them, after which all velocities are smaller; told as work done, or not.
class Leaky : public EmbeddedStepper {
 public:
  static constexpr double kRate = 2e-3;
  Leaky(const System& system, bool told)
      : system_(system), work_(system.make_workspace()), rodas_(system), told_(told) {}
  Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) override {
    if (const Evaluation at = rodas_.step(state, h, y, error); !at.ok()) return at;
    State end = state;
    end.y = y;
    const double before = system_.energies(end, *work_).kinetic;
    const auto n = 3 * static_cast<Eigen::Index>(system_.node_count());
    y.segment(n, n) *= std::exp(-kRate * h);
    if (told_) y[y.size() - 1] -= before * (1.0 - std::exp(-2.0 * kRate * h));
    return {};
  }
  Evaluation advance(State&, double) override { return {Evaluation::Outcome::not_converged, 0}; }
  void go_on() override { rodas_.go_on(); }
  void restart() override { rodas_.restart(); }
  int error_order() const override { return 3; }
  long evaluations() const override { return rodas_.evaluations(); }
  const char* name() const override { return "leaky"; }

 private:
  const System& system_;
  System::WorkspacePtr work_;
  Rodas rodas_;
  bool told_;
};

/// A spun rod loses speed as exp(-rate t): it lags by the rest of its angle, at half its length.
TEST(Drift, IsHowFarWhatIsLostPutsAMotionOff) {
  const Stiff stiff{.name = "spun", .young = 1e6, .duration = 3.0, .spin = 3.32, .gravity = 0.0};
  const System system = system_of(stiff);
  const auto run = [&](double limit, bool told) {
    SimulationOptions options;
    options.own_stepper = [&](const System& of) { return std::make_unique<Leaky>(of, told); };
    options.tolerance = kTolerance;
    options.drift_limit = limit;
    options.energy_limit = 0.1;
    return Simulation(system, start_of(stiff, system), options).run(stiff.duration);
  };
  const double t = stiff.duration, rate = Leaky::kRate;
  const double lag = 0.5 * stiff.spin * (t - (1.0 - std::exp(-rate * t)) / rate);
  for (const bool told : {false, true}) {
    const Report all = run(1e9, told);
    ASSERT_EQ(all.stop, Stop::finished) << all.reason;
    std::printf("leaky steps, %s: lags by %.2e, told %.2e\n", told ? "booked" : "not booked", lag, all.drift);
    EXPECT_GT(all.drift, 0.5 * lag);
    EXPECT_LT(all.drift, 2.0 * lag);
    const Report stopped = run(0.3 * lag / kTolerance, told);
    EXPECT_EQ(stopped.stop, told ? Stop::momentum_lost : Stop::energy_lost) << stopped.reason;
    EXPECT_LT(stopped.time, t);
    EXPECT_NE(stopped.reason.find("of a length"), std::string::npos) << stopped.reason;
  }
}

/// Whatever the motion is off by: so is the energy.
TEST(EnergyLimit, EndsARunThatLosesMore) {
  const Stiff stiff{.name = "spun", .young = 1e6, .duration = 3.0, .spin = 3.32, .gravity = 0.0};
  const System system = system_of(stiff);
  SimulationOptions options;
  options.own_stepper = [](const System& of) { return std::make_unique<Leaky>(of, false); };
  options.tolerance = kTolerance;
  options.drift_limit = 1e9;
  const double all = 1.0 - std::exp(-2.0 * Leaky::kRate * stiff.duration);
  for (const double share : {0.5, 1.5}) {
    options.energy_limit = share * all;
    const Report report = Simulation(system, start_of(stiff, system), options).run(stiff.duration);
    EXPECT_EQ(report.stop, share < 1.0 ? Stop::energy_lost : Stop::finished) << report.reason;
  }
}

/// Masses pushed at 40 Hz: every stage of a first step of a hundredth of the run would meet the push at 0.
TEST(FirstStep, KnowsThePeriodOfASignal) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(1, 1.0, 0.02));
  for (const std::size_t node : {0, 1})
    scene.forces.push_back(std::make_shared<PointLoad>(PointLoad::Kind::force, 0, node, Vec3(0, 0, 1),
                                                       Signal::sinusoid(50.0, 40.0)));
  const System system(scene);
  const double omega = 2 * std::numbers::pi * 40;
  const double speed = 50.0 / (scene.rods[0].mass[0] * omega);  // v = speed (1 - cos(omega t))
  for (const Method method : {Method::cash_karp, Method::automatic, Method::rodas}) {
    SimulationOptions options;
    options.method = method;
    options.tolerance = 1e-4;
    Simulation simulation(system, system.rest_state(), options);
    const Report report = simulation.run(10.0);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    const double error = std::abs(test::at(simulation.state().y, 1).z() - 10.0 * speed);
    std::printf("%s: pushed %.5f far, error %.1e, %ld steps, longest %.2g\n", to_string(method), 10.0 * speed,
                error, report.accepted, report.largest_step);
    EXPECT_LT(error, 10 * options.tolerance);
    EXPECT_LE(report.largest_step, 0.5 / 40.0 * (1 + 1e-9));
  }
}

/// The same of a clamp that is shaken, and of a push that comes as a short table.
TEST(FirstStep, KnowsThePeriodOfAnAnchorAndTheBreaksOfATable) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e3, 0.02));
  const Frame rest = node_frames(scene.rods[0].p, scene.rods[0].q).frame[0];
  const double omega = 2 * std::numbers::pi * 50;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.anchors[0].period = 0.02;
  scene.anchors[0].breaks = {0.515};
  scene.anchors[0].motion = [rest, omega](double t) {
    AnchorPose pose;
    pose.position = Vec3(0, 0, 1e-5 * std::sin(omega * t));
    pose.velocity = Vec3(0, 0, 1e-5 * omega * std::cos(omega * t));
    pose.frame = rest;
    return pose;
  };
  scene.forces.push_back(
      std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 4, Vec3(0, 0, 1),
                                  Signal::table({{0.25, 0.0}, {0.2505, 0.01}, {0.251, 0.0}})));
  const System system(scene);
  SimulationOptions options;
  options.method = Method::cash_karp;
  options.tolerance = 1e-2;
  Simulation simulation(system, system.rest_state(), options);
  std::vector<double> ends;
  simulation.on_progress([&](double time) {
    ends.push_back(time);
    return true;
  });
  const Report report = simulation.run(1.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_LE(ends.front(), 0.002 * (1 + 1e-9));
  EXPECT_LE(report.largest_step, 0.01 * (1 + 1e-9));
  for (const double at : {0.25, 0.2505, 0.251, 0.515})
    EXPECT_TRUE(std::find(ends.begin(), ends.end(), at) != ends.end()) << at;
}

}  // namespace
}  // namespace tendril
