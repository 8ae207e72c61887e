#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>

#include "support/random.h"
#include "support/rods.h"

namespace tendril {
namespace {

using test::Random;

/// The derivatives that a force gives, as dense matrices.
struct Gathered : LoadDerivatives {
  explicit Gathered(std::size_t nodes)
      : by_p(Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(nodes),
                                   3 * static_cast<Eigen::Index>(nodes))),
        by_v(by_p) {}
  void add_by_position(std::size_t i, std::size_t j, const Mat3& k) override { block(by_p, i, j) += k; }
  void add_by_velocity(std::size_t i, std::size_t j, const Mat3& k) override { block(by_v, i, j) += k; }
  static Eigen::Block<Eigen::MatrixXd, 3, 3> block(Eigen::MatrixXd& m, std::size_t i, std::size_t j) {
    return m.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j));
  }
  Eigen::MatrixXd by_p, by_v;
};

/// Rods of 5 and 4 nodes, stirred, and what a force sees of them.
struct StirredState {
  explicit StirredState(Random& random) {
    for (std::size_t i = 0; i < 9; ++i) {
      p.push_back(Vec3(0.3 * static_cast<double>(i), 0, 0) + 0.1 * random.in_cube());
      v.push_back(2.0 * random.in_cube());
      t.push_back(random.in_cube().normalized());
    }
    spin.assign(9, 0.0);
    mass.assign(9, 1.0);
    width.assign(9, 0.02);
  }
  std::vector<Vec3> load(const Force& force) const {
    std::vector<Vec3> f(9, Vec3::Zero());
    std::vector<Vec3> torque(9, Vec3::Zero());
    force.add(view(), {f, torque});
    return f;
  }
  StateView view() const { return {0.37, p, v, t, spin, mass, width, rods}; }

  std::vector<Vec3> p, v, t;
  std::vector<double> spin, mass, width;
  std::vector<NodeRange> rods{{0, 5}, {5, 4}};
};

/// Largest difference to central differences, relative to the largest entry.
double error_of(const Force& force, StirredState state) {
  Gathered gathered(9);
  force.couplings(state.rods).derivatives()(state.view(), gathered);
  double worst = 0.0;
  const auto compare = [&](std::vector<Vec3> StirredState::*field, const Eigen::MatrixXd& exact) {
    for (std::size_t j = 0; j < 9; ++j)
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double h = 1e-5;
        double& x = (state.*field)[j][axis];
        const double at = x;
        x = at + h;
        const std::vector<Vec3> up = state.load(force);
        x = at - h;
        const std::vector<Vec3> down = state.load(force);
        x = at;
        for (std::size_t i = 0; i < 9; ++i) {
          const Vec3 difference = (up[i] - down[i]) / (2 * h);
          const auto row = 3 * static_cast<Eigen::Index>(i);
          const Vec3 given = exact.block<3, 1>(row, 3 * static_cast<Eigen::Index>(j) + axis);
          worst = std::max(worst, (difference - given).norm() / exact.cwiseAbs().maxCoeff());
        }
      }
  };
  compare(&StirredState::p, gathered.by_p);
  if (gathered.by_v.cwiseAbs().maxCoeff() > 0.0) compare(&StirredState::v, gathered.by_v);
  return worst;
}

TEST(WindDerivatives, MatchDifferences) {
  Random random(17);
  WindOptions wind;
  wind.mean = Vec3(3, 1, -0.5);
  wind.gust = 0.6;
  wind.gust_frequency = 2.0;
  wind.tangential_drag = 0.3;
  for (int trial = 0; trial < 5; ++trial)
    EXPECT_LT(error_of(Wind(wind), StirredState(random)), 1e-7) << trial;
}

/// More edges than are done at a time have the derivatives that each has alone.
TEST(WindDerivatives, AreThoseOfEachEdge) {
  Random random(4);
  WindOptions options;
  options.mean = Vec3(3, -1, 0.5);
  options.gust = 0.6;
  const Wind wind(options);
  constexpr std::size_t kNodes = 300;
  std::vector<Vec3> p, v, t(kNodes, Vec3::UnitX());
  for (std::size_t i = 0; i < kNodes; ++i) {
    p.push_back(Vec3(0.01 * static_cast<double>(i), 0, 0) + random.in_cube(0.003));
    v.push_back(random.in_cube(2.0));
  }
  const std::vector<double> ones(kNodes, 1.0);
  const auto derivatives = [&](std::size_t first, std::size_t count, Gathered& to) {
    const std::vector<NodeRange> rods{{0, count}};
    const StateView view{
        0.4, Points(p).subspan(first, count), Points(v).subspan(first, count), t, ones, ones, ones, rods};
    wind.couplings(rods).derivatives()(view, to);
  };
  Gathered all(kNodes), alone(2);
  derivatives(0, kNodes, all);
  for (std::size_t i = 0; i + 1 < kNodes; ++i) {
    alone.by_p.setZero();
    alone.by_v.setZero();
    derivatives(i, 2, alone);
    const auto at = 3 * static_cast<Eigen::Index>(i);
    EXPECT_LT((all.by_p.block<3, 3>(at + 3, at) - alone.by_p.block<3, 3>(3, 0)).norm(), 1e-12) << i;
    EXPECT_LT((all.by_v.block<3, 3>(at + 3, at) - alone.by_v.block<3, 3>(3, 0)).norm(), 1e-12) << i;
  }
  EXPECT_GT(all.by_p.norm(), 1e-3);
}

TEST(WindDerivatives, AreNothingInStillFlowAlongTheEdges) {
  Random random(18);
  StirredState state(random);
  for (Vec3& v : state.v) v.setZero();
  Gathered gathered(9);
  Wind(WindOptions{}).couplings(state.rods).derivatives()(state.view(), gathered);
  EXPECT_EQ(gathered.by_p.norm(), 0.0);
  EXPECT_EQ(gathered.by_v.norm(), 0.0);
}

TEST(PullTowardsDerivatives, MatchDifferences) {
  Random random(19);
  EXPECT_LT(error_of(PullTowards(1, 2, Vec3(1, 2, 3), 40.0), StirredState(random)), 1e-7);
}

}  // namespace
}  // namespace tendril
