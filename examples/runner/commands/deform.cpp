#include "commands.h"
#include "commands/mode.h"
#include "read/axes.h"
#include "read/mesh_reader.h"
#include "write/json_output.h"

#include <tendril/base/file.h>
#include <tendril/bind/distortion.h>
#include <tendril/bind/inspect.h>
#include <tendril/curve/equal_length.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>

namespace tendril::runner {
namespace {

constexpr double kMuchVolume = 0.1;  // of it: a change that is said

struct DeformArguments {
  std::string mesh, axis, pose, out;
  ModeFlags mode;
  bool equal_length = false, json = false;
  int threads = 0;
  double band = bind::BindOptions{}.band;
};

/// The weighted sum over a point's shares, each at the same length along its posed axis as at rest.
void deform_at_equal_length(const bind::Binding& binding, const Axes& axes, MutablePoints out) {
  std::vector<ArcLength> rest, posed;
  for (std::size_t k = 0; k < axes.rest.size(); ++k) {
    rest.emplace_back(axes.rest[k].primary());
    posed.emplace_back(axes.posed[k].primary());
  }
  const auto at = [&](const bind::Share& share) {
    const std::uint32_t k = share.pair;
    return from_axial(axes.posed[k], at_equal_length(rest[k], posed[k], share.record));
  };
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::vector<bind::Share> shares = binding.shares(i);
    const Vec3 first = at(shares.front());
    out[i] = first;
    for (std::size_t k = 1; k < shares.size(); ++k) out[i] += shares[k].weight * (at(shares[k]) - first);
  }
}

/// What the pose spoils, in a sentence; nothing where that is nothing.
void warn(const std::string& out, const bind::Distortion& d) {
  if (d.zones.empty()) return;
  std::fprintf(stderr,
               "tendril: note: %s: the pose spoils %s; a wider --band spreads a steep place, 'tendril bind' "
               "tells it from a tear\n",
               out.c_str(), describe(d).c_str());
}

/// What a mesh encloses, where it is closed.
std::optional<double> volume_of(const bind::PolygonMesh& mesh) {
  if (!bind::inspect(mesh).is_closed()) return {};
  double six = 0.0;
  const Vec3 from = mesh.points.front();
  for (const auto& [a, b, c] : bind::fan_triangles(mesh))
    six += (mesh.points[a] - from).dot((mesh.points[b] - from).cross(mesh.points[c] - from));
  return six / 6.0;
}

/// Bends keep volume but for what is stretched; edges that are long against a bend cut across it.
void warn_of_volume(const std::string& out, std::optional<double> before, std::optional<double> now) {
  if (!before || !now || !(std::abs(*now - *before) > kMuchVolume * std::abs(*before))) return;
  std::fprintf(
      stderr,
      "tendril: note: %s: the volume went to %.2g of what it was: the pose stretches or crushes it, or "
      "the mesh is too coarse to bend like that, with edges that are long against the bend\n",
      out.c_str(), *now / *before);
}

void tell(const DeformArguments& options, const bind::BindReport& report, const bind::Distortion& distortion,
          std::size_t points) {
  if (options.json) {
    print({{"mesh", options.out},
           {"points", points},
           {"rest_error", report.rest_error},
           {"largest_gap", report.largest_gap},
           {"beyond_ends", report.beyond_ends},
           {"ambiguous", runner::to_json(report.ambiguous)},
           {"past_focus", runner::to_json(report.past_focus)},
           {"degenerate", runner::to_json(report.degenerate)},
           {"distortion", runner::to_json(distortion)}});
  } else {
    std::cout << options.out << ": " << points << " points; " << report.beyond_ends << " beyond the ends, "
              << report.past_focus.size() << " past the focus, rest error " << report.rest_error << '\n';
  }
}

int deform(const DeformArguments& options) {
  const int threads = thread_count(options.threads);
  bind::PolygonMesh mesh = read_mesh(options.mesh);
  const Axes axes =
      read_axes({options.axis}, {options.pose}, options.equal_length ? "" : "the same, or --equal-length");
  const bind::Binding binding(axes.rest, mesh,
                              {.mode = options.mode.mode(), .band = options.band, .threads = threads});
  const std::optional<double> before = volume_of(mesh);
  std::vector<Vec3> points(mesh.points.size());
  if (options.equal_length) {
    deform_at_equal_length(binding, axes, points);
  } else {
    binding.update(axes.posed, points, threads);
  }
  const bind::Distortion distortion = bind::measure_distortion(binding, axes.rest, mesh, axes.posed, points);
  if (!mesh.point_normals.empty()) mesh.point_normals = bind::posed_normals(mesh, points);
  mesh.points = std::move(points);
  save_mesh(options.out, mesh);
  warn(options.out, distortion);
  warn_of_volume(options.out, before, volume_of(mesh));
  if (binding.report().beyond_ends == mesh.points.size())
    std::fprintf(
        stderr,
        "tendril: note: %s: all of it is beyond the ends of the axis: are both in the same place, and "
        "in the same unit?\n",
        options.out.c_str());
  tell(options, binding.report(), distortion, mesh.points.size());
  return kDone;
}

}  // namespace

Command deform_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("deform", "Deforms a mesh by posing its axis");
  const auto options = std::make_shared<DeformArguments>();
  app->add_option("mesh", options->mesh, "OFF, PLY, OBJ or STL file")->required();
  app->add_option("--axis", options->axis, "curve file (JSON) of one or several curve-pairs at rest")
      ->required();
  app->add_option("--pose", options->pose, "curve file (JSON) of the same posed")->required();
  app->add_option("--out", options->out, "PLY or OFF file to write")->required();
  options->mode.add_to(*app);
  app->add_option("--band", options->band,
                  "width of transitions, in distances to the axis; a wider one folds less")
      ->capture_default_str()
      ->excludes("--nearest");
  app->add_flag("--equal-length", options->equal_length, "keep lengths along the axis");
  app->add_option("--threads", options->threads, "threads, 0 for all; the result is the same");
  app->add_flag("--json", options->json, "print JSON");
  return {app, [options] { return deform(*options); }};
}

}  // namespace tendril::runner
