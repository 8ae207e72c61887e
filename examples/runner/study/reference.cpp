#include "study/reference.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "study/extrapolation.h"

namespace tendril::runner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Setting> row_of(const Study& study, Method method, double tightest) {
  std::vector<Setting> out;
  if (chooses_steps(method)) {
    for (double tolerance = 1e-4; tolerance > 0.5 * tightest; tolerance *= 0.1)
      out.push_back({method, tolerance});
    return out;
  }
  const double limit = study.stable_step(method);
  for (double part = 0.5; part > 0.01; part *= 0.5) out.push_back({method, part * limit});
  return out;
}

/// A run within the time that is left; one that cannot end is given up after a tenth of it.
Trial within(const Study& study, const Setting& setting, double left) {
  Trial trial = study.run(setting, 0.1 * left, true);
  if (trial.outcome == Trial::Outcome::capped && trial.cpu < left) trial = study.run(setting, left, true);
  return trial;
}

/// \param failed  takes the first run when it did not finish
std::optional<Tightest> tightest_run(const Study& study, Method method, double seconds, double tightest,
                                     std::optional<Trial>& failed) {
  const double length = scene_length(study.system());
  std::optional<Tightest> out;
  double left = seconds;
  for (const Setting& setting : row_of(study, method, tightest)) {
    Trial trial = within(study, setting, left);
    if (!trial.finished()) {
      if (!out && !failed) failed = std::move(trial);
      break;
    }
    left -= trial.cpu;
    const double settled = out ? distance(out->trial.track, trial.track, length).position : kInfinity;
    out = {std::move(trial), settled};
    if (2.0 * out->trial.cpu > left) break;
  }
  return out;
}

std::string name(const Trial& trial) {
  return to_string(trial.setting) +
         (trial.setting.method == Method::backward_euler ? " and longer, extrapolated" : "");
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

}  // namespace

Reference certify(Trial first, Trial second, double length, const Agreement& wanted) {
  Reference out{std::move(first), std::move(second), false, {kInfinity, kInfinity}, {}};
  const std::string names = name(out.first) + " and " + name(out.second);
  if (!out.first.finished() || !out.second.finished()) {
    out.statement = "not certified: only " +
                    to_string((out.first.finished() ? out.first : out.second).setting) +
                    " finished within its time; " + to_string(out.second.setting) + ": " + out.second.reason;
    return out;
  }
  out.gap = distance(out.first.track, out.second.track, length);
  const bool close = out.gap.position <= wanted.position && out.gap.director <= wanted.director;
  out.certified = close && out.first.setting.method != out.second.setting.method;
  const std::string gap =
      number(out.gap.position) + " of the length and " + number(out.gap.director) + " rad";
  if (out.certified)
    out.statement = "certified: " + names + " agree to " + gap;
  else if (close)
    out.statement = "not certified: " + names + " agree to " + gap + ", but are one method";
  else
    out.statement = "not certified: " + names + " are " + gap + " apart, wanted " + number(wanted.position) +
                    " and " + number(wanted.director);
  return out;
}

std::optional<Reference> make_reference(const Study& study, double seconds, double tightest,
                                        const Agreement& wanted) {
  const double length = scene_length(study.system());
  std::vector<Tightest> found;
  std::optional<Trial> failed;
  for (const Method method : {Method::rodas, Method::cash_karp, Method::runge_kutta4}) {
    if (found.size() == 2) break;
    std::optional<Tightest> run = tightest_run(study, method, seconds / 2, tightest, failed);
    if (run) found.push_back(std::move(*run));
  }
  if (found.size() < 2) {
    if (std::optional<Tightest> run = extrapolated_run(study, seconds / 2)) found.push_back(std::move(*run));
  }
  if (found.empty()) return std::nullopt;
  if (found.size() == 1) return certify(std::move(found[0].trial), std::move(*failed), length, wanted);
  if (found[1].settled < found[0].settled) std::swap(found[0], found[1]);
  return certify(std::move(found[0].trial), std::move(found[1].trial), length, wanted);
}

}  // namespace tendril::runner
