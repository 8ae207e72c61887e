#include <tendril/dynamics/forces.h>

#include "support/equilibria.h"
#include "support/numbers.h"
#include "support/soundness.h"

// Extreme scenes that have a closed form, or whose refusal is known by name.
namespace tendril {
namespace {

using tendril::test::kPi;
using test::Trial;

TEST(Degenerate, RestShapesAreRefusedWithThePlace) {
  const auto place = [](const std::function<void(Rod&)>& spoil) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(4, 1e6, 5e-3));
    spoil(scene.rods[0]);
    return test::place_of_refusal(scene);
  };
  EXPECT_EQ(place([](Rod&) {}), "accepted");
  EXPECT_EQ(place([](Rod& rod) { rod.p[2] = rod.p[1]; }), "rods[0] node 1");  // an edge of length 0
  EXPECT_EQ(place([](Rod& rod) { rod.p[2] = rod.p[0]; }), "rods[0] node 1");  // t' = -t
  EXPECT_EQ(place([](Rod& rod) { rod.q[3] = rod.p[3] + Vec3(0.1, 0, 0); }),
            "rods[0] node 3");  // q on the tangent
  EXPECT_EQ(place([](Rod& rod) { rod.q[3] = rod.p[3]; }), "rods[0] node 3");
  EXPECT_EQ(place([](Rod& rod) { rod.mass[2] = 0.0; }), "rods[0].mass[2]");
  EXPECT_EQ(place([](Rod& rod) { rod.mass[2] = 1.0 / 0.0; }), "rods[0].mass[2]");
  EXPECT_EQ(place([](Rod& rod) { rod.p[2].x() = 0.0 / 0.0; }), "rods[0].p or q[2]");
  const std::vector<Vec3> p{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0)};
  EXPECT_THROW(make_rod(p, p, {1, 1, 1}, circular_section(1)), InvalidInput);
}

TEST(Degenerate, StartsAreRefusedWithThePlace) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e6, 5e-3));
  scene.rods.push_back(test::straight_rod(4, 1e6, 5e-3));
  const System system(scene);
  const auto place = [&](const std::function<void(State&)>& spoil) -> std::string {
    State start = system.rest_state();
    spoil(start);
    try {
      const Simulation simulation(system, start);
    } catch (const InvalidInput& error) {
      return error.place();
    }
    return "accepted";
  };
  EXPECT_EQ(place([](State&) {}), "accepted");
  EXPECT_EQ(place([](State& state) { state.y.segment<3>(21) = state.y.segment<3>(15); }),
            "start: rod 1 node 1");
  EXPECT_EQ(place([](State& state) { state.y.segment<3>(21) = state.y.segment<3>(18); }),
            "start: rod 1 node 1");
  EXPECT_EQ(place([](State& state) { state.y[7] = 0.0 / 0.0; }).substr(0, 5), "start");
  EXPECT_EQ(place([](State& state) { state.y[37] = 1.0 / 0.0; }).substr(0, 5), "start");
  EXPECT_EQ(place([](State& state) { state.y.conservativeResize(5); }), "start");
  EXPECT_EQ(place([](State& state) { state.twist.clear(); }), "start");
}

/// Three masses without bending stiffness, the middle one held, the outer two thrown at each other over the
/// fold.
TEST(FoldBack, InMotionEndsInPlaceOfANumberThatIsNot) {
  for (const double off : {0.0, 1e-3}) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(2, 1e6, 5e-3));
    for (std::size_t i = 0; i < 3; ++i) scene.rods[0].bend_l[i] = scene.rods[0].bend_m[i] = 0.0;
    scene.anchors.push_back({0, 1, true, false, {}});
    const System system(scene);
    Trial trial{"fold", {}, 2.0};
    trial.start = [off](State& state) {
      state.y[9 + 2] = state.y[9 + 8] = 1.0;  // both ends up, the middle stays
      state.y[9 + 1] = off;
    };
    for (const Method method : {Method::automatic, Method::cash_karp, Method::rodas}) {
      const test::Outcome out = test::run(system, trial, method, 1e-3, 100'000);
      test::expect_sound(out, 100'000);
      std::printf("fold back, off by %g, %s: %s at %.3f, energy %.1e %s\n", off, to_string(method),
                  to_string(out.report.stop), out.report.time, out.report.imbalance,
                  out.report.reason.c_str());
      if (out.report.stop == Stop::finished) EXPECT_LT(out.report.imbalance, 1e-2);
    }
  }
}

/// At the end the masses are 10^6 edges away, where the rounding of positions strains an edge by 1e-8; and
/// the steps are so long that the equations' rounding would turn and drag the rod.
TEST(FreeFlight, OfAMillionSecondsIsRight) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(15, 1e6, 5e-3));
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -1e-7)));
  const System system(scene);
  const Vec3 velocity(0.03, -0.02, 0.05);
  const Vec3 way = 1e6 * velocity + Vec3(0, 0, -0.5 * 1e-7 * 1e12);
  Trial trial{"a million seconds", {}, 1e6};
  trial.start = [&](State& state) {
    for (Eigen::Index i = 0; i < 16; ++i) state.y.segment<3>(48 + 3 * i) = velocity;
  };
  Eigen::VectorXd exact = system.rest_state().y.head(48);
  for (Eigen::Index i = 0; i < 16; ++i) exact.segment<3>(3 * i) += way;
  for (const double tolerance : {1e-3, 1e-6}) {
    const test::Outcome out = test::run(system, trial, Method::automatic, tolerance, 300'000);
    test::expect_sound(out, 300'000);
    const double error = test::largest_gap(out.p(system), exact);
    std::printf("a million seconds at %.0e: %s, %ld steps, off by %.1e of %.1e %s\n", tolerance,
                to_string(out.report.stop), out.report.accepted, error, way.norm(),
                out.report.reason.c_str());
    EXPECT_EQ(out.report.stop, Stop::finished) << out.report.reason;
    EXPECT_LT(error, 1e-4);  // of a rod of length 1
  }
  const test::Outcome refused = test::run(system, trial, Method::cash_karp, 1e-3, 100'000);
  test::expect_sound(refused, 100'000);
  EXPECT_EQ(refused.report.stop, Stop::too_stiff);
}

TEST(FreeFlight, OfAMillionTurnsIsRightOrRefused) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(15, 1e6, 5e-3));
  const System system(scene);
  Trial trial{"a million turns", {}, 1e6};
  trial.start = [](State& state) {
    for (Eigen::Index i = 0; i < 16; ++i) state.y[48 + 3 * i + 1] = 2 * kPi * (state.y[3 * i] - 0.5);
  };
  for (const Method method : {Method::automatic, Method::cash_karp, Method::rodas}) {
    const test::Outcome out = test::run(system, trial, method, 1e-3, 100'000);
    test::expect_sound(out, 100'000);
    EXPECT_NE(out.report.stop, Stop::finished) << "a turn takes some steps, and there are a million of them";
    std::printf("a million turns, %s: %s\n", to_string(method), out.report.reason.c_str());
  }
}

/// Held straight and pulled, one end turned 100 times.
TEST(HundredTurns, AreCountedInMotionAndAtRest) {
  const double turn = 200 * kPi, torsion = 0.7, tension = 3e5;
  Scene scene;
  scene.rods.push_back(test::round_rod(16, 1.0, 1.0, torsion, tension));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.anchors.push_back(test::mover(16, Vec3::UnitX(), Vec3(0.2, 0, 0), turn));
  const System system(scene);
  StaticsOptions statics;
  statics.until = 1.0;
  const Equilibrium found = test::balanced(system, statics);
  EXPECT_NEAR(std::accumulate(found.state.twist.begin(), found.state.twist.end(), 0.0), turn, 1e-9 * turn);
  const double energy = 0.5 * torsion * turn * turn + 0.5 * tension * 0.2 * 0.2;
  EXPECT_NEAR(found.elastic, energy, 1e-9 * energy);
  for (const Method method : {Method::automatic, Method::cash_karp}) {
    const test::Outcome out = test::run(system, {"hundred turns", {}, 1.0}, method, 1e-3, 3'000'000);
    test::expect_sound(out, 3'000'000);
    std::printf("a hundred turns, %s: %s, %ld steps, energy %.1e %s\n", to_string(method),
                to_string(out.report.stop), out.report.accepted, out.report.imbalance,
                out.report.reason.c_str());
    ASSERT_EQ(out.report.stop, Stop::finished) << out.report.reason;
    EXPECT_NEAR(std::accumulate(out.state.twist.begin(), out.state.twist.end(), 0.0), turn, 1e-6 * turn);
  }
}

/// Two clamped nodes in the middle part a rod into two that do not know of each other.
TEST(StaticNodesInTheMiddle, PartTheRod) {
  const auto let_go = [](Scene scene, Method method, double tolerance) {
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
    const System system(scene);
    const test::Outcome out = test::run(system, {"parted", {}}, method, tolerance, 1'000'000);
    test::expect_sound(out, 1'000'000);
    EXPECT_EQ(out.report.stop, Stop::finished) << out.report.reason;
    return out.p(system);
  };
  Scene whole, half;
  whole.rods.push_back(test::straight_rod(21, 1e7, 5e-3));
  whole.anchors.push_back({.rod = 0, .node = 10});
  whole.anchors.push_back({.rod = 0, .node = 11});
  const std::vector<Vec3> p(whole.rods[0].p.begin() + 11, whole.rods[0].p.end());
  half.rods.push_back(
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e7, 1e7 / 3, 1000}, circular_section(5e-3)));
  half.anchors.push_back({.rod = 0, .node = 0});
  for (const Method method : {Method::automatic, Method::cash_karp}) {
    const Eigen::VectorXd a = let_go(whole, method, 1e-6), b = let_go(half, method, 1e-6);
    EXPECT_LT(test::largest_gap(a.tail(33), b), 1e-6) << to_string(method);
    EXPECT_LT(
        test::largest_gap(a.segment(30, 6), test::straight_rod(21, 1, 1).p[10].replicate(2, 1) +
                                                (Eigen::VectorXd(6) << 0, 0, 0, 1.0 / 21, 0, 0).finished()),
        1e-12);
    // And the left half hangs as the right one does, seen in a mirror.
    for (Eigen::Index i = 0; i <= 10; ++i)
      EXPECT_NEAR(a[3 * i + 2], a[3 * (21 - i) + 2], 1e-6) << to_string(method) << ' ' << i;
  }
}

/// The limit E A -> infinity exists, and is reached.
TEST(Inextensible, MotionConvergesAsTheStretchStiffnessGrows) {
  const auto end = [](double factor) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(12, 1e6, 5e-3));
    for (double& k : scene.rods[0].stretch) k *= factor;
    scene.anchors.push_back({.rod = 0, .node = 0});
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
    const System system(scene);
    const test::Outcome out = test::run(system, {"inextensible", {}}, Method::automatic, 1e-5, 3'000'000);
    EXPECT_EQ(out.report.stop, Stop::finished) << out.report.reason;
    double length = 0.0;
    for (std::size_t i = 0; i < 12; ++i)
      length += (test::at(out.state.y, i + 1) - test::at(out.state.y, i)).norm();
    std::printf("E A times %.0e: %ld steps, length off by %.1e\n", factor, out.report.accepted, length - 1);
    EXPECT_LT(std::abs(length - 1), 0.02 / factor + 1e-9);
    return out.p(system);
  };
  const Eigen::VectorXd limit = end(1e6);
  const double coarse = test::largest_gap(end(1), limit), fine = test::largest_gap(end(1e3), limit);
  std::printf("from the limit: %.1e and %.1e\n", coarse, fine);
  EXPECT_LT(fine, 0.05 * coarse);
}

/// Spacings 1 to 1000 do not spoil an equilibrium: small deflection under an end load.
TEST(UnevenSpacing, BendsAsTheBeamDoes) {
  for (const bool in_turn : {false, true}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const int edges = 24 << k;
      std::vector<Vec3> p{Vec3::Zero()};
      for (int i = 0; i < edges; ++i)
        p.push_back(p.back() +
                    std::pow(1000.0, in_turn ? i % 2 : static_cast<double>(i) / (edges - 1)) * Vec3::UnitX());
      const double length = p.back().x();
      for (Vec3& at : p) at /= length;
      const double r = 1e-3, young = 4 / (kPi * std::pow(r, 4)), load = 1e-3;
      const Rod rod = make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {young, young / 3, 1000},
                               circular_section(r));
      const Equilibrium found =
          test::clamped(rod, {test::point_load(PointLoad::Kind::force, edges, Vec3(0, 0, -load))});
      error[k] = -test::tip(found).z() / (load / 3) - 1;
    }
    std::printf("spacing 1 to 1000 %s: deflection off by %.1e at 24 edges, %.1e at 48, order %.2f\n",
                in_turn ? "in turn" : "growing", error[0], error[1], test::order(error[0], error[1]));
    EXPECT_LT(std::abs(error[1]), 2e-2);
    EXPECT_GT(test::order(error[0], error[1]), 1.8);
  }
}

