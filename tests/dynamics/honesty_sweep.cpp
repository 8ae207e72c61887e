/// Random scenes by the automatic choice, held to references that two methods certify: how many successes are
/// off by more than 10 and 100 tolerances, and what is refused, with its reason.
///
///     honesty_sweep [--seed S] [--first I] [--count N] [--tolerance T] [--effort EVALUATIONS] [--pushed 1]
///
/// Chains of 2 to 10 edges and trees of three rods; hinged, clamped, free and spun, or let go on the way; E
/// from 1e4 to 1e12; undamped, damped or viscous; 0.1 to 100 s, as far as the effort of a reference goes.
/// Where they are pushed, also by forces without an energy: wind, loads and torques that come and go. A
/// reference is RODAS at a thousandth of the tolerance; Runge-Kutta 4 at steps of one radian of the fastest
/// motion has to agree to one tolerance. Where they do not (chaotic motions), the scene does not count.
///
/// Fails where one is off by more than 100 tolerances; of a hundred scenes and more also where more than one
/// in a hundred is off by 10, or more than ten are refused.
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>

#include "support/rods.h"

namespace tendril {
namespace {

struct Options {
  unsigned long seed = 1;
  int first = 0;  ///< scene, so that one of them can be looked at by itself
  int count = 300;
  double tolerance = 1e-3;
  double effort = 4e6;
  bool pushed = false;
};

struct Case {
  std::string words;
  Scene scene;
  Vec3 spin = Vec3::Zero();
  Vec3 nudge = Vec3::Zero();  ///< a spin more, to see what becomes of a small difference
  double duration = 1.0;
};

template <class... Parts>
std::string words(const char* format, Parts... parts) {
  char text[200];
  std::snprintf(text, sizeof text, format, parts...);
  return text;
}

double log_uniform(test::Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

bool chance(test::Random& random, double share) {
  return random.uniform(0.0, 1.0) < share;
}

Rod rod_along(const Vec3& from, const Vec3& way, int edges, const Material& material, double radius) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.push_back(from + way * i / edges);
  return make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), material, circular_section(radius));
}

/// Two branches on a stem.
void branch(test::Random& random, Case& one, const Material& material, double radius) {
  const std::size_t last = one.scene.rods[0].p.size() - 1;
  for (const std::size_t node : {last / 2, last}) {
    const double along = random.uniform(0.2, 0.5);
    const double across = random.uniform(0.1, 0.4) * (node == last ? 1 : -1);
    const Vec3 way(along, across, 0.0);
    one.scene.rods.push_back(rod_along(one.scene.rods[0].p[node], way, 3, material, 0.7 * radius));
    one.scene.joints.push_back({.parent = 0, .node = node, .child = one.scene.rods.size() - 1});
  }
}

void hold(test::Random& random, Case& one) {
  const double kind = random.uniform(0.0, 1.0);
  if (kind < 0.2) {
    one.spin.y() = random.uniform(-1, 1);
    one.spin.z() = random.uniform(1, 8);
    one.words += ", free";
    return;
  }
  const bool clamped = kind > 0.6;
  one.words += clamped ? ", clamped" : ", hinged";
  one.scene.anchors.push_back({.rod = 0, .node = 0, .holds_frame = clamped});
  if (!chance(random, 0.2)) return;
  one.scene.anchors[0].until = random.uniform(0.2, 0.7) * one.duration;
  one.words += ", let go";
}

void damp(test::Random& random, Case& one) {
  const double kind = random.uniform(0.0, 1.0);
  const double damping = kind < 0.5 ? 0.0 : kind < 0.75 ? log_uniform(random, 0.01, 2.0) : 0.0;
  const double viscosity = kind < 0.75 ? 0.0 : log_uniform(random, 1e-6, 1e-2);
  for (Rod& rod : one.scene.rods) rod.mass_damping = damping, rod.viscosity = viscosity;
  if (damping > 0.0) one.words += words(", damped %.2g", damping);
  if (viscosity > 0.0) one.words += words(", viscous %.1e", viscosity);
}

/// Wind, a load or a torque on the last node of a rod, or wind and a load.
void push(test::Random& random, Case& one) {
  const double kind = random.uniform(0.0, 1.0);
  if (kind < 0.6) {
    WindOptions wind;
    wind.mean = log_uniform(random, 1e-3, 20.0) * random.in_cube(1.0).normalized();
    wind.gust = random.uniform(0.0, 1.0);
    wind.gust_frequency = log_uniform(random, 0.2, 5.0);
    one.scene.forces.push_back(std::make_shared<Wind>(wind));
    one.words += words(", wind of %.1e", wind.mean.norm());
    if (kind < 0.4) return;
  }
  double weight = 0.0;
  for (const Rod& rod : one.scene.rods)
    for (const double mass : rod.mass) weight += 9.81 * mass;
  const bool torque = kind > 0.85;
  const auto rod = static_cast<std::size_t>(random.uniform(0.0, double(one.scene.rods.size())));
  const std::size_t node = one.scene.rods[rod].p.size() - 1;
  const Vec3 all = weight * log_uniform(random, 0.01, torque ? 0.3 : 2.0) * random.in_cube(1.0).normalized();
  const double at = random.uniform(0.0, 0.8) * one.duration;
  const Signal signal = chance(random, 0.5)
                            ? Signal::sinusoid(1.0, log_uniform(random, 0.1, 5.0), random.uniform(0.0, 6.0))
                            : Signal::table({{at, 0.0}, {at + random.uniform(0.0, 0.2) * one.duration, 1.0}});
  one.scene.forces.push_back(std::make_shared<PointLoad>(
      torque ? PointLoad::Kind::torque : PointLoad::Kind::force, rod, node, all, signal));
  one.words += words(torque ? ", torque of %.1e" : ", load of %.1e", all.norm() / weight);
}

/// Of Runge-Kutta 4: a radian of the fastest motion, or within what decays fastest.
double other_step(const Case& one, double frequency) {
  double decay = 0.0;
  for (const Rod& rod : one.scene.rods)
    decay = std::max(decay, rod.mass_damping + rod.viscosity * frequency * frequency);
  return std::min(0.9 / frequency, 2.0 / std::max(decay, 1e-9));
}

Case make_case(test::Random& random, double effort, bool pushed) {
  Case one;
  const double young = log_uniform(random, 1e4, 1e12), radius = log_uniform(random, 2e-3, 3e-2);
  const Material material{young, young / 2.6, log_uniform(random, 500, 8000)};
  const int edges = static_cast<int>(random.uniform(2, 11));
  one.scene.rods.push_back(rod_along(Vec3::Zero(), Vec3::UnitX(), edges, material, radius));
  const bool tree = chance(random, 0.3) && edges > 3;
  if (tree) branch(random, one, material, radius);
  one.words = words("%s of %d edges, E %.0e, r %.0e", tree ? "tree" : "chain", edges, young, radius);
  one.scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, -9.81, 0)));
  damp(random, one);
  const System system(one.scene);
  const double w = system.largest_frequency(system.rest_state(), 16, *system.make_workspace());
  one.duration = std::min(log_uniform(random, 0.1, 100.0), effort * other_step(one, w) / 4.0);
  hold(random, one);
  if (pushed) push(random, one);
  one.words += words(", %.3g s", one.duration);
  return one;
}

State start_of(const Case& one, const System& system) {
  State state = system.rest_state();
  const Vec3 spin = one.spin + one.nudge;
  const auto n = static_cast<Eigen::Index>(system.node_count());
  for (Eigen::Index i = 0; i < n; ++i)
    state.y.segment<3>(3 * n + 3 * i) = spin.cross(Vec3(state.y.segment<3>(3 * i)));
  return state;
}

struct End {
  Report report;
  Eigen::VectorXd p;
};

End run(const Case& one, const SimulationOptions& options) {
  const System system(one.scene);
  Simulation simulation(system, start_of(one, system), options);
  End end{simulation.run(one.duration), {}};
  end.p = simulation.state().y.head(3 * static_cast<Eigen::Index>(system.node_count()));
  return end;
}

/// Largest distance of a node, in lengths of the first rod.
double gap(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double most = 0.0;
  for (Eigen::Index i = 0; i + 2 < a.size(); i += 3)
    most = std::max(most, (a.segment<3>(i) - b.segment<3>(i)).norm());
  return most;
}

SimulationOptions fine_options(const Options& options) {
  SimulationOptions fine;
  fine.method = Method::rodas;
  fine.tolerance = 1e-3 * options.tolerance;
  fine.energy_limit = fine.drift_limit = 1e9;
  fine.work_limit = static_cast<long>(2 * options.effort);
  return fine;
}

