#include "study/ladder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "study/advice.h"

namespace tendril::runner {
namespace {

constexpr std::size_t kRungs = 4;  // of a fixed step's ladder that is not given

/// Steps for a method that takes them: below what is stable, or where all is, parts of the run.
std::vector<double> steps_for(const Study& study, Method method) {
  const double stable = study.stable_step(method);
  double step = stable > 0.0 ? 0.9 * stable : study.file().duration / 100;
  std::vector<double> out;
  for (std::size_t k = 0; k < kRungs; ++k, step /= 2) out.push_back(step);
  return out;
}

std::vector<double> rungs_for(const Study& study, const Plan& plan, Method method) {
  if (chooses_steps(method)) return plan.tolerances;
  return plan.steps.empty() ? steps_for(study, method) : plan.steps;
}

Trial skipped(const Setting& setting, std::string reason) {
  Trial out;
  out.outcome = Trial::Outcome::skipped;
  out.setting = setting;
  out.reason = std::move(reason);
  return out;
}

/// One run, its time the least of three when it is short.
Trial timed(const Study& study, const Setting& setting, double cap) {
  Trial trial = study.run(setting, cap);
  if (!trial.finished() || trial.cpu > 0.05) return trial;
  for (int k = 0; k < 2; ++k) trial.cpu = std::min(trial.cpu, study.run(setting, cap).cpu);
  return trial;
}

void compare(Trial& trial, const Reference& reference, double length) {
  // Of a run that was stopped, only outputs after the start say something.
  const bool moved = !trial.track.moments.empty() && trial.track.moments.back().time > 0.0;
  const bool counts = trial.finished() || trial.outcome == Trial::Outcome::capped;
  if (moved && counts) trial.error = distance(trial.track, reference.first.track, length);
  trial.track = {};
}

std::vector<Order> orders_of(const Results& results) {
  std::vector<Order> out;
  const double floor = results.reference ? 10.0 * results.reference->gap.position : 0.0;
  for (const Method method : results.plan.methods) {
    std::vector<double> slopes;
    const Trial* before = nullptr;
    for (const Trial& trial : results.trials) {
      if (trial.setting.method != method || !trial.finished() || !trial.error) continue;
      const double error = trial.error->position;
      if (!(error > floor) || error > 0.1) continue;
      if (before != nullptr)
        slopes.push_back(std::log(before->error->position / error) /
                         std::log(before->setting.value / trial.setting.value));
      before = &trial;
    }
    if (slopes.empty()) continue;
    const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
    std::nth_element(slopes.begin(), middle, slopes.end());
    out.push_back({method, *middle});
  }
  return out;
}

/// A method's way down its ladder.
struct Descent {
  Method method;
  std::vector<double> rungs;
  std::vector<Trial> trials;
  std::string given_up;
  bool impossible = false;  ///< it cannot take the scene
};

void descend(const Study& study, Descent& descent, double rung, double cap, const Results& results) {
  const Setting setting{descent.method, rung};
  if (!descent.given_up.empty() || cap <= 0.0) {
    descent.trials.push_back(skipped(setting, cap <= 0.0 ? "the budget is spent" : descent.given_up));
    return;
  }
  Trial trial = timed(study, setting, std::min(cap, results.plan.cap));
  if (trial.outcome == Trial::Outcome::capped)
    descent.given_up = to_string(setting) + " took too long already";
  if (results.reference) compare(trial, *results.reference, results.length);
  descent.trials.push_back(std::move(trial));
}

}  // namespace

Results carry_out(const Study& study, const Plan& plan, const std::function<void(double part)>& told) {
  Results out{plan, scene_length(study.system()), {}, {}, {}, {}};
  told(0.0);
  const double tightest = plan.tolerances.empty() ? 1e-8 : 0.1 * plan.tolerances.back();
  out.reference = make_reference(study, 0.5 * plan.budget, tightest, {0.1 * plan.target, plan.target});

  std::vector<Descent> descents;
  std::size_t most = 0;
  for (const Method method : plan.methods) {
    descents.push_back({method, rungs_for(study, plan, method), {}, {}, false});
    most = std::max(most, descents.back().rungs.size());
  }
  for (std::size_t k = 0; k < most; ++k) {
    told(kReferencePart + (1.0 - kReferencePart) * static_cast<double>(k) / static_cast<double>(most));
    for (Descent& descent : descents) {
      if (k >= descent.rungs.size() || descent.impossible) continue;
      descend(study, descent, descent.rungs[k], plan.budget - study.spent(), out);
    }
  }
  for (Descent& descent : descents)
    std::move(descent.trials.begin(), descent.trials.end(), std::back_inserter(out.trials));
  out.orders = orders_of(out);
  out.advice = advise(out);
  return out;
}

}  // namespace tendril::runner
