#include <gtest/gtest.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/stiffness.h>
#include <tendril/dynamics/supports.h>

#include "support/equilibria.h"
#include "support/numbers.h"
#include "support/order.h"

namespace tendril {
namespace {

using test::balanced;
using test::kGravity;
using test::Random;
using Kind = PointLoad::Kind;

Anchor swivelling(std::size_t node, const Vec3& axis) {
  return {.rod = 0, .node = node, .swivels = true, .swivel_axis = axis};
}

/// An uneven rod with a viscous branch at a node that swivels about an oblique axis, and another that does so
/// in the branch; with `moving` they are carried and turned.
Scene shaken_swivel(bool moving) {
  Random random(31);
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 6));
  scene.rods.push_back(test::uneven_rod(random, 4));
  for (std::vector<Vec3>* points : {&scene.rods[1].p, &scene.rods[1].q})
    for (Vec3& p : *points) p = rotate_about(Vec3::UnitZ(), 1.0, p) + scene.rods[0].p[2];
  scene.rods[1].q[0] = scene.rods[1].p[0] + Vec3(0.1, 0.2, 1);
  for (Rod& rod : scene.rods) rod.viscosity = 0.03, rod.mass_damping = 0.1;
  scene.joints.push_back({.parent = 0, .node = 2, .child = 1});
  scene.anchors = {swivelling(2, Vec3(1, -2, 0.5)), swivelling(5, Vec3(0.2, 0.4, 1)),
                   swivelling(1, Vec3(3, 1, 1))};
  scene.anchors[1].holds_position = false;
  scene.anchors[2].rod = 1;
  scene.anchors[2].holds_position = false;
  for (Anchor& anchor : scene.anchors) {
    if (!moving) break;
    const Rod& rod = scene.rods[anchor.rod];
    const Frame frame = node_frames(rod.p, rod.q).frame[anchor.node];
    anchor.period = 2.0;
    anchor.motion = [frame, p = rod.p[anchor.node]](double t) {
      const Vec3 axis = Vec3(1, 2, -0.5).normalized(), way(0.1, -0.2, 0.15);
      const double phase = std::numbers::pi * t, angle = 0.3 * std::sin(phase),
                   rate = 0.3 * std::numbers::pi * std::cos(phase);
      const auto turned = [&](const Vec3& v) { return rotate_about(axis, angle, v); };
      return AnchorPose{p + std::sin(phase) * way,
                        {turned(frame.x), turned(frame.y), turned(frame.z)},
                        std::numbers::pi * std::cos(phase) * way,
                        rate * axis};
    };
  }
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0.3, -0.2, -1)));
  scene.forces.push_back(test::point_load(Kind::torque, 2, Vec3(0.2, 0.5, -0.3)));
  return scene;
}

TEST(Swivel, GradientAndHessianMatchDifferences) {
  const System system(shaken_swivel(false));
  Random random(7);
  const State state = test::stirred(system, random, 0.1);
  const auto work = system.make_workspace();
  const auto n = static_cast<Eigen::Index>(system.node_count());
  double energy = 0.0;
  Eigen::VectorXd g, side[2];
  ASSERT_TRUE(system.elastic_gradient(state, 0.0, state.y, energy, g, *work).ok());
  Eigen::SparseMatrix<double> hessian;
  ASSERT_TRUE(elastic_stiffness(system, state, hessian, *work).ok());
  const double h = 1e-5;
  for (const Eigen::Index node : {2, 5, 7}) {
    double energies[2];
    for (const int s : {0, 1}) {
      Eigen::VectorXd y = state.y;
      y[6 * n + node] += s == 0 ? h : -h;
      ASSERT_TRUE(system.elastic_gradient(state, 0.0, y, energies[s], side[s], *work).ok());
    }
    EXPECT_NEAR((energies[0] - energies[1]) / (2 * h), g[3 * n + node], 1e-8 * g.cwiseAbs().maxCoeff())
        << node;
    // Rows of held places and frames mean nothing.
    const Eigen::VectorXd column = (side[0] - side[1]) / (2 * h), exact = hessian.col(3 * n + node);
    EXPECT_LT((column - exact).cwiseAbs().maxCoeff(), 1e-7 * exact.cwiseAbs().maxCoeff()) << node;
    for (Eigen::Index k = 0; k < 3 * n; ++k)
      EXPECT_NEAR(hessian.coeff(3 * n + node, k), hessian.coeff(k, 3 * n + node), 1e-9) << node;
  }
}

