#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dynamics/coupling/elimination.h"
#include "dynamics/rhs/rates.h"
#include "stiff_solver.h"

namespace tendril {

/// What the forces whose couplings are said at states do at one.
struct LocalForces {
  NodePairs pairs;  ///< of nodes, or more, under those that carry them; ascending, each once
  std::optional<BlockPattern> pattern;               ///< of the equations with these, complete
  std::vector<std::vector<std::size_t>> neighbours;  ///< for Differences; empty where none is needed
  std::vector<Undifferentiated> undifferentiated;
};

/// A solver on a pattern that stays, which make_stiff_solver replaces where another is needed.
/// \param local  kept by reference; its forces may change, but not what they couple. Null where all couplings
///               are those of the model
std::unique_ptr<StiffSolver> make_block_solver(const System& system, System::Workspace& work,
                                               const LocalForces* local);

}  // namespace tendril
