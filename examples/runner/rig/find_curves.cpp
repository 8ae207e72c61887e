#include "rig/of_mesh.h"

#include <tendril/axis/find_axis.h>
#include <tendril/base/error.h>
#include <tendril/base/number.h>

namespace tendril::runner {
namespace {

std::string name_of(const Vec3& p) {
  return shortest(p.x()) + " " + shortest(p.y()) + " " + shortest(p.z());
}

}  // namespace

std::vector<RigCurve> find_curves(const bind::PolygonMesh& mesh, const std::string& path, const RigAxes& how,
                                  std::string& doubt) {
  axis::AxisOptions options;
  options.close = how.close;
  options.largest_part = how.largest_part;
  options.spacing = how.spacing;
  axis::AxisTree tree;
  try {
    tree = axis::find_axis(mesh, options);
  } catch (const InvalidInput& error) {
    if (error.place() != "mesh") throw;
    throw InvalidInput(path, error.reason(), error.expected() + " (--close, --largest-part)");
  }
  // Of one that folds, whoever measures it says where.
  if (tree.status == axis::AxisStatus::uncovered || tree.status == axis::AxisStatus::folded) {
    doubt = tree.reason;
  } else if (tree.status != axis::AxisStatus::found) {
    throw InvalidInput(path,
                       std::string("no axis found, ") + axis::to_string(tree.status) + ": " + tree.reason,
                       "a mesh with limbs; --axis takes an axis drawn by hand");
  }
  if (!tree.report.cuts.empty())
    doubt += std::string(doubt.empty() ? "" : "; ") + std::to_string(tree.report.cuts.size()) +
             " loop(s) of the axes are cut open, at " + name_of(tree.report.cuts[0]) +
             " for one: nothing holds their ends together, and the mesh tears where they part";
  std::vector<RigCurve> out;
  for (axis::AxisCurve& curve : tree.curves) {
    const std::string name = out.empty() ? "axis" : "branch_" + std::to_string(out.size());
    out.push_back({name, std::move(curve.points), std::move(curve.orientation), std::move(curve.radius)});
    if (curve.joint) out.back().joint = {curve.joint->parent, curve.joint->node};
  }
  return out;
}

}  // namespace tendril::runner
