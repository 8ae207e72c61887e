#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/method.h>

#include <cmath>
#include <set>
#include <string>

namespace tendril {
namespace {

/// Two masses of 2 without springs of their own, each pulled back to its place with w = 1 and damped at the
/// rate alpha.
struct Motion {
  Motion(double pull, double alpha) : system(scene(pull, alpha)), state(system.rest_state()) {}

  static Scene scene(double pull, double alpha) {
    Scene result;
    const std::vector<Vec3> p{Vec3::Zero(), Vec3::UnitX()};
    result.rods.push_back(
        make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), SpringConstants{0, 0, 0, 0, 0, 2.0, 1.0}));
    result.rods[0].mass_damping = alpha;
    for (std::size_t i = 0; i < 2; ++i)
      result.forces.push_back(std::make_shared<PullTowards>(0, i, p[i], pull));
    return result;
  }

  /// Steps of a size; false when one fails.
  bool advance(Stepper& stepper, double h, int steps) {
    for (int i = 0; i < steps; ++i)
      if (!stepper.advance(state, h).ok()) return false;
    return true;
  }

  double& place() { return state.y[2]; }
  double& speed() { return state.y[6 + 2]; }

  System system;
  State state;
};

constexpr double kStart = 0.01;

/// How many times larger an oscillation of w = 1 is after steps of a size.
double oscillation_grows(const MethodInfo& row, double h, int steps) {
  Motion motion(2.0, 0.0);
  motion.place() = kStart;
  EXPECT_TRUE(motion.advance(*row.make(motion.system), h, steps)) << row.name << ' ' << h;
  return std::hypot(motion.place(), motion.speed()) / kStart;
}

/// The same of a speed that decays at the rate 1.
double decay_grows(const MethodInfo& row, double h, int steps) {
  Motion motion(0.0, 1.0);
  motion.speed() = kStart;
  EXPECT_TRUE(motion.advance(*row.make(motion.system), h, steps)) << row.name << ' ' << h;
  return std::abs(motion.speed()) / kStart;
}

class EveryMethod : public testing::TestWithParam<MethodInfo> {};

TEST_P(EveryMethod, HasItsOrderOnAnOscillation) {
  const MethodInfo row = GetParam();
  const auto error = [&](int steps) {
    Motion motion(2.0, 0.0);
    motion.place() = kStart;
    EXPECT_TRUE(motion.advance(*row.make(motion.system), 2.0 / steps, steps));
    return std::hypot(motion.place() - kStart * std::cos(2.0), motion.speed() + kStart * std::sin(2.0));
  };
  const int steps = row.order == 1 ? 400 : 40;
  EXPECT_NEAR(std::log2(error(steps) / error(2 * steps)), row.order, 0.1) << row.name;
}

TEST_P(EveryMethod, EvaluatesAsOftenAsItHasStages) {
  const MethodInfo row = GetParam();
  Motion motion(2.0, 0.0);
  motion.place() = kStart;
  const auto stepper = row.make(motion.system);
  ASSERT_TRUE(motion.advance(*stepper, 0.1, 1));
  const long first = stepper->evaluations();
  ASSERT_TRUE(motion.advance(*stepper, 0.1, 10));
  const long each = (stepper->evaluations() - first) / 10;
  // What an implicit step spends on its equations comes on top.
  if (row.stiff)
    EXPECT_GE(each, row.stages) << row.name;
  else
    EXPECT_EQ(each, row.stages) << row.name;
}

TEST_P(EveryMethod, AmplifiesAnOscillationBeyondItsLimitAndNotBelow) {
  const MethodInfo row = GetParam();
  const double limit = row.stability.oscillation;
  if (limit == 0.0) {
    // Every step amplifies, Cash-Karp's solution by (h w)^6 / 7200.
    EXPECT_GT(oscillation_grows(row, 0.3, 3000), 1.0 + 2e-4) << row.name;
  } else if (std::isinf(limit)) {
    for (const double h : {0.3, 3.0, 30.0}) EXPECT_LT(oscillation_grows(row, h, 30), 1.0) << row.name;
  } else {
    // Verlet keeps an energy that is not quite the motion's: the factor is bounded by that.
    EXPECT_LT(oscillation_grows(row, 0.99 * limit, 1000), 10.0) << row.name;
    EXPECT_GT(oscillation_grows(row, 1.01 * limit, 1000), 1e3) << row.name;
  }
}

TEST_P(EveryMethod, AmplifiesADecayBeyondItsLimitAndNotBelow) {
  const MethodInfo row = GetParam();
  const double limit = row.stability.decay;
  if (std::isinf(limit)) {
    for (const double h : {0.3, 3.0, 30.0}) EXPECT_LT(decay_grows(row, h, 30), 1.0) << row.name;
    return;
  }
  // What the first step does, which knows no step before it, is left out.
  const auto growth = [&](double h) { return decay_grows(row, h, 400) / decay_grows(row, h, 100); };
  EXPECT_LT(growth(0.99 * limit), 0.1) << row.name;
  EXPECT_GT(growth(1.01 * limit), 10.0) << row.name;
}

TEST_P(EveryMethod, SaysWhatItChoosesAndWhetherItIsStiff) {
  const MethodInfo row = GetParam();
  const Motion motion(2.0, 0.0);
  const auto stepper = row.make(motion.system);
  const auto* embedded = dynamic_cast<const EmbeddedStepper*>(stepper.get());
  EXPECT_EQ(embedded != nullptr, row.chooses != Chooses::nothing);
  EXPECT_EQ(chooses_steps(row.method), row.chooses != Chooses::nothing);
  if (embedded == nullptr) return;
  EXPECT_EQ(embedded->stiff(), row.stiff);
  EXPECT_EQ(embedded->error_order(), row.method == Method::nystrom ? 3 : row.order - 1);
  if (!row.stiff) EXPECT_EQ(embedded->stages(), row.stages);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::ValuesIn(methods().begin(), methods().end()),
                         [](const auto& row) { return std::string(row.param.name); });

// What the guard of a run goes by.
TEST(Growth, IsWhatStepsOfAMethodMultiplyAMotionBy) {
  for (const Method method : {Method::cash_karp, Method::nystrom})
    for (const double alpha : {0.0, 0.1, 1.0})
      for (const double h : {0.8, 1.6, 2.5, 3.2}) {
        // The guard of Nystrom counts with a frequency above the one it is told.
        const double w = method == Method::nystrom ? 1.08 : 1.0;
        const auto size_after = [&](int steps) {
          Motion motion(2.0 * w * w, alpha);
          motion.place() = kStart;
          EXPECT_TRUE(motion.advance(*make_stepper(method, motion.system), h, steps));
          return std::hypot(motion.place(), motion.speed());
        };
        const Motion motion(2.0, alpha);
        const auto stepper = make_stepper(method, motion.system);
        const double growth = dynamic_cast<const EmbeddedStepper&>(*stepper).growth(1.0, alpha, 0.0, h);
        // A turning motion is seen from different sides.
        EXPECT_NEAR(std::log(size_after(60) / size_after(20)) / 40, std::log1p(growth), 0.06)
            << to_string(method) << " alpha " << alpha << " h " << h;
      }
}

TEST(Growth, OfNystromIsNoneBelowItsLimit) {
  const Motion motion(2.0, 0.0);
  const auto stepper = make_stepper(Method::nystrom, motion.system);
  const auto& nystrom = dynamic_cast<const EmbeddedStepper&>(*stepper);
  for (double h = 0.001; h < 2.86 / 1.08; h += 0.001) EXPECT_LT(nystrom.growth(1.0, 0.0, 0.0, h), 1e-14) << h;
  EXPECT_GT(nystrom.growth(1.0, 0.0, 0.0, 2.87 / 1.08), 0.01);
}

TEST(Methods, AreFoundByNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const MethodInfo& row : methods()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    ASSERT_NE(find_method(row.name), nullptr);
    EXPECT_EQ(find_method(row.name)->method, row.method);
    EXPECT_STREQ(to_string(row.method), row.name);
    EXPECT_EQ(&info(row.method), find_method(row.name));
  }
  EXPECT_EQ(find_method("leapfrog"), nullptr);
}

TEST(Methods, HaveTheNumbersOfTheEnumeration) {
  EXPECT_STREQ(to_string(Method::cash_karp), "cash_karp");
  EXPECT_STREQ(to_string(Method::rodas), "rodas");
  EXPECT_STREQ(to_string(Method::automatic), "automatic");
  EXPECT_STREQ(to_string(Method::verlet), "verlet");
  EXPECT_STREQ(to_string(Method::runge_kutta4), "runge_kutta4");
  EXPECT_STREQ(to_string(Method::explicit_euler), "explicit_euler");
  EXPECT_STREQ(to_string(Method::backward_euler), "backward_euler");
  EXPECT_STREQ(to_string(Method::nystrom), "nystrom");
}

TEST(Methods, OfOtherNumbersAreRefused) {
  EXPECT_THROW(info(static_cast<Method>(methods().size())), InvalidInput);
  EXPECT_THROW(info(static_cast<Method>(-1)), InvalidInput);
}

}  // namespace
}  // namespace tendril
