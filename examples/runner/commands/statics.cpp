#include "commands.h"
#include "read/mesh_reader.h"
#include "write/folder.h"
#include "write/interrupt.h"
#include "write/json_output.h"
#include "write/progress.h"
#include "write/recorder.h"
#include "write/run_pictures.h"

#include <tendril/base/file.h>
#include <tendril/dynamics/statics.h>

#include <algorithm>
#include <iostream>
#include <optional>

namespace tendril::runner {
namespace {

struct StaticsArguments {
  std::string scene, out, mesh;
  StaticsOptions statics;
  int threads = 0;
  bool nearest = false, no_pictures = false, double_precision = false, json = false;
};

bool mesh_meets(const scene::SceneFile& file) {
  return file.mesh_contact.make || file.mesh_self_contact.make;
}

scene::SceneFile read_all(const StaticsArguments& options, bind::PolygonMesh& mesh, Phases& phases) {
  const Phases::Timer timer(phases, Phases::import);
  scene::SceneFile file = scene::read_scene(options.scene);
  if (!options.mesh.empty()) file.mesh = options.mesh;
  if (options.out.empty() && !mesh_meets(file)) file.mesh.clear();
  mesh = read_mesh(file);
  return file;
}

/// Where anchors move, they are followed to the end of the scene's duration.
StaticsOptions search_options(const StaticsArguments& options, const scene::SceneFile& file) {
  StaticsOptions out = options.statics;
  if (!out.first_load) out.first_load = file.statics.first_load;
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

OrderedJson wall_seconds(const Phases& phases) {
  OrderedJson out;
  for (const auto& [phase, seconds] : phases.named()) out[phase] = seconds;
  out["total"] = phases.total();
  return out;
}

OrderedJson summarize(const scene::SceneFile& file, const System& system, const Equilibrium& found) {
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
    out["supports"].push_back({{"anchor", file.anchor_places[a]},
                               {"force", tendril::runner::to_json(found.support[a])},
                               {"torque", tendril::runner::to_json(found.torque[a])}});
  out["steps"] = found.steps;
  out["iterations"] = found.iterations;
  out["factorisations"] = found.factorisations;
  out["units"] = file.units.empty() ? OrderedJson() : OrderedJson(file.units);
  out["curve_pairs"] = file.names;
  out["masses"] = system.node_count();
  out["twist_states"] = system.twist_count();
  out["left_out"] = system.left_out();
  return out;
}

/// The masses, the mesh and pictures of the state found.
/// \return  the names of the files
std::vector<std::string> write_state(const StaticsArguments& options, scene::SceneFile file,
                                     const Equilibrium& found, bind::PolygonMesh mesh, Phases& phases) {
  file.outputs = {found.state.time};
  file.panels = 1;
  const int threads = thread_count(options.threads);
  scene::SceneRun run(std::move(file), std::move(mesh), {.start = found.state, .threads = threads});
  Recorder recorder(run.file(), {options.out, true, options.double_precision}, phases);
  scene::Snapshot now = run.snapshot();
  // Under the share of the loads that the equilibrium is of; a run is under all of them.
  for (std::size_t a = 0; a < now.supports.size() && a < found.support.size(); ++a)
    now.supports[a] = {found.support[a], found.torque[a]};
  recorder.take(now, run.mesh());
  recorder.warn_of_spoilt("the equilibrium");
  recorder.write_trajectory();
  if (!options.no_pictures) {
    const Phases::Timer timer(phases, Phases::draw);
    draw_run(run, recorder, {.threads = threads}, [](double) { return !Interrupt::requested(); });
  }
  phases.take(run.seconds());
  return recorder.files();
}

void tell(const StaticsArguments& options, const OrderedJson& summary, const Equilibrium& found) {
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
    // What falls is followed by its energy.
    if (found.balance == Balance::unheld && !found.conservative)
      std::cerr << "tendril: what may help: with friction, or other forces without an energy, nothing is "
                   "followed to where it comes to rest; begin where it touches, leave friction out, or let "
                   "it run with damping\n";
  }
}

int statics(const StaticsArguments& options) {
  const Interrupt interrupt;
  Phases phases;
  bind::PolygonMesh mesh;
  const scene::SceneFile file = read_all(options, mesh, phases);
  // What the mesh meets is felt through its binding.
  std::optional<scene::SceneRun> bound;
  if (mesh_meets(file)) {
    scene::SceneFile from_rest = file;
    from_rest.start_at_equilibrium = false;
    from_rest.start_motions.clear();
    bound.emplace(std::move(from_rest), mesh, scene::RunOptions{.threads = thread_count(options.threads)});
    phases.take(bound->seconds());
  }
  std::optional<System> bare;
  const System& system = bound ? bound->system() : bare.emplace(scene::make_system(file));
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
    summary["files"] = write_state(options, file, found, std::move(mesh), phases);
    summary["wall_s"] = wall_seconds(phases);
    write_file_whole(options.out + "/summary.json", summary.dump(2) + "\n");
  }
  tell(options, summary, found);
  return found.balance == Balance::converged ? kDone : kNoSuccess;
}

}  // namespace

Command statics_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("statics", "Finds a scene's equilibrium, and says whether it is stable");
  const auto options = std::make_shared<StaticsArguments>();
  app->add_option("scene", options->scene, "scene file (JSON)")->required();
  app->add_option("--out", options->out, "folder for masses, mesh, pictures and summary of the equilibrium");
  app->add_option("--mesh", options->mesh, "mesh (OFF, PLY, OBJ, STL) to use instead of the scene's");
  app->add_option("--load", options->statics.last_load, "share of all forces, 1 by default");
  app->add_option(
      "--first-load", options->statics.first_load,
      "share of all forces at the start; by default the scene's, else 0, or all of them where nothing bends");
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
