#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/stepper.h>

#include <array>

namespace tendril {

/// The embedded Runge-Kutta pair of [Cash and Karp 1990], orders 5 and 4, six stages ([Chan 2008] 3.30 to
/// 3.32 and its Table 1, with the misprints corrected by the paper). Row sums of b equal a; c and c_star each
/// sum to 1.
struct CashKarpTableau {
  /// Times of the stages, in steps.
  static constexpr std::array<double, 6> a{0.0, 1.0 / 5, 3.0 / 10, 3.0 / 5, 1.0, 7.0 / 8};
  /// Weights of the stages before, for the arguments of each stage.
  static constexpr std::array<std::array<double, 5>, 6> b{{
      {},
      {1.0 / 5},
      {3.0 / 40, 9.0 / 40},
      {3.0 / 10, -9.0 / 10, 6.0 / 5},
      {-11.0 / 54, 5.0 / 2, -70.0 / 27, 35.0 / 27},
      {1631.0 / 55296, 175.0 / 512, 575.0 / 13824, 44275.0 / 110592, 253.0 / 4096},
  }};
  /// Weights of the stages in the solution of order 5.
  static constexpr std::array<double, 6> c{37.0 / 378, 0.0, 250.0 / 621, 125.0 / 594, 0.0, 512.0 / 1771};
  /// Weights of the stages in the solution of order 4.
  static constexpr std::array<double, 6> c_star{2825.0 / 27648,  0.0,           18575.0 / 48384,
                                                13525.0 / 55296, 277.0 / 14336, 1.0 / 4};
};

/// One step of the pair.
class TENDRIL_CORE_API CashKarp : public EmbeddedStepper {
 public:
  /// \param system  kept by reference
  explicit CashKarp(const System& system);
  ~CashKarp() override;

  /// y of order 5, error y - y_star ([Chan 2008] 3.32).
  Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) override;
  int error_order() const override { return 4; }

  /// Advances the state by a step of fixed size: step, then System::rebase.
  Evaluation advance(State& state, double h) override;

  /// Forgets the kept derivative: call when the state has changed other than by advance.
  void restart() override;

  long evaluations() const override;
  const char* name() const override { return "Cash-Karp 4(5)"; }
  System::Workspace& workspace();  ///< its own, for other evaluations between steps

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril
