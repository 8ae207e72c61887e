#pragma once

#include <tendril/dynamics/stepper.h>

namespace tendril {

/// RODAS (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.7): a linearly implicit
/// Rosenbrock method of order 4 with an embedded one of order 3, six stages, L-stable and stiffly accurate.
/// No iteration: one matrix a step,
///
///   (s - a_u)(s - c_x) - a_x,   s = 1 / (h gamma),
///
/// the second-order form for the positions and angles alone (4 unknowns a node, 3 without twist), banded on
/// chains. Springs and their viscous parts enter with exact derivatives; the rest by differences. What is
/// left out (how the directions of the viscous forces change) lowers the order of fast, strongly viscous
/// motions.
///
/// It damps oscillations it does not resolve, so energy is lost to it where Cash-Karp would need its guard.
/// Cost a step: O(nodes). Not for systems with joints.
class Rodas : public EmbeddedStepper {
 public:
  /// Throws InvalidInput for a system with joints. \param system  kept by reference
  explicit Rodas(const System& system);
  ~Rodas() override;

  Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) override;
  Evaluation advance(State& state, double h) override;
  void restart() override;
  int error_order() const override { return 3; }
  bool stiff() const override { return true; }
  long evaluations() const override;
  const char* name() const override { return "RODAS 4(3)"; }

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril
