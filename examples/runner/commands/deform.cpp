#include "commands.h"
#include "read/axes.h"
#include "read/mesh_reader.h"
#include "write/json_output.h"

#include <tendril/base/file.h>
#include <tendril/bind/binding.h>
#include <tendril/bind/export.h>
#include <tendril/curve/equal_length.h>

#include <iostream>

namespace tendril::runner {
namespace {

struct Options {
  std::string mesh, axis, pose, out;
  bool equal_length = false, continuous = false, json = false;
  int threads = 0;
};

/// The curve-pairs at rest and posed, one for one. At equal length their knots need not agree.
Axes axes_of(const Options& options) {
  if (!options.equal_length) return read_axes({options.axis}, {options.pose}, "the same, or --equal-length");
  Axes axes;
  const std::vector<scene::CurveFile> rest = scene::read_curves(options.axis);
  for (const scene::CurveFile& curve : rest) axes.rest.push_back(curve.pair);
  for (const scene::CurveFile& curve : scene::read_curves(options.pose, rest))
    axes.posed.push_back(curve.pair);
  return axes;
}

void deform_at_equal_length(const bind::Binding& binding, const Axes& axes, MutablePoints out) {
  std::vector<ArcLength> rest, posed;
  for (std::size_t k = 0; k < axes.rest.size(); ++k) {
    rest.emplace_back(axes.rest[k].primary());
    posed.emplace_back(axes.posed[k].primary());
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint32_t k = binding.pair_of(i);
    out[i] = from_axial(axes.posed[k], at_equal_length(rest[k], posed[k], binding.records()[i]));
  }
}

int deform(const Options& options) {
  if (options.equal_length && options.continuous)
    throw InvalidInput("--equal-length", "with --continuous", "one of the two");
  const int threads = thread_count(options.threads);
  bind::PolygonMesh mesh = read_mesh(options.mesh);
  const Axes axes = axes_of(options);
  const auto mode = options.continuous ? bind::BindMode::continuous : bind::BindMode::nearest;
  const bind::Binding binding(axes.rest, mesh, {.mode = mode, .threads = threads});
  if (options.equal_length) {
    deform_at_equal_length(binding, axes, mesh.points);
  } else {
    binding.update(axes.posed, mesh.points, threads);
  }
  mesh.point_normals.clear();
  bind::write_mesh(options.out, mesh);

  const bind::BindReport& report = binding.report();
  if (options.json) {
    print({{"mesh", options.out},
           {"points", mesh.points.size()},
           {"rest_error", report.rest_error},
           {"largest_gap", report.largest_gap},
           {"beyond_ends", report.beyond_ends},
           {"ambiguous", report.ambiguous},
           {"past_focus", report.past_focus},
           {"degenerate", report.degenerate}});
  } else {
    std::cout << options.out << ": " << mesh.points.size() << " points; " << report.beyond_ends
              << " beyond the ends, " << report.past_focus.size() << " past the focus, rest error "
              << report.rest_error << '\n';
  }
  return kDone;
}

}  // namespace

Command deform_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("deform", "Deforms a mesh by posing its axis");
  const auto options = std::make_shared<Options>();
  app->add_option("mesh", options->mesh, "OFF or PLY file")->required();
  app->add_option("--axis", options->axis, "curve file (JSON) of one or several curve-pairs at rest")
      ->required();
  app->add_option("--pose", options->pose, "curve file (JSON) of the same posed")->required();
  app->add_option("--out", options->out, "PLY or OFF file to write")->required();
  app->add_flag("--continuous", options->continuous, "bind without tears where the nearest point jumps");
  app->add_flag("--equal-length", options->equal_length, "keep lengths along the axis");
  app->add_option("--threads", options->threads, "threads, 0 for all; the result is the same");
  app->add_flag("--json", options->json, "print JSON");
  return {app, [options] { return deform(*options); }};
}

}  // namespace tendril::runner
