#include "moved.h"

#include <cmath>
#include <stdexcept>

namespace tendril::gallery {
namespace {

/// Keeps what the curve-pairs carry at each output.
class Keeper : public Follower {
 public:
  Keeper(const bind::Binding& binding, Moved& to) : binding_(binding), to_(to) {}
  void follow(double, std::span<const CurvePair> pairs) override {
    to_.frames.emplace_back(binding_.size());
    binding_.update(pairs, to_.frames.back());
  }

 private:
  const bind::Binding& binding_;
  Moved& to_;
};

/// Keeps the masses themselves.
class MassKeeper : public Follower {
 public:
  MassKeeper(const Simulation& of, std::size_t nodes, Moved& to) : of_(of), nodes_(nodes), to_(to) {}
  void follow(double, std::span<const CurvePair>) override {
    std::vector<Vec3>& frame = to_.frames.emplace_back(nodes_);
    for (std::size_t i = 0; i < nodes_; ++i)
      frame[i] = of_.state().y.segment<3>(3 * static_cast<Eigen::Index>(i));
  }

 private:
  const Simulation& of_;
  std::size_t nodes_;
  Moved& to_;
};

}  // namespace

std::vector<double> frame_times(double duration, int count) {
  std::vector<double> out;
  for (int k = 1; k <= count; ++k) out.push_back(duration * k / count);
  return out;
}

Moved move_net(const SpringNet& net, const NetOptions& options, std::span<const double> times) {
  Moved out;
  FlatRun run(net, at_rest(net), options);
  for (const double time : times) {
    const NetReport& report = run.run(time);
    if (!report.finished || report.time != time) throw std::runtime_error("spring net: " + report.reason);
    out.frames.push_back(run.state().p);
    out.accepted = report.accepted;
    out.evaluations = report.evaluations;
  }
  return out;
}

Moved move_system(const System& system, const SimulationOptions& options, std::span<const double> times,
                  const bind::Binding* binding) {
  Moved out;
  Simulation simulation(system, system.rest_state(), options);
  MassKeeper masses(simulation, system.node_count(), out);
  std::optional<Keeper> bound;
  if (binding) bound.emplace(*binding, out);
  simulation.add(binding ? static_cast<Follower&>(*bound) : masses, Simulation::When::output);
  const Report report = simulation.run(times.back(), times);
  if (report.stop != Stop::finished)
    throw std::runtime_error(std::string(to_string(report.stop)) + ": " + report.reason);
  out.accepted = report.accepted;
  out.evaluations = report.evaluations;
  return out;
}

double distance(const Moved& a, const Moved& b) {
  double sum = 0.0, count = 0.0;
  for (std::size_t f = 0; f < a.frames.size(); ++f)
    for (std::size_t i = 0; i < a.frames[f].size(); ++i) {
      sum += (a.frames[f][i] - b.frames.at(f).at(i)).squaredNorm();
      ++count;
    }
  return std::sqrt(sum / count);
}

}  // namespace tendril::gallery
