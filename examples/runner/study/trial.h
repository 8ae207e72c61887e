#pragma once

#include <tendril/scene/scene_file.h>

#include <functional>

namespace tendril::runner {

/// CPU time of this thread [s].
double cpu_seconds();

/// Where all masses are and how their frames stand, at each output of a run and at its end.
struct Track {
  struct Moment {
    double time;
    std::vector<Vec3> p;
    std::vector<Frame> frames;
  };
  std::vector<Moment> moments;
};

/// How far two runs are apart, the largest over the moments both have.
struct Distance {
  double position = 0.0;  ///< root mean square over the masses, relative to a length
  double director = 0.0;  ///< root mean square angle between the frames [rad]
};
Distance distance(const Track& a, const Track& b, double length);

/// The longest curve-pair at rest: what position errors are relative to.
double scene_length(const System& system);

/// A method and what it is told: a tolerance, or a step where it chooses none.
struct Setting {
  Method method;
  double value;
  bool by_step() const { return !chooses_steps(method); }
};
/// "rodas at 1e-06", "verlet, step 0.001"
std::string to_string(const Setting& setting);

/// One run of the scene.
struct Trial {
  enum class Outcome {
    finished,
    refused,  ///< by the library, before or on the way; see reason
    capped,   ///< its time was up; its cost is extrapolated, its error that of the part it did
    skipped   ///< not begun; see reason
  } outcome = Outcome::finished;
  Setting setting;
  std::string reason;
  Report report;
  double cpu = 0.0;          ///< [s], of the whole run: extrapolated when capped; see Study for the clock
  double evaluations = 0.0;  ///< the same
  Track track;
  std::optional<Distance> error;  ///< against the reference
  bool finished() const { return outcome == Outcome::finished; }
};
const char* to_string(Trial::Outcome outcome);

/// Runs a scene again and again.
class Study {
 public:
  /// \param file, system  kept by reference
  /// \param rate  evaluations that count as a second: no clock is asked then, and all is the same on every
  ///              machine
  Study(const scene::SceneFile& file, const System& system, std::optional<double> rate = {})
      : file_(file), system_(system), start_(scene::start_state(file, system)), rate_(rate) {}

  std::optional<double> rate() const { return rate_; }
  /// Seconds that its runs took so far, of CPU time or by the rate.
  double spent() const { return spent_; }

  /// Called while a run goes on, with the part of it that is done; false ends the study by throwing
  /// Cancelled.
  void on_progress(std::function<bool(double part)> progress) { progress_ = std::move(progress); }
  struct Cancelled {};

  /// \param cap  seconds, of CPU time or by the rate.
  /// \param patient  lifts the scene's limit on work, so that only the cap counts;
  /// and that on lost energy for backward Euler
  Trial run(const Setting& setting, double cap, bool patient = false) const;

  /// Largest stable step of an explicit method of fixed step at the start; 0 for the others.
  double stable_step(Method method) const;

  const scene::SceneFile& file() const { return file_; }
  const System& system() const { return system_; }

 private:
  const scene::SceneFile& file_;
  const System& system_;
  State start_;  ///< of every run: an equilibrium is looked for once
  std::optional<double> rate_;
  mutable double spent_ = 0.0;
  std::function<bool(double)> progress_;
};

}  // namespace tendril::runner
