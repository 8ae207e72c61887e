#include "commands.h"
#include "commands/mode.h"
#include "extras/extras.h"
#include "read/mesh_reader.h"
#include "rig/of_mesh.h"
#include "write/folder.h"
#include "write/interrupt.h"
#include "write/progress.h"
#include "write/recorder.h"
#include "write/run_pictures.h"

#include <tendril/base/file.h>
#include <tendril/base/number.h>
#include <tendril/scene/summary.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>

namespace tendril::runner {
namespace {

struct RunArguments {
  std::string scene, out, mesh;
  int threads = 0;
  ModeFlags mode;
  ExtraFlags extras;
  bool mark_ambiguous = false;
  bool no_frames = false, no_pictures = false, double_precision = false, json = false;
};

bool is_mesh(const std::string& path) {
  std::string type = std::filesystem::path(path).extension().string();
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return std::tolower(c); });
  return type == ".off" || type == ".ply" || type == ".obj" || type == ".stl";
}

/// A mesh in place of a scene gets one, as `tendril rig` makes it, beside what the run writes.
std::string scene_of_mesh(const RunArguments& options) {
  const std::string out = options.out + "/scene.json";
  RigOptions how;
  how.threads = thread_count(options.threads);
  const Rig rig = rig_mesh(read_mesh(options.scene), options.scene, {}, how);
  make_folder(options.out);
  write_rig(rig, options.scene, out, "tendril run " + options.scene);
  if (!options.json) tell(rig);
  return out;
}

scene::SceneFile read_all(const RunArguments& options, bind::PolygonMesh& mesh, Phases& phases) {
  const Phases::Timer timer(phases, Phases::import);
  scene::SceneFile file = scene::read_scene(is_mesh(options.scene) ? scene_of_mesh(options) : options.scene);
  if (!options.mesh.empty()) file.mesh = options.mesh;
  mesh = read_mesh(file);
  return file;
}

Report simulate(scene::SceneRun& scene, Recorder& recorder, Extras& extras, Phases& phases,
                Progress& progress) {
  return scene.run(
      [&](const scene::Snapshot& snapshot) {
        recorder.take(snapshot, scene.mesh());
        const Phases::Timer timer(phases, Phases::write);
        extras.take(snapshot);
      },
      [&](double part) {
        extras.note_step();
        progress.show("simulating", part);
        return !Interrupt::requested();
      });
}

void draw_all(const RunArguments& options, const scene::SceneRun& scene, Recorder& recorder, Extras& extras,
              Report& report, Phases& phases, Progress& progress) {
  const Phases::Timer timer(phases, Phases::draw);
  const PictureOptions how{thread_count(options.threads), options.mark_ambiguous};
  const auto go_on = [&](double part) {
    progress.show("drawing", part);
    return !Interrupt::requested();
  };
  const bool drawn =
      (options.no_pictures || draw_run(scene, recorder, how, go_on)) && extras.draw_film(how, go_on);
  if (drawn || report.stop != Stop::finished) return;
  report.stop = Stop::cancelled;
  report.reason = "cancelled while drawing";
}

/// The scene's name without folders and ending, as films are named.
std::string stem(const RunArguments& options) {
  return std::filesystem::path(options.scene).stem().string();
}

/// What a person may change in a scene whose run stopped; empty where the reason says it.
std::string what_helps(const Report& report, const SimulationOptions& options) {
  const std::string finer = options.fixed_step ? "a \"fixed_step\" below " + shortest(*options.fixed_step)
                                               : "a \"tolerance\" below " + shortest(options.tolerance);
  switch (report.stop) {
    case Stop::energy_lost:
    case Stop::energy_gained:
    case Stop::momentum_lost:
      return finer + ", or one that allows this; some damping";
    case Stop::not_evaluable:
    case Stop::step_underflow:
      return finer +
             "; a larger \"stiffness\" where contact could not stop what came; more nodes where a rod folds";
    case Stop::too_stiff:
      if (options.fixed_step) return finer;
      return options.method == Method::automatic ? "a larger \"work_limit\"" : "\"method\": \"automatic\"";
    case Stop::work_limit:
      return "a larger \"work_limit\"";
    default:
      return {};
  }
}

void tell(const RunArguments& options, const std::string& summary, const scene::SceneRun& scene,
          const Phases& phases, const Report& report) {
  if (options.json) {
    std::cout << summary << '\n';
  } else {
    std::cout << tendril::to_string(report.stop) << ": time " << report.time << ", " << report.accepted
              << " steps (and " << report.rejected << " rejected), " << report.evaluations << " evaluations, "
              << scene.outputs() << " outputs, " << phases.total() << " s\n"
              << options.out << '\n';
  }
  if (report.stop != Stop::finished) {
    std::cerr << "tendril: " << tendril::to_string(report.stop) << ": " << report.reason << '\n';
    const std::string helps = what_helps(report, scene.file().options);
    if (!helps.empty()) std::cerr << "tendril: what may help: " << helps << '\n';
  }
}

int run(const RunArguments& options) {
  check(options.extras);
  const Interrupt interrupt;
  const int threads = thread_count(options.threads);
  Phases phases;
  bind::PolygonMesh mesh;
  scene::SceneFile file = read_all(options, mesh, phases);
  bind::PolygonMesh look = options.extras.any_gltf() ? mesh : bind::PolygonMesh{};
  scene::SceneRun scene(std::move(file), std::move(mesh), {.mode = options.mode.mode(), .threads = threads});
  make_folder(options.out);

  Progress progress;
  Recorder recorder(scene.file(), {options.out, !options.no_frames, options.double_precision}, phases);
  Extras extras(options.extras, scene, std::move(look), stem(options), recorder, options.out);
  Report report = simulate(scene, recorder, extras, phases, progress);
  recorder.write_trajectory();
  {
    const Phases::Timer timer(phases, Phases::write);
    extras.finish(report);
  }
  if (recorder.taken() > 0 && report.stop != Stop::cancelled) {
    draw_all(options, scene, recorder, extras, report, phases, progress);
  }
  phases.take(scene.seconds());
  const std::string summary =
      extras.in(scene::summary_json(scene, report, {recorder.files(), phases.named(), recorder.spoilt()}));
  write_file_whole(options.out + "/summary.json", summary + "\n");
  tell(options, summary, scene, phases, report);
  extras.tell(options.json);
  recorder.warn_of_spoilt("the motion");
  if (const std::string left = recorder.left_over(); !left.empty())
    std::cerr << "tendril: note: " << options.out << " holds frames of another run, from " << left << " on\n";
  return report.stop == Stop::finished ? kDone : kNoSuccess;
}

void add_extras(CLI::App& app, ExtraFlags& extras) {
  app.add_flag("--vtk", extras.vtk,
               "write a time series for ParaView too, run.pvd: mesh, rods and contacts with fields");
  CLI::Option* gltf = app.add_flag("--gltf", extras.gltf,
                                   "write NAME.glb too: glTF 2.0, the mesh on a skin that follows the run");
  app.add_option("--gltf-tolerance", extras.gltf_tolerance,
                 "how far that skin may be off, over the mesh's size; more joints where it is small")
      ->check(CLI::PositiveNumber)
      ->needs(gltf);
  app.add_flag("--gltf-morph", extras.gltf_morph,
               "write NAME.glb with a morph target an output instead: exact, and large")
      ->excludes(gltf);
  app.add_option("--film", extras.film, "draw every output into this file, a picture that moves (APNG)");
  app.add_flag("--player", extras.player,
               "write NAME.html too, a page that plays the run; it needs no server");
}

}  // namespace

Command run_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("run", "Moves a scene's curve-pairs, and the mesh with them");
  const auto options = std::make_shared<RunArguments>();
  app->add_option("scene", options->scene,
                  "scene file (JSON); or a mesh (OFF, PLY, OBJ, STL), which `tendril rig` is asked for first")
      ->required();
  app->add_option("--out", options->out, "folder for what the run writes; made when it is not there")
      ->required();
  app->add_option("--mesh", options->mesh, "mesh (OFF, PLY, OBJ, STL) to use instead of the scene's");
  app->add_option("--threads", options->threads, "threads, 0 for all; results are the same");
  options->mode.add_to(*app);
  app->add_flag("--no-frames", options->no_frames, "write no frame_NNNN.ply");
  add_extras(*app, options->extras);
  app->add_flag("--no-pictures", options->no_pictures, "draw no pictures");
  app->add_flag("--mark-ambiguous", options->mark_ambiguous,
                "in pictures, color the points of the mesh that are bound to several places of the axes");
  app->add_flag("--double", options->double_precision, "frames in double instead of single precision");
  app->add_flag("--json", options->json, "print the summary as JSON");
  return {app, [options] { return run(*options); }};
}

}  // namespace tendril::runner
