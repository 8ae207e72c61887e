// Compiled with assertions, and the right-hand side with it: what a function reads must be of the same
// kinematics.
#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>

#include "dynamics/rhs/elastic.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/rhs/pull_back.h"
#include "dynamics/rhs/rates.h"
#include "support/rods.h"

namespace tendril {
namespace {

class Evaluated : public testing::Test {
 protected:
  Evaluated() : system_(scene()), model_(model_of(system_)), state_(system_.rest_state()), work_(model_) {}

  static Scene scene() {
    Scene result;
    result.rods.push_back(test::straight_rod(5, 1e5, 5e-3));
    result.forces.push_back(std::make_shared<PullTowards>(0, 3, Vec3(0, 1, 0), 2.0));
    return result;
  }
  void fill(Motion what) {
    ASSERT_TRUE(kinematics(model_, state_, 0.0, state_.y, what, work_.kinematics).ok());
  }
  void differentiate() {
    double energy = 0.0;
    ASSERT_TRUE(elastic_energy(model_, state_, work_.kinematics, work_.gradient, energy).ok());
    no_loads(work_.kinematics, work_.loads);
  }
  void pull() { pull_back(model_, work_.kinematics, work_.gradient, work_.loads, work_.pull); }

  System system_;
  const Model& model_;
  State state_;
  System::Workspace work_;
};

TEST_F(Evaluated, PassesInOrder) {
  fill(Motion::positions);
  differentiate();
  pull();
  Eigen::VectorXd dy;
  EXPECT_TRUE(rates(model_, state_, 0.0, state_.y, dy, work_).ok());
  double power = 0.0;
  EXPECT_TRUE(power_of_loads(model_, state_, 0.0, state_.y, power, work_).ok());
}

TEST_F(Evaluated, NotesWhatFitsTheKinematics) {
  EXPECT_FALSE(work_.kinematics.has_positions());
  EXPECT_FALSE(work_.gradient.made.fits(work_.kinematics));
  fill(Motion::positions);
  EXPECT_TRUE(work_.kinematics.has_frames());
  EXPECT_FALSE(work_.kinematics.has_rates());
  EXPECT_FALSE(work_.gradient.made.fits(work_.kinematics));
  differentiate();
  EXPECT_TRUE(work_.gradient.made.fits(work_.kinematics));
  EXPECT_TRUE(work_.loads.made.fits(work_.kinematics));
  fill(Motion::all);
  EXPECT_TRUE(work_.kinematics.has_rates());
  EXPECT_FALSE(work_.gradient.made.fits(work_.kinematics));
}

TEST_F(Evaluated, FitsNothingAfterAFailure) {
  fill(Motion::all);
  differentiate();
  Eigen::VectorXd y = state_.y;
  y.segment<3>(3) = y.segment<3>(0);
  EXPECT_FALSE(kinematics(model_, state_, 0.0, y, Motion::all, work_.kinematics).ok());
  EXPECT_FALSE(work_.kinematics.has_positions());
  EXPECT_FALSE(work_.gradient.made.fits(work_.kinematics));
}

using EvaluatedDeathTest = Evaluated;

TEST_F(EvaluatedDeathTest, AGradientOfOlderKinematicsIsNotPulledBack) {
  fill(Motion::positions);
  differentiate();
  fill(Motion::positions);
  EXPECT_DEATH(pull(), "fits");
}

TEST_F(EvaluatedDeathTest, ThereIsNoGradientBeforeTheKinematics) {
  double energy = 0.0;
  EXPECT_DEATH(elastic_energy(model_, state_, work_.kinematics, work_.gradient, energy), "has_positions");
}

TEST_F(EvaluatedDeathTest, ViscousSpringsNeedRates) {
  fill(Motion::positions);
  double heat = 0.0;
  EXPECT_DEATH(elastic(model_, state_, {true, true}, work_.kinematics, work_.gradient, heat), "has_rates");
}

TEST_F(EvaluatedDeathTest, ForcesSeeRates) {
  fill(Motion::positions);
  EXPECT_DEATH(view(model_, 0.0, work_.kinematics, work_.loads), "has_rates");
}

TEST_F(EvaluatedDeathTest, LoadsOfOlderKinematicsAreNotPulledBack) {
  fill(Motion::positions);
  differentiate();
  fill(Motion::positions);
  double energy = 0.0;
  ASSERT_TRUE(elastic_energy(model_, state_, work_.kinematics, work_.gradient, energy).ok());
  EXPECT_DEATH(pull(), "loads");
}

}  // namespace
}  // namespace tendril
