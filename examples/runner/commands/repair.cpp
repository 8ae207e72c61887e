#include "commands.h"
#include "read/mesh_reader.h"
#include "write/json_output.h"

#include <tendril/bind/repair.h>

#include <iostream>

namespace tendril::runner {
namespace {

struct RepairArguments {
  std::string mesh, out;
  bool keep_points = false, keep_degenerate = false, keep_duplicates = false, keep_orientation = false,
       keep_isolated = false, json = false;
  double merge_distance = 0.0;
};

std::vector<std::uint32_t> dropped(const std::vector<std::uint32_t>& now) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < now.size(); ++i)
    if (now[i] == bind::kDropped) ids.push_back(i);
  return ids;
}

/// Pairs of a point before that merged and the point now that it is part of.
OrderedJson merged(const std::vector<std::uint32_t>& now, std::size_t count) {
  OrderedJson pairs = OrderedJson::array();
  std::vector<char> taken(count, 0);
  for (std::uint32_t i = 0; i < now.size(); ++i) {
    if (now[i] == bind::kDropped) continue;
    if (taken[now[i]]) pairs.push_back({{"id", i}, {"now", now[i]}});
    taken[now[i]] = 1;
  }
  return pairs;
}

/// What is still odd, by check's names; only what there is of it.
OrderedJson left(const bind::MeshReport& report) {
  OrderedJson out = OrderedJson::object();
  const auto count = [&](const char* name, std::size_t n) {
    if (n > 0) out[name] = n;
  };
  count("duplicate_points", report.duplicate_points.size());
  count("isolated_points", report.isolated_points.size());
  count("degenerate_faces", report.degenerate_faces.size());
  count("duplicate_faces", report.duplicate_faces.size());
  count("non_manifold_edges", report.non_manifold_edges.size());
  count("non_manifold_points", report.non_manifold_points.size());
  count("inconsistent_edges", report.inconsistent_edges.size());
  count("inside_out", report.inside_out);
  count("holes", report.boundary_loops);
  return out;
}

OrderedJson to_json(const bind::Repaired& repaired) {
  OrderedJson edges = OrderedJson::array();
  for (const bind::Edge& edge : repaired.one_sided) edges.push_back(edge);
  return {{"changed", repaired.changed()},
          {"points", repaired.mesh.points.size()},
          {"faces", repaired.mesh.face_count()},
          {"merged_points", merged(repaired.point, repaired.mesh.points.size())},
          {"dropped_points", dropped(repaired.point)},
          {"dropped_faces", dropped(repaired.face)},
          {"shortened_faces", repaired.shortened},
          {"turned_faces", repaired.turned},
          {"one_sided_edges", edges},
          {"left", left(repaired.left)}};
}

int run(const RepairArguments& options) {
  const bind::PolygonMesh mesh = read_mesh(options.mesh);
  const bind::Repaired repaired = bind::repair(mesh, {.merge_points = !options.keep_points,
                                                      .drop_degenerate = !options.keep_degenerate,
                                                      .drop_duplicates = !options.keep_duplicates,
                                                      .orient = !options.keep_orientation,
                                                      .drop_isolated = !options.keep_isolated,
                                                      .merge_distance = options.merge_distance});
  save_mesh(options.out, repaired.mesh);
  const OrderedJson what = to_json(repaired);
  if (options.json) {
    print(what);
    return kDone;
  }
  std::cout << options.out << ": " << what["points"] << " points, " << what["faces"] << " faces\n";
  for (const char* list : {"merged_points", "dropped_points", "dropped_faces", "shortened_faces",
                           "turned_faces", "one_sided_edges"})
    if (!what[list].empty()) std::cout << "  " << what[list].size() << ' ' << list << '\n';
  for (const auto& [name, count] : what["left"].items())
    std::cout << "  left: " << count << ' ' << name << '\n';
  return kDone;
}

}  // namespace

Command repair_command(CLI::App& parent) {
  auto* app =
      parent.add_subcommand("repair", "Mends what check finds odd about a mesh, and says what it did");
  const auto options = std::make_shared<RepairArguments>();
  app->add_option("mesh", options->mesh, "OFF, PLY, OBJ or STL file")->required();
  app->add_option("--out", options->out, "OFF or PLY file to write")->required();
  auto* keep = app->add_flag("--keep-points", options->keep_points, "merge no points of the same place");
  app->add_option("--merge-distance", options->merge_distance,
                  "merge points as near as this share of the mesh's size, at most 0.01")
      ->excludes(keep);
  app->add_flag("--keep-degenerate", options->keep_degenerate, "keep faces without area");
  app->add_flag("--keep-duplicates", options->keep_duplicates, "keep faces of the same points");
  app->add_flag("--keep-orientation", options->keep_orientation, "turn no face over");
  app->add_flag("--keep-isolated", options->keep_isolated, "keep points in no face");
  app->add_flag("--json", options->json, "print JSON, with the ids before and now of all that changed");
  return {app, [options] { return run(*options); }};
}

}  // namespace tendril::runner
