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

#include <filesystem>
#include <iostream>

namespace tendril::runner {
namespace {

struct Options {
  std::string scene, out, mesh;
  int threads = 0;
  bool continuous = false, nearest = false, no_frames = false, no_pictures = false, double_precision = false,
       json = false;
};

SceneFile read_all(const Options& options, bind::PolygonMesh& mesh, Phases& phases) {
  const Phases::Timer timer(phases, Phases::import);
  SceneFile file = read_scene(options.scene);
  if (!options.mesh.empty()) file.mesh = options.mesh;
  if (!file.mesh.empty()) mesh = bind::read_mesh(file.mesh);
  if (!file.mesh.empty() && mesh.points.empty()) throw InvalidInput(file.mesh, "no points", "a mesh");
  return file;
}

/// A scene ready to run. Whatever is wrong with the input has been refused when it stands.
struct Prepared {
  Phases phases;
  bind::PolygonMesh mesh;
  SceneFile file;
  System system;
  Simulation simulation;
  std::optional<bind::Binding> binding;

  Prepared(const Options& options, int threads)
      : file(read_all(options, mesh, phases)),
        system(file.scene),
        simulation(system, system.rest_state(), file.options) {
    if (file.mesh.empty()) return;
    const Phases::Timer timer(phases, Phases::bind);
    const bind::BindMode mode = mode_of(file, options.continuous, options.nearest);
    binding.emplace(bind_scene(file, mesh, mode, threads));
  }
};

std::unique_ptr<Prepared> prepare(const Options& options, int threads) {
  try {
    return std::make_unique<Prepared>(options, threads);
  } catch (const InvalidInput& error) {
    // The library speaks of the scene's parts by their numbers; readers have named the file already.
    for (const char* part : {"rods", "joints", "anchors", "forces"}) {
      if (error.place().rfind(part, 0) == 0) throw in_scene(read_scene(options.scene), error);
    }
    throw;
  }
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw FileError(folder, error ? error.message() : "it is not a folder");
  }
}

Report simulate(Prepared& scene, Recorder& recorder, Progress& progress) {
  const Phases::Timer timer(scene.phases, Phases::simulate);
  scene.simulation.add(recorder, Simulation::When::output);
  scene.simulation.on_progress([&](double time) {
    progress.show("simulating", time / scene.file.duration);
    return !Interrupt::requested();
  });
  return scene.simulation.run(scene.file.duration, scene.file.outputs);
}

void draw_pictures(Prepared& scene, Recorder& recorder, Report& report, int threads, Progress& progress) {
  const Phases::Timer timer(scene.phases, Phases::draw);
  const bool drawn = draw_run(scene.file, scene.mesh, recorder, threads, [&](double part) {
    progress.show("drawing", part);
    return !Interrupt::requested();
  });
  if (drawn || report.stop != Stop::finished) return;
  report.stop = Stop::cancelled;
  report.reason = "cancelled while drawing";
}

void tell(const Options& options, const OrderedJson& summary, const Report& report) {
  if (options.json) {
    print(summary);
  } else {
    std::cout << tendril::to_string(report.stop) << ": time " << report.time << ", " << report.accepted
              << " steps (and " << report.rejected << " rejected), " << report.evaluations << " evaluations, "
              << summary["outputs"] << " outputs, " << summary["wall_s"]["total"].get<double>() << " s\n"
              << options.out << '\n';
  }
  if (report.stop != Stop::finished) {
    std::cerr << "tendril: " << tendril::to_string(report.stop) << ": " << report.reason << '\n';
  }
}

int run(const Options& options) {
  const Interrupt interrupt;
  const int threads = thread_count(options.threads);
  const std::unique_ptr<Prepared> scene = prepare(options, threads);
  make_folder(options.out);

  Progress progress;
  const bind::Binding* binding = scene->binding ? &*scene->binding : nullptr;
  Recorder recorder(scene->file, scene->system, scene->simulation, scene->mesh, binding,
                    {options.out, !options.no_frames, options.double_precision, threads}, scene->phases);
  Report report = simulate(*scene, recorder, progress);
  recorder.write_trajectory();
  if (!options.no_pictures && recorder.outputs() > 0 && report.stop != Stop::cancelled) {
    draw_pictures(*scene, recorder, report, threads, progress);
  }
  OrderedJson summary = summarize(scene->file, scene->system, scene->mesh, binding, report, recorder);
  summary["wall_s"] = wall_seconds(scene->phases);
  write_file_whole(options.out + "/summary.json", summary.dump(2) + "\n");
  tell(options, summary, report);
  return report.stop == Stop::finished ? kDone : kNoSuccess;
}

}  // namespace

Command run_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("run", "Moves a scene's curve-pairs, and the mesh with them");
  const auto options = std::make_shared<Options>();
  app->add_option("scene", options->scene, "scene file (JSON)")->required();
  app->add_option("--out", options->out, "folder for what the run writes; made when it is not there")
      ->required();
  app->add_option("--mesh", options->mesh, "OFF or PLY file to use instead of the scene's");
  app->add_option("--threads", options->threads, "threads, 0 for all; results are the same");
  app->add_flag("--continuous", options->continuous,
                "bind to one curve-pair, too, without tears where the nearest point jumps");
  app->add_flag("--nearest", options->nearest,
                "bind to several curve-pairs, too, by the nearest point alone");
  app->add_flag("--no-frames", options->no_frames, "write no frame_NNNN.ply");
  app->add_flag("--no-pictures", options->no_pictures, "draw no pictures");
  app->add_flag("--double", options->double_precision, "frames in double instead of single precision");
  app->add_flag("--json", options->json, "print the summary as JSON");
  return {app, [options] { return run(*options); }};
}

}  // namespace tendril::runner