TEST(Denormals, AreNothing) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(15, 1e6, 5e-3));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 4e-320, -1e-310)));
  const System system(scene);
  Trial trial{"denormals", {}};
  trial.start = [](State& state) { state.y[48 + 3 * 15 + 2] = 5e-324; };
  test::expect_right_or_refused(system, trial,
                                [&] { return Eigen::VectorXd(system.rest_state().y.head(48)); });
  for (const double small : {1e-150, 1e-200}) {
    // Lengths whose squares vanish: refused, not divided by.
    Scene tiny;
    tiny.rods.push_back(test::straight_rod(3, 1e6, 5e-3));
    for (std::size_t i = 0; i < 4; ++i) {
      tiny.rods[0].p[i] *= small;
      tiny.rods[0].q[i] *= small;
    }
    try {
      const System shrunk(tiny);
      for (const Method method : {Method::automatic, Method::cash_karp})
        test::expect_sound(test::run(shrunk, {"tiny", {}}, method, 1e-3, 10'000), 10'000);
    } catch (const InvalidInput& error) {
      std::printf("lengths of %g: %s\n", small, error.what());
    }
  }
}

/// A jump that is announced costs no more than two runs that meet there.
TEST(AnnouncedJump, IsAsGoodAsTwoRuns) {
  const auto scene = [](std::vector<std::pair<double, double>> table) {
    Scene out;
    out.rods.push_back(test::straight_rod(15, 1e6, 5e-3));
    out.anchors.push_back({.rod = 0, .node = 0});
    WindOptions wind;
    wind.mean = Vec3(0, 30, 5);
    wind.switched = Signal::table(std::move(table));
    out.forces.push_back(std::make_shared<Wind>(wind));
    return out;
  };
  const System both(scene({{0.1, 1.0}, {0.1, 0.0}})), on(scene({{0.0, 1.0}})), off(scene({{0.0, 0.0}}));
  for (const Method method : {Method::automatic, Method::cash_karp, Method::rodas}) {
    const test::Outcome whole = test::run(both, {"wind", {}, 0.25}, method, 1e-8, 10'000'000);
    const test::Outcome first = test::run(on, {"on", {}, 0.1}, method, 1e-8, 10'000'000);
    Trial second{"off", {}, 0.25};
    second.start = [&](State& state) { state = first.state; };
    const test::Outcome last = test::run(off, second, method, 1e-8, 10'000'000);
    ASSERT_EQ(whole.report.stop, Stop::finished) << whole.report.reason;
    ASSERT_EQ(last.report.stop, Stop::finished) << last.report.reason;
    EXPECT_LT(test::largest_gap(whole.p(both), last.p(off)), 1e-6) << to_string(method);
  }
}

}  // namespace
}  // namespace tendril
