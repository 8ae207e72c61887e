#include "commands.h"
#include "draw/drawing.h"
#include "read/mesh_reader.h"
#include "write/json_output.h"

#include <tendril/axis/find_axis.h>
#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <chrono>
#include <cstdio>
#include <iostream>

namespace tendril::runner {
namespace {

struct AxisArguments {
  std::string mesh, out, picture, up = "y";
  axis::AxisOptions find;
  scene::ViewOptions view;
  int threads = 0;
  bool json = false;
};

std::string name_of(std::size_t curve) {
  return curve == 0 ? "axis" : "branch_" + std::to_string(curve);
}

OrderedJson to_json(const std::vector<Vec3>& points) {
  OrderedJson out = OrderedJson::array();
  for (const Vec3& p : points) out.push_back(runner::to_json(p));
  return out;
}

OrderedJson to_json(const axis::AxisJoint& joint) {
  return {{"curve_pair", name_of(joint.parent)}, {"node", joint.node}};
}

/// One curve-pair a line, so that the file can be looked through.
std::string file_text(const axis::AxisTree& tree) {
  std::string text = "{\"version\": 1, \"curves\": [";
  for (std::size_t k = 0; k < tree.curves.size(); ++k) {
    const axis::AxisCurve& curve = tree.curves[k];
    OrderedJson one{{"name", name_of(k)}};
    if (curve.joint) one["joint"] = to_json(*curve.joint);
    one["points"] = to_json(curve.points);
    one["orientation"] = to_json(curve.orientation);
    one["radius"] = curve.radius;
    text += (k == 0 ? "\n" : ",\n") + one.dump();
  }
  return text + "\n]}\n";
}

OrderedJson to_json(const axis::AxisReport& report) {
  OrderedJson twigs = OrderedJson::array();
  for (const axis::Twig& twig : report.twigs)
    twigs.push_back({{"root", runner::to_json(twig.root)},
                     {"tip", runner::to_json(twig.tip)},
                     {"length", twig.length},
                     {"reach", twig.reach}});
  return {{"closed_holes", report.closed_holes},
          {"split_points", report.split_points},
          {"left_out_parts", report.left_out_parts},
          {"turned", report.turned},
          {"splits", report.splits},
          {"contractions", report.contractions},
          {"skeleton", {{"ends", report.ends}, {"junctions", report.junctions}, {"loops", report.loops}}},
          {"cuts", to_json(report.cuts)},
          {"coverage", report.coverage},
          {"farthest", runner::to_json(report.farthest)},
          {"farthest_radii", report.farthest_radii},
          {"twigs", twigs}};
}

OrderedJson to_json(const axis::AxisTree& tree, double seconds) {
  OrderedJson curves = OrderedJson::array();
  for (std::size_t k = 0; k < tree.curves.size(); ++k) {
    const axis::AxisCurve& curve = tree.curves[k];
    curves.push_back({{"name", name_of(k)},
                      {"joint", curve.joint ? to_json(*curve.joint) : OrderedJson()},
                      {"nodes", curve.points.size()},
                      {"length", curve.length},
                      {"strays", curve.strays},
                      {"outside", curve.outside},
                      {"folds", curve.folds}});
  }
  return {{"status", axis::to_string(tree.status)},
          {"reason", tree.reason},
          {"curves", curves},
          {"report", to_json(tree.report)},
          {"wall_s", seconds}};
}

void tell(const AxisArguments& options, const axis::AxisTree& tree, double seconds) {
  const axis::AxisReport& report = tree.report;
  std::printf("%s: %zu curve(s), %zu loop(s), %zu twig(s) pruned, %.2f s\n", options.mesh.c_str(),
              tree.curves.size(), report.loops, report.twigs.size(), seconds);
  if (report.closed_holes + report.split_points + report.left_out_parts > 0)
    std::printf("  in a copy: %zu hole(s) closed, %zu point(s) split, %zu part(s) left out\n",
                report.closed_holes, report.split_points, report.left_out_parts);
  std::printf(
      "  %.3g %% of the skin within three radii of a curve, the farthest at %.3g radii: %.3g %.3g %.3g\n",
      100.0 * report.coverage, report.farthest_radii, report.farthest.x(), report.farthest.y(),
      report.farthest.z());
  if (report.turned) std::printf("  the mesh is inside out: a copy was turned\n");
  for (std::size_t k = 0; k < tree.curves.size(); ++k) {
    const axis::AxisCurve& curve = tree.curves[k];
    std::printf("  %-10s %4zu nodes, length %-8.4g strays %.2f radii, %zu outside", name_of(k).c_str(),
                curve.points.size(), curve.length, curve.strays, curve.outside);
    if (curve.folds) std::printf(", folds back");
    if (curve.joint)
      std::printf(", from node %zu of %s", curve.joint->node, name_of(curve.joint->parent).c_str());
    std::printf("\n");
  }
}

void draw_tree(const AxisArguments& options, const bind::PolygonMesh& mesh, const axis::AxisTree& tree) {
  CameraFit fit(options.view);
  fit.include(mesh.points);
  Drawing drawing{&mesh, {}, {}};
  for (const axis::AxisCurve& curve : tree.curves)
    for (Strand& strand : axis_strands(axis::pair_of(curve), curve.points, 0.0025 * fit.camera().size))
      drawing.over.push_back(std::move(strand));
  Picture picture = draw(drawing, fit.camera(), options.view, thread_count(options.threads));
  for (std::size_t k = 0; k < tree.curves.size(); ++k)
    name_axis(picture, fit.camera(), axis::pair_of(tree.curves[k]), name_of(k));
  write_file_whole(options.picture, png_bytes(picture));
}

int find(const AxisArguments& options) {
  require_other_file("--picture", options.picture, options.out);
  const bind::PolygonMesh mesh = read_mesh(options.mesh);
  const auto start = std::chrono::steady_clock::now();
  axis::AxisTree tree;
  try {
    tree = axis::find_axis(mesh, options.find);
  } catch (const InvalidInput& error) {
    if (error.place() != "mesh") throw;
    throw InvalidInput(options.mesh, error.reason(), error.expected() + " (--close, --largest-part)");
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!tree.curves.empty()) {
    write_file_whole(options.out, file_text(tree));
    if (!options.picture.empty()) draw_tree(options, mesh, tree);
  }
  if (options.json) {
    print(to_json(tree, seconds));
  } else if (!tree.curves.empty()) {
    tell(options, tree, seconds);
  }
  if (tree.status == axis::AxisStatus::found) return kDone;
  std::cerr << "tendril: " << axis::to_string(tree.status) << ": " << tree.reason << '\n';
  return kNoSuccess;
}

}  // namespace

Command axis_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("axis", "Finds a tree of curve-pairs along the middle of a closed mesh");
  const auto options = std::make_shared<AxisArguments>();
  axis::AxisOptions& how = options->find;
  app->add_option("mesh", options->mesh, "OFF, PLY, OBJ or STL file")->required();
  app->add_option("--out", options->out, "curve file (JSON) to write")->required();
  app->add_flag("--close", how.close, "close holes in a copy of the mesh");
  app->add_flag("--largest-part", how.largest_part, "take the part with the largest area");
  app->add_option("--prune", how.prune, "how far a limb reaches, in distances to the surface where it starts")
      ->capture_default_str();
  app->add_option("--spacing", how.spacing, "between the nodes of the curves, about");
  app->add_option("--tolerance", how.tolerance, "of the fit, in distances to the surface")
      ->capture_default_str();
  app->add_option("--time-limit", how.time_limit, "seconds")->capture_default_str();
  expect_png(app->add_option("--picture", options->picture, "PNG file: the mesh with the curves"));
  app->add_option("--yaw", options->view.yaw, "degrees, of the picture")->capture_default_str();
  app->add_option("--pitch", options->view.pitch, "degrees, of the picture")->capture_default_str();
  app->add_option("--up", options->up, "the axis that points up in it: x, y, z, -x, -y, -z")
      ->capture_default_str();
  app->add_option("--threads", options->threads, "threads for the picture, 0 for all");
  app->add_flag("--json", options->json, "print JSON");
  return {app, [options] {
            options->view.up = up_direction(options->up);
            return find(*options);
          }};
}

}  // namespace tendril::runner