TEST(Swivel, KeepsRodasAtOrderFour) {
  for (const bool moving : {false, true})
    for (const auto slide : {Anchor::Slide::none, Anchor::Slide::line}) {
      Scene scene = shaken_swivel(moving);
      scene.anchors[0].slide = slide;
      scene.anchors[0].slide_axis = Vec3(1, 1, 2);
      const System system(scene);
      EXPECT_NEAR(test::order_of(system, system.rest_state(), 0.4, 50), 4.0, 0.35) << moving;
    }
}

TEST(Swivel, IsTheSameMotionByAllMethodsAndBalancesItsEnergy) {
  for (const bool moving : {false, true}) {
    const System system(shaken_swivel(moving));
    std::vector<Vec3> ends;
    for (const Method method : {Method::cash_karp, Method::rodas, Method::runge_kutta4, Method::verlet}) {
      SimulationOptions options;
      options.method = method;
      options.tolerance = 1e-9;
      if (!chooses_steps(method)) options.fixed_step = 5e-4;
      Simulation simulation(system, system.rest_state(), options);
      const Report report = simulation.run(1.0);
      ASSERT_EQ(report.stop, Stop::finished) << report.reason;
      EXPECT_LT(std::abs(report.imbalance), method == Method::verlet ? 1e-3 : 1e-6) << to_string(method);
      ends.push_back(test::at(simulation.state().y, 5));
    }
    EXPECT_LT((ends[0] - ends[1]).norm(), 1e-6);
    EXPECT_LT((ends[0] - ends[2]).norm(), 1e-6);
    EXPECT_LT((ends[0] - ends[3]).norm(), 1e-4);
  }
}

/// Statics finds where the motion's equations rest, and both say the same of supports.
TEST(Swivel, AtRestHasTheSupportsOfStatics) {
  const System system(shaken_swivel(false));
  const Equilibrium found = balanced(system);
  EXPECT_GT((test::at(found.state.y, 5) - system.scene().rods[0].p[5]).norm(), 0.1);
  Eigen::VectorXd rate;
  ASSERT_TRUE(system.derivative(found.state, 0, found.state.y, rate, *system.make_workspace()).ok());
  EXPECT_LT(rate.cwiseAbs().maxCoeff(), 1e-6);
  const std::vector<Support> supports = supports_of(system, found.state);
  ASSERT_EQ(supports.size(), 3u);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_LT((supports[a].force - found.support[a]).norm(), 1e-7) << a;
    EXPECT_LT((supports[a].torque - found.torque[a]).norm(), 1e-7) << a;
    EXPECT_GT(found.torque[a].norm(), 0.01) << a;
  }
}