/// What a spin more of a thousandth of a tolerance a time unit at the start has moved the end by, over that
/// thousandth: a motion that makes much of it no method can foretell to its tolerance.
double growth(Case one, const Options& options, const Eigen::VectorXd& end) {
  const double small = 1e-3 * options.tolerance;
  one.nudge = small * Vec3(0.3, 0.5, 0.8);
  return gap(run(one, fine_options(options)).p, end) / small;
}

std::optional<Eigen::VectorXd> certified(const Case& one, const Options& options) {
  const SimulationOptions fine = fine_options(options);
  const End first = run(one, fine);
  if (first.report.stop != Stop::finished) return {};
  const System system(one.scene);
  const double w = system.largest_frequency(system.rest_state(), 16, *system.make_workspace());
  SimulationOptions other = fine;
  other.method = Method::runge_kutta4;
  other.fixed_step = other_step(one, w);
  const End second = run(one, other);
  if (second.report.stop != Stop::finished || gap(first.p, second.p) > options.tolerance) return {};
  return first.p;
}

struct Counts {
  int certified = 0, right = 0, beyond10 = 0, beyond100 = 0, refused = 0, uncertified = 0;
  std::map<std::string, int> reasons;
};

void judge(const Case& one, const Options& options, Counts& counts) {
  SimulationOptions told;
  told.method = Method::automatic;
  told.tolerance = options.tolerance;
  const End end = run(one, told);
  const std::optional<Eigen::VectorXd> reference = certified(one, options);
  if (!reference) {
    ++counts.uncertified;
    std::printf("  %s: no reference; %s\n", one.words.c_str(), to_string(end.report.stop));
    return;
  }
  ++counts.certified;
  if (end.report.stop != Stop::finished) {
    ++counts.refused;
    ++counts.reasons[to_string(end.report.stop)];
    std::printf("  %s: %s: %s\n", one.words.c_str(), to_string(end.report.stop), end.report.reason.c_str());
    return;
  }
  const double error = gap(end.p, *reference) / options.tolerance;
  ++(error > 100.0 ? counts.beyond100 : error > 10.0 ? counts.beyond10 : counts.right);
  std::printf("  %s: %.2g tolerances off, %.2g told, %s, %ld steps%s\n", one.words.c_str(), error,
              end.report.drift / options.tolerance, end.report.method.c_str(), end.report.accepted,
              error > 100.0  ? " WRONG"
              : error > 10.0 ? " beyond 10"
                             : "");
  if (error > 10.0)
    std::printf("        a difference at its start grows %.2g times\n", growth(one, options, *reference));
}

int sweep(const Options& options) {
  Counts counts;
  for (int i = options.first; i < options.first + options.count; ++i) {
    test::Random random(options.seed * 100003 + static_cast<unsigned long>(i));
    std::printf("%4d", i);
    judge(make_case(random, options.effort, options.pushed), options, counts);
    std::fflush(stdout);
  }
  const auto share = [&](int part) { return 100.0 * part / std::max(1, counts.certified); };
  std::printf("%d scenes, %d without a reference; of the others\n", options.count, counts.uncertified);
  std::printf("  within 10 tolerances  %5.1f %%\n", share(counts.right));
  std::printf("  beyond 10             %5.1f %%\n", share(counts.beyond10));
  std::printf("  beyond 100            %5.1f %%\n", share(counts.beyond100));
  std::printf("  refused               %5.1f %%\n", share(counts.refused));
  for (const auto& [reason, count] : counts.reasons) std::printf("    %s %d\n", reason.c_str(), count);
  // Of a few scenes one is many per cent.
  const bool enough = counts.certified >= 100;
  const bool rarely = share(counts.beyond10) <= 1.0 && share(counts.refused) <= 10.0;
  return counts.beyond100 == 0 && (!enough || rarely) ? 0 : 1;
}

}  // namespace
}  // namespace tendril

int main(int argc, char** argv) {
  tendril::Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const char* value = argv[i + 1];
    if (!std::strcmp(argv[i], "--seed")) options.seed = std::strtoul(value, nullptr, 10);
    if (!std::strcmp(argv[i], "--first")) options.first = std::atoi(value);
    if (!std::strcmp(argv[i], "--count")) options.count = std::atoi(value);
    if (!std::strcmp(argv[i], "--tolerance")) options.tolerance = std::atof(value);
    if (!std::strcmp(argv[i], "--effort")) options.effort = std::atof(value);
    if (!std::strcmp(argv[i], "--pushed")) options.pushed = std::atoi(value) != 0;
  }
  return tendril::sweep(options);
}
