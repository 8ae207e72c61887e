#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/stepper.h>

#include <string_view>

namespace tendril {

/// The methods a run can be told to use. Others have numbers beyond these, which the table below gives them:
/// find_method(name)->method.
enum class Method {
  cash_karp,       ///< cash_karp.h, its steps chosen
  rodas,           ///< rodas.h, its steps chosen
  automatic,       ///< Cash-Karp, Nystrom or RODAS as stiffness and accuracy ask, changing to and fro
  verlet,          ///< VelocityVerlet, steps of the size given
  runge_kutta4,    ///< ClassicRungeKutta, steps of the size given
  explicit_euler,  ///< ExplicitEuler, steps of the size given
  backward_euler,  ///< BackwardEuler, steps of the size given
  nystrom          ///< nystrom.h, its steps chosen
};

/// The largest steps h at which a method amplifies no motion x'' + (alpha + beta w^2) x' + w^2 x = 0.
/// Infinite where there is no such step; 0 where every step amplifies.
struct StabilityLimits {
  double oscillation;  ///< of h w, undamped
  double decay;        ///< of h (alpha + beta w^2), where damping overwhelms the oscillation
};

/// What a method decides during a run.
enum class Chooses {
  nothing,  ///< its steps are of a size given
  steps,    ///< its steps, by an estimate of their error
  method    ///< its steps, and which method takes them
};

/// A row of the table of methods. The row of a method that chooses methods is that of the one it begins with.
struct MethodInfo {
  Method method;     ///< which
  const char* name;  ///< as in scene files
  int stages;  ///< evaluations a step at least: Verlet needs a second one where forces depend on velocities
  int order;   ///< the error at a given time goes with the step to this power
  StabilityLimits stability;                               ///< of its steps
  bool stiff;                                              ///< damps what it does not resolve, at any step
  Chooses chooses;                                         ///< what it decides
  std::unique_ptr<Stepper> (*make)(const System& system);  ///< the system is kept by reference
};

/// The table, a row per method: those of the enumeration in its order, then the others by name. A new method
/// of the library is one file beside those in lib/src/dynamics/methods; whoever offers methods to choose from
/// goes through the rows.
TENDRIL_CORE_API std::span<const MethodInfo> methods();
/// The row of a method. Throws InvalidInput where no row has that number.
TENDRIL_CORE_API const MethodInfo& info(Method method);
/// The row of that name; nullptr where none has it.
TENDRIL_CORE_API const MethodInfo* find_method(std::string_view name);

/// Its name, as in scene files.
TENDRIL_CORE_API const char* to_string(Method method);

/// True for the methods that estimate their error and choose their steps by it.
TENDRIL_CORE_API bool chooses_steps(Method method);

/// A stepper for the method.
/// \param method  one that chooses methods: the stepper it begins with
/// \param system  kept by reference
TENDRIL_CORE_API std::unique_ptr<Stepper> make_stepper(Method method, const System& system);

}  // namespace tendril