/// The momenta of a whole scene change by what supports and loads do.
TEST(Swivel, BalancesBothMomenta) {
  const Scene scene = shaken_swivel(true);
  const System system(scene);
  Random random(3);
  State state = test::stirred(system, random, 0.05);
  state.time = 0.3;
  const auto work = system.make_workspace();
  ASSERT_TRUE(system.rebase(state, *work).ok());
  Eigen::VectorXd rate;
  ASSERT_TRUE(system.derivative(state, state.time, state.y, rate, *work).ok());
  const auto n = static_cast<Eigen::Index>(system.node_count());
  const std::size_t flat[] = {2, 5, 7};
  // A swivel's momentum is about its axis.
  const auto momentum = [&](const State& at) {
    test::Momentum sum = test::momentum(system, at);
    const std::vector<Frame> frames = system.frames(at, *work);
    for (std::size_t a = 0; a < 3; ++a) {
      const Rod& rod = scene.rods[scene.anchors[a].rod];
      const Frame rest = node_frames(rod.p, rod.q).frame[scene.anchors[a].node], now = frames[flat[a]];
      const Vec3 axis = scene.anchors[a].swivel_axis.normalized();
      const Vec3 turned = axis.dot(rest.x) * now.x + axis.dot(rest.y) * now.y + axis.dot(rest.z) * now.z;
      sum.angular += test::spin_inertias(system)[flat[a]] * at.y[7 * n + static_cast<Eigen::Index>(flat[a])] *
                     (turned - now.z);
    }
    return sum;
  };
  test::Momentum side[2];
  const double h = 1e-5;
  for (const int s : {0, 1}) {
    State there = state;
    there.y += (s == 0 ? -h : h) * rate;
    there.time += s == 0 ? -h : h;
    ASSERT_TRUE(system.rebase(there, *work).ok());
    side[s] = momentum(there);
  }
  test::Momentum done{Vec3::Zero(), Vec3(0.2, 0.5, -0.3)};
  const auto push = [&](std::size_t node, const Vec3& f) {
    done.linear += f;
    done.angular += test::at(state.y, node).cross(f);
  };
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t i = 0; i < scene.rods[r].p.size(); ++i) {
      const std::size_t node = system.rods()[r].first + i;
      const auto k = 3 * static_cast<Eigen::Index>(node);
      push(node, scene.rods[r].mass[i] * Vec3(0.3, -0.2, -1));
      // Damping acts on what is free: all masses but that of node 2, with the branch's root there.
      if (node != 2 && node != 6) push(node, -0.1 * scene.rods[r].mass[i] * state.y.segment<3>(3 * n + k));
    }
  const std::vector<Support> supports = supports_of(system, state);
  ASSERT_EQ(supports.size(), 3u);
  const std::vector<Frame> frames = system.frames(state, *work);
  const std::vector<double> inertia = test::spin_inertias(system);
  for (std::size_t i = 0; i < system.node_count(); ++i) {
    const double momentum_lost = 0.1 * inertia[i] * state.y[7 * n + static_cast<Eigen::Index>(i)];
    if (std::find(std::begin(flat), std::end(flat), i) == std::end(flat) && i != 6)
      done.angular -= momentum_lost * frames[i].z;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    push(flat[a], supports[a].force);
    done.angular += supports[a].torque;
    const Rod& rod = scene.rods[scene.anchors[a].rod];
    const Frame rest = node_frames(rod.p, rod.q).frame[scene.anchors[a].node], now = frames[flat[a]];
    const Vec3 axis = scene.anchors[a].swivel_axis.normalized();
    const Vec3 turned = axis.dot(rest.x) * now.x + axis.dot(rest.y) * now.y + axis.dot(rest.z) * now.z;
    done.angular -= 0.1 * inertia[flat[a]] * state.y[7 * n + static_cast<Eigen::Index>(flat[a])] * turned;
    EXPECT_LT(std::abs((supports[a].torque).dot(turned)), 1e-3) << a;  // none but what turns a moving spin
  }
  const double scale = supports[0].force.norm() + supports[0].torque.norm();
  EXPECT_LT(((side[1].linear - side[0].linear) / (2 * h) - done.linear).norm(), 1e-7 * scale);
  EXPECT_LT(((side[1].angular - side[0].angular) / (2 * h) - done.angular).norm(), 1e-7 * scale);
}

Scene bar(double young, const Vec3& axis, double radius = 0.02) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(8, young, radius));
  scene.anchors.push_back(swivelling(0, axis));
  return scene;
}

/// In its plane a stiff bar on a revolute is a pendulum, with the node's own inertia: as on a hinge.
TEST(Swivel, SwingsABarAsAHingeDoes) {
  for (const Method method : {Method::automatic, Method::rodas, Method::cash_karp}) {
    Scene scene = bar(1e8, Vec3::UnitY(), 0.1);
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kGravity)));
    double first = 0.0, second = scene.rods[0].inertia[0];
    for (std::size_t i = 0; i < 9; ++i) {
      first += scene.rods[0].mass[i] * scene.rods[0].p[i].x();
      second += scene.rods[0].mass[i] * scene.rods[0].p[i].x() * scene.rods[0].p[i].x();
    }
    double angle = 0.0, rate = 0.0;  // below the horizon
    const double end = 1.3, h = end / 20000;
    for (int i = 0; i < 20000; ++i) {
      rate += 0.5 * h * kGravity * first / second * std::cos(angle);
      angle += h * rate;
      rate += 0.5 * h * kGravity * first / second * std::cos(angle);
    }
    SimulationOptions options;
    options.method = method;
    const auto tip_at_end = [&] {
      const System system(scene);
      Simulation simulation(system, system.rest_state(), options);
      const Report report = simulation.run(end);
      if (report.stop != Stop::finished) throw std::runtime_error(report.reason);
      return test::at(simulation.state().y, 8);
    };
    const Vec3 swung = tip_at_end();
    EXPECT_LT((swung - Vec3(std::cos(angle), 0, -std::sin(angle))).norm(), 2e-3);
    scene.anchors[0].swivels = scene.anchors[0].holds_frame = false;
    EXPECT_LT((swung - tip_at_end()).norm(), 4e-3);  // the hinged node has no inertia of its own
  }
}

/// Across its plane it is a clamp, P L^3 / 3 E I; along it, it hangs.
TEST(Swivel, HoldsABarAcrossItsPlane) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(40, 1e10, 0.01));
  scene.anchors.push_back(swivelling(0, Vec3::UnitY()));
  const double bending = 1e10 * std::numbers::pi / 4 * 1e-8, side = 0.05, down = 5.0;
  scene.forces.push_back(test::point_load(Kind::force, 40, Vec3(0, side, 0)));
  scene.forces.push_back(test::point_load(Kind::force, 40, Vec3(0, 0, -down)));
  const Equilibrium found = balanced(System(scene));
  const Vec3 tip = test::tip(found);
  EXPECT_NEAR(tip.x(), 0.0, 1e-6);
  // Pulled by T it bends less: P / T (L - tanh(k L) / k), k^2 = T / E I.
  const double k = std::sqrt(down / bending);
  EXPECT_NEAR(tip.y() / (side / down * (1.0 - std::tanh(k) / k)), 1.0, 3e-3);
  EXPECT_LT(std::abs(found.torque[0].y()), 1e-12);
  EXPECT_LT((found.torque[0] + tip.cross(Vec3(0, side, -down))).norm(), 1e-7);
  EXPECT_EQ(found.stability.kind, Stability::Kind::stable);

  scene.forces.pop_back();
  const Equilibrium free = balanced(System(scene));
  EXPECT_NEAR(test::tip(free).y() / (side / (3 * bending)), 1.0, 2e-3);
  EXPECT_EQ(free.stability.neutral, 1);
  scene.anchors[0].swivels = false;
  EXPECT_NEAR(test::tip(free).y() / test::tip(balanced(System(scene))).y(), 1.0, 1e-6);
}

/// A shaft in a bearing at one end: it bends as from a clamp, and no twist comes back from there.
TEST(Swivel, AboutTheTangentHoldsABeamAndNoTwist) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(20, 1e10, 0.01));
  scene.anchors.push_back(swivelling(0, Vec3::UnitX()));
  scene.anchors.push_back(test::mover(20, Vec3::UnitX(), Vec3::Zero(), 1.0));
  StaticsOptions options;
  options.until = 2.0;
  const Equilibrium turned = balanced(System(scene), options);
  for (const std::size_t a : {0, 1}) EXPECT_LT(turned.torque[a].norm(), 1e-6);
  EXPECT_LT(turned.elastic, 1e-9);
  // The whole shaft has turned with its other end.
  EXPECT_NEAR(turned.state.director[0].dot(Vec3::UnitZ()), std::cos(2.0), 1e-6);

  scene.anchors.pop_back();
  const double load = 0.1, bending = 1e10 * std::numbers::pi / 4 * 1e-8;
  scene.forces.push_back(test::point_load(Kind::force, 20, Vec3(0, 0, -load)));
  const Equilibrium bent = balanced(System(scene));
  EXPECT_NEAR(-test::tip(bent).z() / (load / (3 * bending)), 1.0, 3e-3);
  EXPECT_NEAR(bent.torque[0].y(), -load, 1e-4 * load);
  scene.forces = {test::point_load(Kind::torque, 20, Vec3(0.1, 0, 0))};
  const Equilibrium none = find_equilibrium(System(scene), System(scene).rest_state());
  EXPECT_EQ(none.balance, Balance::unheld) << none.reason;
  EXPECT_NE(none.reason.find("nothing holds rod 0"), std::string::npos) << none.reason;
}

/// A shaft spun about its tangent in the bearing goes on doing so.
TEST(Swivel, AboutTheTangentLetsAShaftSpin) {
  const System system(bar(1e8, Vec3::UnitX()));
  State state = system.rest_state();
  state.y.segment(7 * 9, 9).setConstant(4.0);
  Simulation simulation(system, state, {.tolerance = 1e-8});
  ASSERT_EQ(simulation.run(2.0).stop, Stop::finished);
  for (Eigen::Index i = 0; i < 9; ++i) EXPECT_NEAR(simulation.state().y[63 + i], 4.0, 1e-6);
  EXPECT_NEAR(simulation.state().director[0].dot(Vec3::UnitZ()), std::cos(8.0), 1e-6);
}

TEST(Swivel, LetsGoOfWhatItHeldAcrossItsAxis) {
  Scene scene = bar(1e6, Vec3(1, 1, 0));
  scene.anchors[0].until = 0.1;
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kGravity)));
  const System system(scene);
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-8});
  ASSERT_EQ(simulation.run(0.1).stop, Stop::finished);
  const test::Momentum before = test::momentum(system, simulation.state());
  // Of its spin about the axis it keeps what is about the tangent.
  scene.anchors[0].until = 1.0;
  const System still(scene);
  Simulation held(still, still.rest_state(), {.tolerance = 1e-8});
  ASSERT_EQ(held.run(0.1).stop, Stop::finished);
  EXPECT_GT(std::abs(held.state().y[63]), 0.1);
  EXPECT_NEAR(simulation.state().y[63], std::sqrt(0.5) * held.state().y[63], 1e-9);
  const Report report = simulation.run(0.3);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const Vec3 fall(0, 0, -0.2 * kGravity * test::total_mass(scene.rods[0]));
  EXPECT_LT((test::momentum(system, simulation.state()).linear - before.linear - fall).norm(), 1e-9);
}

TEST(Swivel, IsRefusedWithoutAFrameToHoldOrADirection) {
  Scene scene = bar(1e6, Vec3(1, 1, 0));
  EXPECT_EQ(test::place_of_refusal(scene), "accepted");
  scene.anchors[0].holds_frame = false;
  EXPECT_EQ(test::place_of_refusal(scene), "anchors[0].swivels");
  scene.anchors[0].holds_frame = true;
  for (const Vec3& axis : {Vec3(0, 0, 0), Vec3(1, std::nan(""), 0), Vec3(HUGE_VAL, 0, 0)}) {
    scene.anchors[0].swivel_axis = axis;
    EXPECT_EQ(test::place_of_refusal(scene), "anchors[0].swivels");
  }
}

}  // namespace
}  // namespace tendril
