#include <tendril/dynamics/method.h>

#include "bench/clock.h"
#include "bench/sections.h"

#ifdef TENDRIL_BENCH_MUJOCO

#include <mujoco/mujoco.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <sstream>

namespace tendril::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 5e-3, kYoung = 1e4, kStep = 1e-4;

/// A clamped chain of capsules of length 1 m, joined by balls with the bending stiffness E I / h.
std::string chain_xml(int bodies, const char* integrator) {
  const double h = 1.0 / bodies, stiffness = kYoung * 0.25 * kPi * kRadius * kRadius * kRadius * kRadius / h;
  std::ostringstream out;
  out << "<mujoco><option timestep=\"" << kStep << "\" integrator=\"" << integrator
      << "\" gravity=\"0 0 -9.81\"><flag contact=\"disable\"/></option><worldbody>";
  for (int i = 0; i < bodies; ++i)
    out << "<body pos=\"" << (i == 0 ? 0.0 : h) << " 0 0\"><joint type=\"ball\" stiffness=\"" << stiffness
        << "\"/><geom type=\"capsule\" fromto=\"0 0 0 " << h << " 0 0\" size=\"" << kRadius
        << "\" density=\"1000\"/>";
  for (int i = 0; i < bodies; ++i) out << "</body>";
  out << "</worldbody></mujoco>";
  return out.str();
}

struct Release {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, Release>;
using Data = std::unique_ptr<mjData, Release>;

Model load(const std::string& xml) {
  std::string name = (std::filesystem::temp_directory_path() / "chain-XXXXXX").string();
  const int file = mkstemp(name.data());
  const bool written = file >= 0 && write(file, xml.data(), xml.size()) == static_cast<ssize_t>(xml.size());
  if (file >= 0) close(file);
  char error[256] = "the file could not be written";
  Model model(written ? mj_loadXML(name.c_str(), nullptr, error, sizeof error) : nullptr);
  std::filesystem::remove(name);
  if (!model) throw std::runtime_error(std::string("MuJoCo: ") + error);
  return model;
}

/// Seconds a body and step.
double mujoco_seconds(int bodies, const char* integrator) {
  const Model model = load(chain_xml(bodies, integrator));
  const Data data(mj_makeData(model.get()));
  constexpr int steps = 50;
  const double seconds = fastest(3, [&] {
    mj_resetData(model.get(), data.get());
    for (int i = 0; i < steps; ++i) mj_step(model.get(), data.get());
  });
  return seconds / (steps * bodies);
}

double own_seconds(int nodes, Method method) {
  const Problem problem = cantilever({.nodes = nodes, .young = kYoung, .twist = true});
  const std::unique_ptr<Stepper> stepper = make_stepper(method, problem.system);
  constexpr int steps = 200;
  const double seconds = fastest(3, [&] {
    State state = problem.start;
    stepper->restart();
    for (int i = 0; i < steps; ++i)
      if (!stepper->advance(state, kStep).ok()) throw std::runtime_error("a step failed");
  });
  return seconds / (steps * nodes);
}

}  // namespace

std::string mujoco_version() {
  return std::string("MuJoCo ") + mj_versionString();
}

OrderedJson mujoco_chain(const Settings&) {
  heading("MuJoCo",
          "clamped chain of ball-jointed capsules, contacts off, beside the rod with all springs and twist; "
          "CPU time a "
          "body or node and step of 0.1 ms, like beside like; target 100 at 90 bodies");
  Table table({"bodies", "MuJoCo", "", "here", "", "ratio"});
  OrderedJson out = OrderedJson::array();
  struct Pair {
    const char* integrator;
    Method method;
  };
  for (const int bodies : {32, 90}) {
    for (const Pair& pair :
         {Pair{"Euler", Method::verlet}, {"RK4", Method::runge_kutta4}, {"implicit", Method::rodas}}) {
      const double theirs = mujoco_seconds(bodies, pair.integrator), ours = own_seconds(bodies, pair.method);
      table.row({std::to_string(bodies), pair.integrator, duration(theirs), tendril::to_string(pair.method),
                 duration(ours), text("%.1f", theirs / ours)});
      out.push_back({{"bodies", bodies},
                     {"integrator", pair.integrator},
                     {"method", tendril::to_string(pair.method)},
                     {"mujoco_seconds", theirs},
                     {"own_seconds", ours}});
    }
  }
  table.print();
  return out;
}

}  // namespace tendril::bench

#else

namespace tendril::bench {

std::string mujoco_version() {
  return "MuJoCo: absent";
}

OrderedJson mujoco_chain(const Settings&) {
  return {};
}

}  // namespace tendril::bench

#endif
