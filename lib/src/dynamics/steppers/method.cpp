#include <tendril/dynamics/backward_euler.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/fixed_steppers.h>
#include <tendril/dynamics/method.h>
#include <tendril/dynamics/rodas.h>

#include <algorithm>
#include <array>
#include <limits>

namespace tendril {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

template <class S>
std::unique_ptr<Stepper> made(const System& system) {
  return std::make_unique<S>(system);
}

// Limits of stability: the roots of |R(i y)| = 1 and |R(-x)| = 1, rounded down. |R(i y)| of Cash-Karp's
// solution exceeds 1 by y^6 / 7200, that of explicit Euler by y^2 / 2. Verlet in a pure decay multiplies by 1
// - x + x^2 / 2 a step, as its kick uses the velocities before the second one.
constexpr std::array kMethods{
    // method, name, stages, order, {h w, h (alpha + beta w^2)}, stiff, chooses, maker
    MethodInfo{Method::cash_karp, "cash_karp", 6, 5, {0.0, 3.73}, false, Chooses::steps, made<CashKarp>},
    MethodInfo{Method::rodas, "rodas", 6, 4, {kAny, kAny}, true, Chooses::steps, made<Rodas>},
    MethodInfo{Method::automatic, "automatic", 6, 5, {0.0, 3.73}, false, Chooses::method, made<CashKarp>},
    MethodInfo{Method::verlet, "verlet", 1, 2, {2.0, 2.0}, false, Chooses::nothing, made<VelocityVerlet>},
    MethodInfo{Method::runge_kutta4,
               "runge_kutta4",
               4,
               4,
               {2.82, 2.78},
               false,
               Chooses::nothing,
               made<ClassicRungeKutta>},
    MethodInfo{Method::explicit_euler,
               "explicit_euler",
               1,
               1,
               {0.0, 2.0},
               false,
               Chooses::nothing,
               made<ExplicitEuler>},
    MethodInfo{Method::backward_euler,
               "backward_euler",
               1,
               1,
               {kAny, kAny},
               true,
               Chooses::nothing,
               made<BackwardEuler>},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kMethods.size(); ++i)
    if (static_cast<std::size_t>(kMethods[i].method) != i) return false;
  return true;
}
static_assert(in_order(), "a row per method, in the order of the enumeration");

}  // namespace

std::span<const MethodInfo> methods() {
  return kMethods;
}

const MethodInfo& info(Method method) {
  return kMethods.at(static_cast<std::size_t>(method));
}

const MethodInfo* find_method(std::string_view name) {
  const auto found =
      std::find_if(kMethods.begin(), kMethods.end(), [&](const MethodInfo& row) { return row.name == name; });
  return found == kMethods.end() ? nullptr : &*found;
}

const char* to_string(Method method) {
  return info(method).name;
}

bool chooses_steps(Method method) {
  return info(method).chooses != Chooses::nothing;
}

std::unique_ptr<Stepper> make_stepper(Method method, const System& system) {
  return info(method).make(system);
}

}  // namespace tendril
