#pragma once

#include <tendril/contact/rod_contact.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include <stdexcept>

#include "accuracy/case.h"

/// What the cases of contact have in common. None returns a figure of a run that did not come to its end.
namespace tendril::contact {

using accuracy::Case;
using accuracy::Limit;
using accuracy::Order;
using accuracy::Quantity;
using accuracy::Row;

/// What rods' contact with solids was at a state, where it is the scene's force of that index.
inline const ContactMemory& memory_of(const State& state, std::size_t force = 0) {
  return dynamic_cast<const ContactMemory&>(*state.memory.at(force));
}

inline void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

inline void run_to(Simulation& simulation, double until) {
  const Report report = simulation.run(until);
  if (report.stop != Stop::finished) throw std::runtime_error(report.reason);
}

inline Equilibrium found_from(const System& system, const State& start, const StaticsOptions& options = {}) {
  Equilibrium found = find_equilibrium(system, start, options);
  if (found.balance != Balance::converged) throw std::runtime_error(found.reason);
  return found;
}

inline Row relative(int n, double value, double reference) {
  return {n, value, value / reference - 1.0};
}

/// The same quantity at one more n, where it is held to a limit and no longer to an order: what is left
/// there is the range of the barrier.
inline Quantity fine(const Quantity& coarse, const Row& row, double limit) {
  return {coarse.name + ", fine", coarse.reference, coarse.error_is, {row}, {{row.n, limit}}};
}

inline Vec3 place(const State& state, std::size_t node) {
  return state.y.segment<3>(static_cast<Eigen::Index>(3 * node));
}

}  // namespace tendril::contact
