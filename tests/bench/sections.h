#pragma once

#include "bench/command_line.h"
#include "bench/contest.h"

/// The parts of the bench. Each prints its tables and returns them as JSON; facts that do not hold (of
/// accuracy, never of time) are added to `broken`.
namespace tendril::bench {

/// The machine's limits and the cost of the equations per node.
OrderedJson right_hand_side(const Settings& settings);

/// The same of trees, with and without wind.
OrderedJson trees_in_wind(const Settings& settings);
/// One second of the clamped rod to 1e-3 of its length, by every method: stiffness against number of nodes,
/// and damping and mass ratios.
OrderedJson stiff_rods(Settings& settings);

/// Time per node and step, and memory, as chains and trees grow.
OrderedJson growth(const Settings& settings);

/// One second of a plant.
OrderedJson plant_in_real_time(Settings& settings);

/// A chain of ball-jointed capsules in MuJoCo beside a rod here, a body and step; nothing when it is absent.
OrderedJson mujoco_chain(const Settings& settings);

}  // namespace tendril::bench
