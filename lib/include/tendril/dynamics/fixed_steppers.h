#pragma once

#include <tendril/dynamics/stepper.h>

#include <Eigen/LU>

#include <array>

namespace tendril {

/// y + h f(t, y). Order 1, one evaluation. Amplifies every undamped oscillation, by sqrt(1 + (h w)^2) a step:
/// a comparator, not a method to use.
class ExplicitEuler : public Stepper {
 public:
  explicit ExplicitEuler(const System& system);
  Evaluation advance(State& state, double h) override;
  long evaluations() const override { return evaluations_; }
  const char* name() const override { return "explicit Euler"; }

 private:
  const System& system_;
  System::WorkspacePtr work_;
  Eigen::VectorXd rate_;
  long evaluations_ = 0;
};

/// The classic Runge-Kutta method (thesis 3.28 with k4 at y + h k3). Order 4, four evaluations, stable on
/// undamped oscillations to h w = 2.82 and dissipating there, by (h w)^6 / 144 a step.
class ClassicRungeKutta : public Stepper {
 public:
  explicit ClassicRungeKutta(const System& system);
  Evaluation advance(State& state, double h) override;
  long evaluations() const override { return evaluations_; }
  const char* name() const override { return "classic Runge-Kutta 4"; }

 private:
  const System& system_;
  System::WorkspacePtr work_;
  std::array<Eigen::VectorXd, 4> k_;
  Eigen::VectorXd stage_;
  long evaluations_ = 0;
};

/// v' = v + h a(t', p', v'), p' = p + h v', the spins and directors alike. Order 1, stable at every step and
/// strongly dissipating: a comparator.
///
/// Newton on the 3n + m new velocities and spins with a dense matrix from forward differences: 3n + m
/// evaluations and 2/3 (3n + m)^3 operations whenever the kept one converges slowly, 2 (3n + m)^2 operations
/// an iteration; any force and any tree, but not for many nodes. Outcome not_converged when no matrix renewed
/// on the way helps: then a shorter step will.
class BackwardEuler : public Stepper {
 public:
  explicit BackwardEuler(const System& system);
  Evaluation advance(State& state, double h) override;
  void restart() override { matrix_step_ = 0.0; }
  long evaluations() const override { return evaluations_; }
  const char* name() const override { return "backward Euler"; }

 private:
  Evaluation defect(const State& start, double h, const Eigen::VectorXd& z, Eigen::VectorXd& out);
  Evaluation renew_matrix(const State& start, double h, const Eigen::VectorXd& z,
                          const Eigen::VectorXd& at_z);
  bool iterate(const State& start, double h, Eigen::VectorXd& z, Evaluation& at);
  void place(const State& start, double h, const Eigen::VectorXd& z, Eigen::VectorXd& y) const;

  const System& system_;
  System::WorkspacePtr work_;
  Eigen::Index moved_, turned_;  ///< 3n, m
  Eigen::VectorXd scale_;        ///< per unknown: shortest edge, or 1 rad
  Eigen::VectorXd rate_, y_, start_;
  Eigen::PartialPivLU<Eigen::MatrixXd> matrix_;
  double matrix_step_ = 0.0;  ///< the step the matrix was made for; 0: none
  long evaluations_ = 0;
};

/// Velocity Verlet, kick, drift, kick. The drift moves the masses by h v, carries each director by the
/// smallest rotation from the old tangent to the new one and turns it by h w about that: the inverse drift
/// undoes it exactly. The connection term of the twist angle is the area on the sphere between the tangent's
/// way and the great circle: 0 at the ends of a rod and in planar motion, O(h^3) a step elsewhere, and left
/// out.
///
/// Where forces depend on positions only (no damping, no drag, no twist state) it is symplectic and
/// reversible, at one evaluation a step: the energy error stays bounded, O((h w)^2), for h w < 2. (Undamped
/// swinging rod of 32 masses, 60 s: within 3.5 % of m g L / 2 at h w = 1, 1.1 % at 0.5.) Otherwise the second
/// kick is made twice, first with the velocities of the half step and then with those it found: still
/// order 2, two evaluations, stable for h w < 2 and h (alpha + beta w^2) < 2, but neither symplectic nor
/// exactly reversible. With the gyroscopic force of spinning nodes the energy wanders: by 4e-4 in 200 s of
/// free flight at h w = 0.26, 1e-4 at 0.13.
class VelocityVerlet : public Stepper {
 public:
  explicit VelocityVerlet(const System& system);
  Evaluation advance(State& state, double h) override;
  void restart() override { known_ = false; }
  long evaluations() const override { return evaluations_; }
  const char* name() const override { return "velocity Verlet"; }

 private:
  const System& system_;
  System::WorkspacePtr work_;
  int passes_;
  Eigen::VectorXd rate_, half_, y_;
  bool known_ = false;
  long evaluations_ = 0;
};

}  // namespace tendril
