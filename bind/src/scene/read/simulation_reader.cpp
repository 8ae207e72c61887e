#include "scene/read/simulation_reader.h"

#include "scene/read/curve_reader.h"

#include <tendril/scene/output_times.h>

namespace tendril::scene {
namespace {

constexpr long kMostFrames = 10000;

std::vector<double> read_outputs(const JsonNode& simulation, double duration) {
  if (simulation.has("output_every") && simulation.has("frames")) {
    simulation.refuse("output_every and frames", "one of them, not both");
  }
  if (simulation.has("output_every")) {
    const JsonNode every = simulation.at("output_every");
    const double step = every.positive();
    if (!(duration / step + 1.0 <= static_cast<double>(kMostFrames)))
      every.refuse("more than " + std::to_string(kMostFrames) + " frames in the run", "a larger step");
    return output_times_every(duration, step);
  }
  const long frames = simulation.has("frames") ? simulation.at("frames").integer(2, kMostFrames) : 101;
  return output_times(duration, static_cast<std::size_t>(frames));
}

/// A method that chooses its own steps is given none; every other one needs one.
void read_method(const JsonNode& simulation, SimulationOptions& options) {
  const std::string name = simulation.text_or("method", to_string(options.method));
  const MethodInfo* row = find_method(name);
  if (row == nullptr) {
    std::string known;
    for (const MethodInfo& one : methods())
      known += (known.empty() ? "one of: \"" : ", \"") + std::string(one.name) + '"';
    simulation.at("method").refuse('"' + name + "\" is not one of the choices", known);
  }
  options.method = row->method;
  if (!chooses_steps(options.method)) {
    options.fixed_step = simulation.at("fixed_step").positive();
  } else if (simulation.has("fixed_step")) {
    simulation.at("fixed_step")
        .refuse("a step for " + name, "a method of fixed step: " + name + " chooses its own");
  }
}

/// Up is against gravity, where the scene does not say.
void choose_up(const JsonNode& file, ViewOptions& view) {
  if (!file.has("forces")) return;
  for (std::size_t i = 0; i < file.at("forces").size(); ++i) {
    const JsonNode force = file.at("forces").at(i);
    if (!force.has("acceleration") || !(force.at("acceleration").vec3().stableNorm() > 0.0)) continue;
    view.up = -force.at("acceleration").vec3().stableNormalized();
    return;
  }
}

void read_picture_options(const JsonNode& picture, SceneFile& out) {
  ViewOptions& view = out.view;
  if (picture.has("up")) {
    const Vec3 up = picture.at("up").vec3();
    if (!(up.stableNorm() > 0.0)) picture.at("up").refuse("no direction", "a vector that is not zero");
    view.up = up.stableNormalized();
  }
  view.yaw = picture.number_or("yaw", view.yaw);
  view.pitch = picture.number_or("pitch", view.pitch);
  if (picture.has("size")) {
    view.width = static_cast<int>(picture.at("size").at(0).integer(16, 8192));
    view.height = static_cast<int>(picture.at("size").at(1).integer(16, 8192));
  }
  if (picture.has("samples")) view.samples = static_cast<int>(picture.at("samples").integer(1, 1024));
  if (picture.has("panels")) out.panels = static_cast<int>(picture.at("panels").integer(1, 100));
  if (picture.has("axis")) out.draw_axis = picture.at("axis").value().get<bool>();
}

}  // namespace

void read_simulation(const JsonNode& simulation, SceneFile& out) {
  out.duration = simulation.at("duration").positive();
  out.outputs = read_outputs(simulation, out.duration);
  SimulationOptions& options = out.options;
  options.tolerance = simulation.number_or("tolerance", options.tolerance);
  read_method(simulation, options);
  if (simulation.has("degree"))
    options.degree = static_cast<int>(simulation.at("degree").integer(1, kMaxDegree));
  options.parametrisation = read_parametrisation(simulation);
  out.supports = simulation.has("supports") && simulation.at("supports").value().get<bool>();
  if (simulation.has("work_limit")) options.work_limit = simulation.at("work_limit").integer(1, 1L << 52);
}

void read_statics(const JsonNode& statics, SceneFile& out) {
  if (statics.has("first_load")) out.statics.first_load = statics.at("first_load").number();
}

void read_picture(const JsonNode& file, SceneFile& out) {
  choose_up(file, out.view);
  if (file.has("picture")) read_picture_options(file.at("picture"), out);
}

}  // namespace tendril::scene
