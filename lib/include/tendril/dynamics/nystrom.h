#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/stepper.h>

#include <array>

namespace tendril {

/// A Runge-Kutta-Nystrom formula of four stages ([Hairer et al. 1993] II.14) for x'' = f(t, x, x'):
///   x_i = x + c_i h x' + h^2 sum_j place_ij f_j,   x'_i = x' + h sum_j rate_ij f_j,
/// with f_i = f(t + c_i h, x_i, x'_i); a step has the weights b_i (1 - c_i) and b_i. Of order 5 where f
/// depends on places alone. Else one condition of order 4 is not met, b rate rate c = 1/60 for 1/24: its term
/// is h^4 D^2 f' with D = df/dx', small where damping is. Of the formulas of this kind it amplifies no
/// oscillation x'' + w^2 x = 0 up to h w = 2.86, where others amplify the slow ones.
///
/// The error is that of a solution of order 3 by the same stages: h times their third divided difference over
/// kErrorShare.
struct NystromTableau {
  /// Times of the stages, in steps.
  static constexpr std::array<double, 4> c{0.0, 3.0 / 10, 9.0 / 10, 2.0 / 3};
  /// Weights of the stages before, for the places of each stage.
  static constexpr std::array<std::array<double, 3>, 4> place{{
      {},
      {9.0 / 200},
      {9.0 / 200, 9.0 / 25},
      {358.0 / 6561, 605.0 / 4374, 385.0 / 13122},
  }};
  /// The same for its velocities.
  static constexpr std::array<std::array<double, 3>, 4> rate{{
      {},
      {3.0 / 10},
      {0.0, 9.0 / 10},
      {-1456.0 / 6561, 1430.0 / 2187, 1540.0 / 6561},
  }};
  /// Weights of the stages in the step's velocities.
  static constexpr std::array<double, 4> b{31.0 / 324, 125.0 / 297, 125.0 / 567, 81.0 / 308};
  /// Third divided difference: 1 / prod_(j != i) (c_i - c_j).
  static constexpr std::array<double, 4> difference{-50.0 / 9, 500.0 / 33, 500.0 / 63, -1350.0 / 77};
  /// The error is a step times that difference over this.
  static constexpr double kErrorShare = 150.0;
};

/// One step of it. Angles of twist and turns of bodies have rates that depend on where they are besides: that
/// part of them is taken with the weights of rates.
class TENDRIL_CORE_API Nystrom : public EmbeddedStepper {
 public:
  /// \param system  kept by reference
  explicit Nystrom(const System& system);
  ~Nystrom() override;

  Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) override;
  int error_order() const override { return 3; }
  int stages() const override { return 4; }
  bool dissipates() const override { return true; }
  double growth(double w, double alpha, double beta, double h) const override;

  /// Advances the state by a step of fixed size: step, then System::rebase.
  Evaluation advance(State& state, double h) override;

  /// Forgets the kept derivative: call when the state has changed other than by advance.
  void restart() override;

  long evaluations() const override;
  const char* name() const override { return "Nystrom 5(3)"; }

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril
