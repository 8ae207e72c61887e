#include "study/advice.h"

#include "study/svg.h"
#include "write/json_output.h"

namespace tendril::runner {
namespace {

using svg::number;

/// So much more may the automatic choice cost than the best fixed one.
constexpr double kWorthTheChoice = 1.3;

std::string as_scene_says(const Setting& setting) {
  return std::string("\"method\": \"") + tendril::to_string(setting.method) + "\", \"" +
         (setting.by_step() ? "fixed_step" : "tolerance") + "\": " + shortest(setting.value);
}

std::string costs(const Results& results, const Trial& trial) {
  return number("%.3g s of ", trial.cpu) + (results.plan.rate ? "counted" : "CPU") +
         " time for an error of " + number("%.1e", trial.error->position);
}

/// \param wanted  which trials count
template <class Wanted, class Value>
const Trial* least(const Results& results, const Wanted& wanted, const Value& value) {
  const Trial* best = nullptr;
  for (const Trial& trial : results.trials) {
    if (!trial.finished() || !trial.error || !wanted(trial)) continue;
    if (best == nullptr || value(trial) < value(*best)) best = &trial;
  }
  return best;
}

std::string sentence(const Results& results, const std::string& goal, const Trial& best,
                     const Trial& cheapest) {
  std::string out = "For " + goal + " take " + as_scene_says(best.setting) + ": " + costs(results, best);
  if (cheapest.cpu < 0.95 * best.cpu) {
    out += "; " + to_string(cheapest.setting) + ", takes " + number("%.2f", cheapest.cpu / best.cpu) +
           " times that";
    if (cheapest.setting.by_step()) out += " but controls no error";
  }
  if (!results.reference->certified) out += ". The reference is not certified: take this with care";
  return out + ".";
}

}  // namespace

Advice advise(const Results& results) {
  if (!results.reference) return {{}, "No run finished, so there is nothing to recommend."};
  const auto cpu = [](const Trial& trial) { return trial.cpu; };
  const auto error = [](const Trial& trial) { return trial.error->position; };
  const auto any = [](const Trial&) { return true; };
  const auto meets = [&](const Trial& trial) { return error(trial) <= results.plan.target; };
  const auto controlled = [&](const Trial& trial) { return meets(trial) && !trial.setting.by_step(); };
  const std::string goal = number("%.0e", results.plan.target) + " of the scene's length";

  const Trial* cheapest = least(results, meets, cpu);
  const Trial* best = least(results, controlled, cpu);
  if (best == nullptr) best = cheapest;
  if (best == nullptr) {
    const Trial* closest = least(results, any, error);
    if (closest == nullptr) return {{}, "No run of the ladder finished."};
    return {{},
            "No run met " + goal + "; closest came " + as_scene_says(closest->setting) + ", " +
                costs(results, *closest) + "."};
  }
  const auto chosen = [&](const Trial& trial) {
    return controlled(trial) && trial.setting.method == Method::automatic &&
           trial.cpu <= kWorthTheChoice * best->cpu;
  };
  if (const Trial* automatic = least(results, chosen, cpu)) best = automatic;
  return {best->setting, sentence(results, goal, *best, *cheapest)};
}

}  // namespace tendril::runner
