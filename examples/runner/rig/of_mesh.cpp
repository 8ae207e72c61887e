#include "rig/of_mesh.h"

#include "rig/refine.h"

#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/scene/curve_file.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace tendril::runner {
namespace {

std::vector<RigCurve> read_rig_curves(const std::string& path) {
  std::vector<RigCurve> out;
  for (const scene::CurveFile& file : scene::read_curves(path)) {
    if (!file.through)
      throw InvalidInput(file.place, "control points", "a chain of points, which become the rod's masses");
    RigCurve curve{file.name.empty() ? "curve_" + std::to_string(out.size()) : file.name, file.masses, {}};
    for (const double t : file.through->parameters())
      curve.orientation.push_back(file.pair.orientation().value(t));
    if (file.joint) curve.joint = {file.joint->parent, file.joint->node};
    out.push_back(std::move(curve));
  }
  return out;
}

}  // namespace

Rig rig_mesh(const bind::PolygonMesh& mesh, const std::string& path, const RigAxes& axes,
             const RigOptions& options) {
  check(options);  // before axes are looked for, which takes its time
  std::string doubt;
  std::vector<RigCurve> curves =
      axes.file.empty() ? find_curves(mesh, path, axes, doubt) : read_rig_curves(axes.file);
  try {
    // Other parts are bound to the axes of the largest, but are no sections of it.
    Rig rig = make_rig(axes.largest_part ? largest_part(mesh) : mesh, std::move(curves), options);
    rig.doubt = std::move(doubt);
    return rig;
  } catch (const InvalidInput& error) {
    if (error.place().rfind("points[", 0) == 0)
      throw InvalidInput(path + ": " + error.place(), error.reason(), error.expected());
    if (error.place() != "mesh") throw;
    throw InvalidInput(path, error.reason(), error.expected());
  }
}

void write_rig(const Rig& rig, const std::string& mesh, const std::string& out, const std::string& command) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(out).lexically_normal().parent_path();
  write_file_whole(out, scene_text(rig, fs::proximate(fs::absolute(mesh), folder).string(), command));
}

void tell(const Rig& rig) {
  std::size_t nodes = 0, unseen = 0;
  for (const auto& sections : rig.body.sections) {
    nodes += sections.size();
    for (const RigSection& s : sections) unseen += s.seen ? 0 : 1;
  }
  std::printf("%zu curve-pair(s), %zu nodes; sections measured at %zu, taken from others at %zu\n",
              rig.curves.size(), nodes, nodes - unseen, unseen);
  if (!rig.doubt.empty()) std::printf("in doubt: %s\n", rig.doubt.c_str());
  std::printf("%s, %.3g kg, %.3g m large%s: a unit of the mesh is %.3g m\n", rig.material.name, rig.mass,
              rig.size, rig.size_given ? "" : " (guessed)", rig.unit);
  std::printf("up: %s%s; held: %s", direction_name(rig.stance.up).c_str(), rig.up_guessed ? " (guessed)" : "",
              rig.held_as.c_str());
  for (const Held& h : rig.held)
    std::printf(" %s[%zu..%zu]", rig.curves[h.curve].name.c_str(), h.first, h.last);
  std::printf("\nslowest limb: %s, a period of about %.3g s; limbs sag by up to %.2g %% of their length\n",
              rig.load.slowest.c_str(), rig.load.period, 100.0 * rig.load.sag);
  if (std::isfinite(rig.load.carries))
    std::printf("legs carry about %.2g times their share of the weight\n", rig.load.carries);
  if (rig.load.sag > 1.0 || rig.load.carries < 1.0)
    std::printf("it will not stand: a stiffer --material or a smaller --size would hold it up\n");
}

}  // namespace tendril::runner
