#include "commands.h"
#include "read/scene_binding.h"
#include "write/interrupt.h"
#include "write/json_output.h"
#include "write/progress.h"
#include "write/recorder.h"
#include "write/run_pictures.h"
#include "write/summary.h"

#include <tendril/base/file.h>
#include <tendril/bind/import.h>
#include <tendril/dynamics/statics.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace tendril::runner {
namespace {

struct Options {
  std::string scene, out, mesh;
  StaticsOptions statics;
  int threads = 0;
  bool nearest = false, no_pictures = false, double_precision = false, json = false;
};

SceneFile read_all(const Options& options, bind::PolygonMesh& mesh, Phases& phases) {
  const Phases::Timer timer(phases, Phases::import);
  SceneFile file = read_scene(options.scene);
  if (!options.mesh.empty()) file.mesh = options.mesh;
  if (options.out.empty()) file.mesh.clear();
  if (!file.mesh.empty()) mesh = bind::read_mesh(file.mesh);
  if (!file.mesh.empty() && mesh.points.empty()) throw InvalidInput(file.mesh, "no points", "a mesh");
  return file;
}

System system_of(const SceneFile& file) {
  try {
    System system(file.scene);
    const State rest = system.rest_state();
    return system;
  } catch (const InvalidInput& error) {
    throw in_scene(file, error);
  }
}

/// Where anchors move, they are followed to the end of the scene's duration.
StaticsOptions search_options(const Options& options, const SceneFile& file) {
  StaticsOptions out = options.statics;
  const auto& anchors = file.scene.anchors;
  const bool moves =
      std::any_of(anchors.begin(), anchors.end(), [](const Anchor& a) { return a.motion != nullptr; });
  if (!out.until && moves) out.until = file.duration;
  if (options.nearest) out.seek = StaticsOptions::Seek::nearest;
  return out;
}

OrderedJson to_json(const Stability& stability) {
  return {{"kind", tendril::to_string(stability.kind)},
          {"unstable_directions", stability.unstable},
          {"neutral_directions", stability.neutral},
          {"smallest_eigenvalue", stability.smallest},
          {"threshold", stability.threshold}};
}

OrderedJson summarize(const SceneFile& file, const System& system, const Equilibrium& found) {
  OrderedJson out;
  out["status"] = tendril::to_string(found.balance);
  out["reason"] = found.reason;
  out["load"] = found.load;
  out["time"] = found.state.time;
  out["stability"] = to_json(found.stability);
  out["unstable_branches_left"] = found.left;
  out["conservative"] = found.conservative;
  out["residual"] = found.residual;
  out["force_scale"] = found.force_scale;
  out["last_step"] = found.last_step;
  out["energy"] = {{"elastic", found.elastic}, {"potential", found.potential}};
  for (std::size_t a = 0; a < found.support.size(); ++a)
    out["supports"].push_back(
        {{"anchor", file.anchor_places[a]}, {"force", tendril::runner::to_json(found.support[a])}});
  out["steps"] = found.steps;
  out["iterations"] = found.iterations;
  out["factorisations"] = found.factorisations;
  out["units"] = file.units;
  out["curve_pairs"] = file.names;
  out["masses"] = system.node_count();
  out["twist_states"] = system.twist_count();
  out["left_out"] = system.left_out();
  return out;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw FileError(folder, error ? error.message() : "it is not a folder");
  }
}

/// The masses, the mesh and pictures of the state found. \return  the names of the files
std::vector<std::string> write_state(const Options& options, SceneFile& file, const System& system,
                                     const State& state, bind::PolygonMesh& mesh, Phases& phases) {
  const int threads = thread_count(options.threads);
  const Simulation simulation(system, state, file.options);
  std::optional<bind::Binding> binding;
  if (!file.mesh.empty()) {
    const Phases::Timer timer(phases, Phases::bind);
    binding.emplace(bind_scene(file, mesh, mode_of(file, false, false), threads));
  }
  file.outputs = {state.time};
  file.panels = 1;
  Recorder recorder(file, system, simulation, mesh, binding ? &*binding : nullptr,
                    {options.out, true, options.double_precision, threads}, phases);
  recorder.follow(state.time, simulation.pairs());
  recorder.write_trajectory();
  if (!options.no_pictures) {
    const Phases::Timer timer(phases, Phases::draw);
    draw_run(file, mesh, recorder, threads, [](double) { return !Interrupt::requested(); });
  }
  return recorder.files();
}

void tell(const Options& options, const OrderedJson& summary, const Equilibrium& found) {
  if (options.json) {
    print(summary);
  } else {
    std::cout << tendril::to_string(found.balance) << ", " << tendril::to_string(found.stability.kind);
    if (found.stability.unstable > 0) std::cout << " in " << found.stability.unstable << " directions";
    std::cout << ": load " << found.load << ", time " << found.state.time << ", elastic energy "
              << found.elastic << ", unbalanced " << found.residual << " of " << found.force_scale << ", "
              << found.steps << " steps, " << found.iterations << " iterations\n";
    if (!options.out.empty()) std::cout << options.out << '\n';
  }
  if (found.balance != Balance::converged) {
    std::cerr << "tendril: " << tendril::to_string(found.balance) << ": " << found.reason << '\n';
  }
}

int statics(const Options& options) {
  const Interrupt interrupt;
  Phases phases;
  bind::PolygonMesh mesh;
  SceneFile file = read_all(options, mesh, phases);
  const System system = system_of(file);
  StaticsOptions search = search_options(options, file);
  if (!options.out.empty()) make_folder(options.out);
  Equilibrium found;
  {
    Progress progress;
    const Phases::Timer timer(phases, Phases::simulate);
    search.progress = [&](double part) {
      progress.show("balancing", part);
      return !Interrupt::requested();
    };
    found = find_equilibrium(system, system.rest_state(), search);
  }
  OrderedJson summary = summarize(file, system, found);
  if (!options.out.empty()) {
    summary["files"] = write_state(options, file, system, found.state, mesh, phases);
    summary["wall_s"] = wall_seconds(phases);
    write_file_whole(options.out + "/summary.json", summary.dump(2) + "\n");
  }
  tell(options, summary, found);
  return found.balance == Balance::converged ? kDone : kNoSuccess;
}

}  // namespace

Command statics_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("statics", "Finds a scene's equilibrium, and says whether it is stable");
  const auto options = std::make_shared<Options>();
  app->add_option("scene", options->scene, "scene file (JSON)")->required();
  app->add_option("--out", options->out, "folder for masses, mesh, pictures and summary of the equilibrium");
  app->add_option("--mesh", options->mesh, "OFF or PLY file to use instead of the scene's");
  app->add_option("--load", options->statics.last_load, "share of all forces, 1 by default");
  app->add_option("--until", options->statics.until,
                  "time to which anchors and forces are followed; by default the scene's duration where "
                  "anchors move, else 0");
  app->add_option("--tolerance", options->statics.tolerance, "of the last step; 1e-9 by default");
  app->add_option("--work-limit", options->statics.work_limit, "factorisations");
  app->add_flag("--nearest", options->nearest, "keep to the branch also where it is unstable");
  app->add_option("--threads", options->threads, "threads, 0 for all; results are the same");
  app->add_flag("--no-pictures", options->no_pictures, "draw no pictures");
  app->add_flag("--double", options->double_precision, "the mesh in double instead of single precision");
  app->add_flag("--json", options->json, "print the summary as JSON");
  return {app, [options] { return statics(*options); }};
}

}  // namespace tendril::runner
