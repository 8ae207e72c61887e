#include "commands.h"
#include "read/mesh_reader.h"
#include "write/json_output.h"

#include <tendril/bind/import.h>
#include <tendril/bind/inspect.h>

#include <iostream>

namespace tendril::runner {
namespace {

struct CheckArguments {
  std::string mesh;
  bool json = false, strict = false;
};

OrderedJson duplicates(const std::vector<bind::Duplicate>& list) {
  OrderedJson out = OrderedJson::array();
  for (const bind::Duplicate& one : list) out.push_back({{"id", one.id}, {"first", one.first}});
  return out;
}

OrderedJson to_json(const bind::PolygonMesh& mesh, const bind::MeshReport& report) {
  return {{"points", report.points},
          {"faces", report.faces},
          {"triangles", report.triangles},
          {"largest_degree", report.largest_degree},
          {"edges", report.edges},
          {"low", runner::to_json(report.low)},
          {"high", runner::to_json(report.high)},
          {"point_normals", !mesh.point_normals.empty()},
          {"point_colors", !mesh.point_colors.empty()},
          {"face_colors", !mesh.face_colors.empty()},
          {"point_texture", !mesh.point_texture.empty()},
          {"corner_texture", !mesh.corner_texture.empty()},
          {"components", report.components},
          {"boundary_edges", report.boundary_edges},
          {"boundary_loops", report.boundary_loops},
          {"euler_characteristic", report.euler_characteristic},
          {"closed", report.faces > 0 && report.is_closed()},
          {"manifold", report.is_manifold()},
          {"oriented", report.is_oriented()},
          {"duplicate_points", duplicates(report.duplicate_points)},
          {"duplicate_faces", duplicates(report.duplicate_faces)},
          {"isolated_points", report.isolated_points},
          {"degenerate_faces", report.degenerate_faces},
          {"non_manifold_edges", report.non_manifold_edges},
          {"non_manifold_points", report.non_manifold_points},
          {"inconsistent_edges", report.inconsistent_edges},
          {"inside_out", report.inside_out}};
}

void print_text(const std::string& path, const bind::MeshReport& r) {
  const auto yes = [](bool is, const char* what) { return std::string(is ? "" : "not ") + what; };
  std::cout << path << ": " << r.points << " points, " << r.faces << " faces (" << r.triangles
            << " triangles), " << r.edges << " edges\n";
  if (r.faces == 0)
    std::cout << "  no faces: points alone\n";
  else
    std::cout << "  " << r.components << " component(s), " << r.boundary_loops << " hole(s), "
              << yes(r.is_closed(), "closed") << ", " << yes(r.is_manifold(), "manifold") << ", "
              << yes(r.is_oriented(), "consistently oriented") << "\n";
  std::cout << "  box " << r.low.transpose() << "  to  " << r.high.transpose() << '\n';
  const auto count = [](std::size_t n, const char* what) {
    if (n > 0) std::cout << "  " << n << ' ' << what << '\n';
  };
  count(r.duplicate_points.size(), "duplicate point(s)");
  count(r.isolated_points.size(), "isolated point(s)");
  count(r.degenerate_faces.size(), "degenerate face(s)");
  count(r.duplicate_faces.size(), "duplicate face(s)");
  count(r.non_manifold_edges.size(), "non-manifold edge(s)");
  count(r.non_manifold_points.size(), "non-manifold point(s)");
  count(r.inconsistent_edges.size(), "edge(s) used twice in the same direction");
  count(r.inside_out, "closed part(s) inside out");
}

int check(const CheckArguments& options) {
  const bind::PolygonMesh mesh = options.strict ? bind::read_mesh(options.mesh) : read_mesh(options.mesh);
  const bind::MeshReport report = bind::inspect(mesh);
  if (options.json) {
    print(to_json(mesh, report));
  } else {
    print_text(options.mesh, report);
  }
  return kDone;
}

}  // namespace

Command check_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("check", "What a mesh file holds, and what is odd about it");
  const auto options = std::make_shared<CheckArguments>();
  app->add_option("mesh", options->mesh, "OFF, PLY, OBJ or STL file")->required();
  app->add_flag("--json", options->json, "print JSON, with the ids of all that is odd");
  app->add_flag("--strict", options->strict, "refuse what is read with a note otherwise");
  return {app, [options] { return check(*options); }};
}

}  // namespace tendril::runner
