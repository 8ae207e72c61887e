#include "study/trial.h"

#include <time.h>

#include <cmath>
#include <cstdio>

namespace tendril::runner {
namespace {

/// Notes the state at outputs, and how long that took: it is no part of the run's cost.
class Tracker : public Follower {
 public:
  Tracker(const System& system, const Simulation& simulation)
      : system_(system), simulation_(simulation), work_(system.make_workspace()) {}

  void follow(double, std::span<const CurvePair>) override { note(); }

  void note() {
    const double begin = cpu_seconds();
    const State& state = simulation_.state();
    if (track_.moments.empty() || track_.moments.back().time < state.time) {
      Track::Moment moment{state.time, {}, system_.frames(state, *work_)};
      for (std::size_t i = 0; i < system_.node_count(); ++i)
        moment.p.push_back(state.y.segment<3>(3 * static_cast<Eigen::Index>(i)));
      track_.moments.push_back(std::move(moment));
    }
    seconds_ += cpu_seconds() - begin;
  }

  double seconds() const { return seconds_; }
  Track take() { return std::move(track_); }

 private:
  const System& system_;
  const Simulation& simulation_;
  System::WorkspacePtr work_;
  Track track_;
  double seconds_ = 0.0;
};

/// Asks the clock about once a millisecond: it costs as much as a small right-hand side.
class Pacer {
 public:
  bool due() {
    if (--left_ > 0) return false;
    const double now = cpu_seconds();
    stride_ = now - last_ < 1e-3 ? std::min(2 * stride_, 1024) : std::max(stride_ / 2, 1);
    last_ = now;
    left_ = stride_;
    return true;
  }

 private:
  int stride_ = 1, left_ = 1;
  double last_ = cpu_seconds();
};

SimulationOptions options_for(const scene::SceneFile& file, const Setting& setting, bool patient) {
  SimulationOptions options = file.options;
  options.method = setting.method;
  options.fixed_step.reset();
  if (setting.by_step())
    options.fixed_step = setting.value;
  else
    options.tolerance = setting.value;
  if (patient) options.work_limit = 1'000'000'000'000;
  // What backward Euler dissipates is taken away by extrapolation.
  if (patient && setting.method == Method::backward_euler) options.energy_limit = 1e9;
  return options;
}

double angle_between(const Frame& a, const Frame& b) {
  // The trace of the rotation from one to the other is 1 + 2 cos(angle); by the sine of half of it near 0.
  const double quarter =
      ((a.x - b.x).squaredNorm() + (a.y - b.y).squaredNorm() + (a.z - b.z).squaredNorm()) / 8;
  return 2.0 * std::asin(std::min(1.0, std::sqrt(quarter)));
}

/// Fills in what a run that was stopped would have cost.
void settle(Trial& trial, double duration) {
  const Stop stop = trial.report.stop;
  trial.reason = trial.report.reason;
  trial.evaluations = static_cast<double>(trial.report.evaluations);
  if (stop == Stop::finished) return;
  trial.outcome = stop == Stop::cancelled ? Trial::Outcome::capped : Trial::Outcome::refused;
  if (stop != Stop::cancelled) {
    trial.reason = std::string(tendril::to_string(stop)) + ": " + trial.reason;
    return;
  }
  trial.reason =
      "its time was up at " + std::to_string(trial.report.time) + " of " + std::to_string(duration);
  const double whole = duration / std::max(trial.report.time, 1e-12 * duration);
  trial.cpu *= whole;
  trial.evaluations *= whole;
}

}  // namespace

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Distance distance(const Track& a, const Track& b, double length) {
  Distance out;
  auto other = b.moments.begin();
  for (const Track::Moment& moment : a.moments) {
    while (other != b.moments.end() && other->time < moment.time) ++other;
    if (other == b.moments.end()) break;
    if (other->time > moment.time) continue;
    double position = 0.0, director = 0.0;
    for (std::size_t i = 0; i < moment.p.size(); ++i) {
      const double angle = angle_between(moment.frames[i], other->frames[i]);
      position += (moment.p[i] - other->p[i]).squaredNorm();
      director += angle * angle;
    }
    const double count = static_cast<double>(moment.p.size());
    out.position = std::max(out.position, std::sqrt(position / count) / length);
    out.director = std::max(out.director, std::sqrt(director / count));
  }
  return out;
}

double scene_length(const System& system) {
  double longest = 0.0;
  for (const Rod& rod : system.scene().rods) {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < rod.p.size(); ++i) length += (rod.p[i + 1] - rod.p[i]).norm();
    longest = std::max(longest, length);
  }
  return longest;
}

std::string to_string(const Setting& setting) {
  char value[32];
  std::snprintf(value, sizeof value, setting.by_step() ? "%.3g" : "%.0e", setting.value);
  return std::string(tendril::to_string(setting.method)) + (setting.by_step() ? ", step " : " at ") + value;
}

const char* to_string(Trial::Outcome outcome) {
  switch (outcome) {
    case Trial::Outcome::finished:
      return "finished";
    case Trial::Outcome::refused:
      return "refused";
    case Trial::Outcome::capped:
      return "capped";
    case Trial::Outcome::skipped:
      return "skipped";
  }
  return "unknown";
}

Trial Study::run(const Setting& setting, double cap, bool patient) const {
  Trial trial;
  trial.setting = setting;
  const double begin = cpu_seconds();
  try {
    Simulation simulation(system_, start_, options_for(file_, setting, patient));
    Tracker tracker(system_, simulation);
    simulation.add(tracker, Simulation::When::output);
    bool cancelled = false;
    Pacer pacer;
    double steps = 0.0;
    const auto spent = [&] {
      return rate_ ? steps * info(setting.method).stages / *rate_ : cpu_seconds() - begin - tracker.seconds();
    };
    simulation.on_progress([&](double time) {
      ++steps;
      if (!rate_ && !pacer.due()) return true;
      cancelled = progress_ && !progress_(time / file_.duration);
      return !cancelled && spent() < cap;
    });
    trial.report = simulation.run(file_.duration, file_.outputs);
    if (cancelled) throw Cancelled();
    if (trial.report.stop == Stop::finished) tracker.note();
    trial.cpu = rate_ ? static_cast<double>(trial.report.evaluations) / *rate_ : spent();
    spent_ += trial.cpu;
    trial.track = tracker.take();
    settle(trial, file_.duration);
  } catch (const InvalidInput& error) {
    // A method that cannot take the scene; the scene itself has been accepted before.
    trial.outcome = Trial::Outcome::refused;
    trial.reason = error.what();
  }
  return trial;
}

double Study::stable_step(Method method) const {
  const auto& [oscillation, decay_limit] = info(method).stability;
  if (chooses_steps(method) || oscillation == 0.0 || !std::isfinite(oscillation)) return 0.0;
  const auto work = system_.make_workspace();
  const double w = system_.largest_frequency(start_, 32, *work);
  double decay = 0.0;
  for (const Rod& rod : system_.scene().rods)
    decay = std::max(decay, rod.mass_damping + rod.viscosity * w * w);
  return std::min({oscillation / w, decay_limit / decay, file_.duration});
}

}  // namespace tendril::runner
