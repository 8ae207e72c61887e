#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/stepper.h>

namespace tendril {

/// RODAS ([Hairer and Wanner 1996] section IV.7) with the coefficients RODAS4P2 [Steinebach 2020]: a linearly
/// implicit Rosenbrock method of order 4 with an embedded one of order 3, six stages, L-stable and stiffly
/// accurate. The coefficients keep more of the order where stiff springs turn with the motion: at equal steps
/// a hinged rod loses a tenth of the energy it lost with the first ones. No iteration: one matrix a step,
///
///   s^2 M - s F_u - F_x - s M C + F_u C,   s = 1 / (h gamma),
///
/// with x' = u + c(x), M u' = F, C and F_x, F_u their derivatives: the second-order form for the positions
/// and angles alone, three unknowns a node or four with twist, eliminated from tips to roots and children to
/// parents without fill. Springs and their viscous parts enter with exact derivatives; what is left by
/// differences.
///
/// It damps oscillations it does not resolve, so energy is lost to it where Cash-Karp would need its guard.
/// Time and memory of a step: O(nodes), on trees too.
class TENDRIL_CORE_API Rodas : public EmbeddedStepper {
 public:
  /// \param system  kept by reference
  explicit Rodas(const System& system);
  ~Rodas() override;

  Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) override;
  Evaluation advance(State& state, double h) override;
  void restart() override;
  void go_on() override;
  int error_order() const override { return 3; }
  bool stiff() const override { return true; }
  long evaluations() const override;
  const char* name() const override { return "RODAS 4(3)"; }

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril
