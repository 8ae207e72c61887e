#include "spared.h"

#include <tendril/dynamics/simulation.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "page/clock.h"

namespace tendril::gallery {
namespace {

constexpr double kSpent = 0.02, kLongest = 1.0;  // seconds of a processor, of motion
constexpr int kRounds = 5;

/// A scene and its first motion.
class Trial {
 public:
  explicit Trial(const Scene& scene) : system_(scene) {
    for (until_ = 0.01; until_ < kLongest; until_ *= 2) {
      const double begin = cpu_seconds();
      run();
      if (cpu_seconds() - begin > kSpent) break;
    }
  }
  void run() {
    Simulation simulation(system_, system_.rest_state());
    const Report report = simulation.run(until_);
    if (report.stop != Stop::finished) throw std::runtime_error(report.reason);
    steps_ = static_cast<double>(report.accepted);
  }
  double steps() const { return steps_; }
  double states() const { return static_cast<double>(system_.rest_state().y.size()); }
  const System& system() const { return system_; }

 private:
  System system_;
  double until_ = 0.0, steps_ = 0.0;
};

/// In a few words, what a system says it did without.
std::string left_out_of(const System& system) {
  std::size_t turned = 0;
  std::string rest;
  for (const std::string& one : system.left_out()) {
    if (one.starts_with("rods["))
      ++turned;
    else
      rest += one.substr(0, one.find(" left out")) + ", ";
  }
  std::string out;
  if (turned > 0)
    out = text("the twist state of %.0f of ", static_cast<double>(turned)) +
          text("%.0f curve-pairs, ", static_cast<double>(system.rods().size()));
  if (system.body_count() == 0) rest += "bodies, ";
  return out + rest + "solids and contact";
}

#ifdef TENDRIL_GALLERY_LINKED
/// Of a program, stripped.
double bytes_of(const std::string& name) {
  return static_cast<double>(std::filesystem::file_size(TENDRIL_GALLERY_LINKED "/linked_" + name));
}
#endif

/// Shared libraries are as large whatever a program uses of them.
void say_bytes([[maybe_unused]] Parts parts, [[maybe_unused]] Figure& out) {
#ifdef TENDRIL_GALLERY_LINKED
  const std::string name = parts == Parts::curves ? "curve" : parts == Parts::rods ? "rods" : "mesh";
  const double own = bytes_of(name), all = bytes_of("scene");
  out.left_out += text("A program of what is used is %.0f kB, ", own / 1000) +
                  text("one that reads and runs any scene %.0f kB. ", all / 1000);
  out.numbers.push_back(
      {"linked bytes of what is used, over a program that runs any scene", own / all, Bounds{0.002, 0.9}});
#endif
}

}  // namespace

void say_left_out(const Scene& scene, Parts parts, Figure& out) {
  Scene full = scene;
  full.twist = Scene::Twist::everywhere;
  Trial with(full), without(scene);
  const double share = without.states() / with.states();
  out.left_out = "Left out: " + left_out_of(without.system()) + ". " + text("%.0f states", without.states());
  if (share < 1) {
    const std::vector<double> seconds =
        median_seconds(kRounds, {[&] { with.run(); }, [&] { without.run(); }});
    const double all = seconds[0] / with.steps(), own = seconds[1] / without.steps();
    out.left_out += text(" instead of %.0f with every twist state, a step takes ", with.states()) +
                    text("%.1f us instead of ", 1e6 * own) + text("%.1f. ", 1e6 * all);
    out.numbers.push_back({"time of a step, over that with every twist state", own / all});
  } else {
    out.left_out += ", as many as with every twist state. ";
  }
  out.numbers.push_back({"states, over those with every twist state", share, Bounds{0.5, 1.0}});
  say_bytes(parts, out);
}

void say_left_out(Parts parts, Figure& out) {
  out.left_out = "Left out: dynamics; nothing has a state. ";
  say_bytes(parts, out);
}

}  // namespace tendril::gallery
