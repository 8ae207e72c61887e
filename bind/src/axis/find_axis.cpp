#include <tendril/axis/find_axis.h>
#include <tendril/base/error.h>
#include <tendril/base/number.h>
#include <tendril/curve/closest_point.h>
#include <tendril/curve/fit.h>
#include <tendril/curve/frame_jump.h>
#include <tendril/curve/reference_frames.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "centre.h"
#include "path_fit.h"
#include "paths.h"
#include "prepare.h"
#include "surface.h"

namespace tendril::axis {
namespace {

constexpr std::size_t kSamples = 200;   ///< of a path to be fitted
constexpr double kLeastCoverage = 0.9;  ///< see AxisStatus::uncovered
constexpr double kMostNodes = 1e4;      ///< of a curve
constexpr double kCovered = 3.0;        ///< radii, see AxisReport::coverage
constexpr int kTries = 3;  ///< at a curve within the surface, each twice as close to the skeleton
constexpr double kLooser = 8.0, kLoosest = 512.0;  ///< of the tolerance, for a curve that does not fold

void check(const AxisOptions& options) {
  const auto require = [](bool right, const char* name, double value, const char* expected) {
    if (!right) throw InvalidInput(name, std::to_string(value), expected);
  };
  require(options.prune >= 0.0 && std::isfinite(options.prune), "prune", options.prune, "a number from 0");
  require(!options.spacing || (*options.spacing > 0.0 && std::isfinite(*options.spacing)), "spacing",
          options.spacing.value_or(0.0), "a positive number");
  require(options.tolerance > 0.0 && options.tolerance <= 1.0, "tolerance", options.tolerance,
          "above 0, at most 1");
  require(options.time_limit > 0.0, "time_limit", options.time_limit, "a positive number");
}

int degree_of(std::size_t points) {
  return std::min(3, static_cast<int>(points) - 1);
}

/// Fits one path after another, parents before children.
class Fitter {
 public:
  Fitter(const Surface& surface, const AxisOptions& options, double spacing)
      : surface_(surface), options_(options), spacing_(spacing) {}

  std::vector<AxisCurve> run(std::vector<Path> paths) {
    for (Path& path : paths) {
      std::optional<AxisJoint> joint;
      if (path.parent) {
        joint = joint_of(path, paths[*path.parent]);
        path.line.front() = curves_[joint->parent].points[joint->node];
      }
      curves_.push_back(fit_within(path, joint));
    }
    return std::move(curves_);
  }

 private:
  /// The parent's node at the vertex where the path leaves it.
  AxisJoint joint_of(const Path& path, const Path& parent) const {
    const auto at = std::find(parent.vertices.begin(), parent.vertices.end(), path.vertices.front());
    return {*path.parent, nodes_[*path.parent][static_cast<std::size_t>(at - parent.vertices.begin())]};
  }

  AxisCurve fit_within(const Path& path, const std::optional<AxisJoint>& joint) {
    const Line line = evenly(path.line, kSamples), samples = centred(line, surface_, path.stays);
    const std::vector<double> width = half_widths(samples, surface_);
    std::optional<AxisCurve> best;
    nodes_.emplace_back();
    const auto rank = [](const AxisCurve& curve) {
      return std::make_tuple(curve.folds, curve.outside, curve.strays);
    };
    const auto try_fit = [&](const Line& to, double closer, double tolerance) {
      const Spread spread = spread_nodes(path, closer * spacing_);
      const BSpline fitted = fit(to, width, tolerance);
      AxisCurve curve;
      curve.joint = joint;
      for (const double t : spread.parameters) curve.points.push_back(fitted.value(t));
      measure(curve, samples, width);
      if (best && rank(curve) >= rank(*best)) return;
      best = std::move(curve);
      nodes_.back() = spread.node_of_vertex;
    };
    double closer = 1.0;
    for (int k = 0; k < kTries && (!best || best->folds || best->outside > 0 || best->strays > 1.0); ++k) {
      try_fit(samples, closer, closer * options_.tolerance);
      closer *= 0.5;
    }
    // Where a wall is thin and the body wide, samples may jump to and fro: then near the skeleton as it was.
    for (double loose = 1.0; best->folds && loose <= kLoosest; loose *= kLooser)
      try_fit(line, 1.0, loose * options_.tolerance);
    return *best;
  }

  void measure(AxisCurve& curve, const Line& samples, const std::vector<double>& width) const {
    const Interpolator through(degree_of(curve.points.size()), curve.points);
    const CurveProjector projector(BSpline(through.knots(), through.solve(curve.points)));
    for (std::size_t k = 0; k < samples.size(); ++k)
      curve.strays = std::max(curve.strays, projector.nearest(samples[k]).distance / width[k]);
    const std::vector<double>& at = through.parameters();
    for (std::size_t k = 0; k < at.size(); ++k) {
      curve.radius.push_back(surface_.distance(curve.points[k]));
      if (!surface_.holds(curve.points[k])) ++curve.outside;
      if (k == 0) continue;
      curve.length += (curve.points[k] - curve.points[k - 1]).norm();
      if (!surface_.holds(projector.curve().value(0.5 * (at[k - 1] + at[k])))) ++curve.outside;
    }
    orient(curve);
    curve.folds = find_frame_jump(pair_of(curve), at).has_value();
  }

  /// Where the first frame's side points: across the whole of the first curve, and as the parent's for the
  /// others.
  Vec3 side(const AxisCurve& curve) const {
    if (curve.joint) {
      const AxisCurve& parent = curves_[curve.joint->parent];
      const Vec3 y = parent.orientation[curve.joint->node] - parent.points[curve.joint->node];
      const Vec3 z = curve.points[1] - curve.points[0];
      if (y.cross(z).norm() > 0.3 * y.norm() * z.norm()) return y;
      const std::size_t next = std::min(curve.joint->node + 1, parent.points.size() - 1);
      return y.cross(parent.points[next] - parent.points[next - 1]);
    }
    Eigen::Index axis = 0;
    (curve.points.back() - curve.points.front()).cwiseAbs().minCoeff(&axis);
    return Vec3::Unit(axis);
  }

  void orient(AxisCurve& curve) const {
    const Interpolator through(degree_of(curve.points.size()), curve.points);
    const BSpline primary(through.knots(), through.solve(curve.points));
    const NodeFrames frames = rotation_minimising_frames(primary, through.parameters(), side(curve));
    const double offset = curve.length / static_cast<double>(curve.points.size() - 1);
    for (std::size_t k = 0; k < curve.points.size(); ++k)
      curve.orientation.push_back(curve.points[k] + offset * frames.frame[k].y);
  }

  const Surface& surface_;
  const AxisOptions& options_;
  double spacing_;
  std::vector<AxisCurve> curves_;
  std::vector<std::vector<std::size_t>> nodes_;  ///< of the vertices of each path
};

/// At its free ends.
void extend(Path& path, const Surface& surface) {
  if (!path.stays.last) path.along.back() += extend_end(path.line, surface);
  if (path.stays.first) return;
  std::reverse(path.line.begin(), path.line.end());
  const double more = extend_end(path.line, surface);
  std::reverse(path.line.begin(), path.line.end());
  for (std::size_t k = 1; k < path.along.size(); ++k) path.along[k] += more;
}

/// Distance to a chain over its radius there, the least.
double radii_from(const AxisCurve& curve, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < curve.points.size(); ++k) {
    const Vec3 edge = curve.points[k] - curve.points[k - 1];
    const double part = std::clamp((p - curve.points[k - 1]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const double radius = (1.0 - part) * curve.radius[k - 1] + part * curve.radius[k];
    least = std::min(least, (curve.points[k - 1] + part * edge - p).norm() / radius);
  }
  return least;
}

/// How much of the skin has a curve near.
void measure_coverage(const bind::PolygonMesh& mesh, const std::vector<AxisCurve>& curves,
                      AxisReport& report) {
  std::vector<double> area(mesh.points.size(), 0.0);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto corner = mesh.face(f);
    const Vec3& p = mesh.points[corner[0]];
    const double size = (mesh.points[corner[1]] - p).cross(mesh.points[corner[2]] - p).norm();
    for (const std::uint32_t i : corner) area[i] += size;
  }
  double near = 0.0, all = 0.0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    double radii = std::numeric_limits<double>::infinity();
    for (const AxisCurve& curve : curves) radii = std::min(radii, radii_from(curve, mesh.points[i]));
    all += area[i];
    if (radii <= kCovered) near += area[i];
    if (radii > report.farthest_radii) report.farthest_radii = radii, report.farthest = mesh.points[i];
  }
  report.coverage = near / all;
}

/// Back to where the mesh was.
void put_back(const UnitScaling& scaling, AxisTree& tree) {
  const auto move = [&](Vec3& p) { p = scaling.back(p); };
  for (AxisCurve& curve : tree.curves) {
    std::for_each(curve.points.begin(), curve.points.end(), move);
    std::for_each(curve.orientation.begin(), curve.orientation.end(), move);
    for (double& r : curve.radius) r *= scaling.scale;
    curve.length *= scaling.scale;
  }
  for (AxisCurve& curve : tree.curves)
    if (curve.joint) curve.points[0] = tree.curves[curve.joint->parent].points[curve.joint->node];
  for (Twig& twig : tree.report.twigs) {
    move(twig.root);
    move(twig.tip);
    twig.length *= scaling.scale;
  }
  std::for_each(tree.report.cuts.begin(), tree.report.cuts.end(), move);
  move(tree.report.farthest);
}

void note_skeleton(const BranchGraph& graph, AxisReport& report) {
  for (const int degree : graph.degrees()) {
    report.ends += degree == 1;
    report.junctions += degree > 2;
  }
  report.loops = graph.loops();
}

}  // namespace

AxisTree find_axis(const bind::PolygonMesh& mesh, const AxisOptions& options) {
  check(options);
  AxisTree tree;
  const Prepared prepared = prepare(mesh, options, tree.report);
  const Contracted contracted = contract(prepared.mesh, options.time_limit);
  tree.report.contractions = contracted.steps;
  if (contracted.state != Contraction::converged) {
    const bool late = contracted.state == Contraction::out_of_time;
    tree.status = late ? AxisStatus::time_limit : AxisStatus::diverged;
    tree.reason = (late ? "the time limit was reached in" : "numbers that are not finite came up in") +
                  std::string(" step ") + std::to_string(contracted.steps) + " of the contraction";
    return tree;
  }
  const Surface surface(prepared.mesh);
  const Clearance clearance = [&](const Vec3& p) { return surface.distance(p); };
  BranchGraph graph = branches_of(contracted.skeleton);
  note_skeleton(graph, tree.report);
  tree.report.twigs = prune(graph, options.prune, clearance);
  merge_junctions(graph, clearance);
  trim_ends(graph, clearance);
  const std::size_t first_cut = graph.vertices.size();
  tree.report.cuts = cut_loops(graph, clearance);
  std::vector<Path> paths = paths_of(graph, first_cut);
  if (paths.empty()) return tree;
  for (Path& path : paths) extend(path, surface);
  const double longest = paths.front().along.back();
  if (options.spacing && *options.spacing * kMostNodes < longest * prepared.scaling.scale)
    throw InvalidInput("spacing", shortest(*options.spacing),
                       "at least a ten thousandth of the longest axis, " +
                           shortest(longest * prepared.scaling.scale / kMostNodes));
  const double spacing = options.spacing ? *options.spacing / prepared.scaling.scale : longest / 40.0;
  tree.curves = Fitter(surface, options, spacing).run(std::move(paths));
  measure_coverage(prepared.mesh, tree.curves, tree.report);
  put_back(prepared.scaling, tree);
  if (tree.report.coverage < kLeastCoverage) {
    tree.status = AxisStatus::uncovered;
    tree.reason = std::to_string(std::lround(100.0 * (1.0 - tree.report.coverage))) +
                  " % of the skin is farther from every curve than three times its radius, up to " +
                  std::to_string(std::lround(tree.report.farthest_radii)) + " times";
  }
  const auto folds =
      std::find_if(tree.curves.begin(), tree.curves.end(), [](const auto& c) { return c.folds; });
  if (folds != tree.curves.end()) {
    tree.status = AxisStatus::folded;
    tree.reason = "a curve folds back, number " + std::to_string(folds - tree.curves.begin()) +
                  " from 0: nothing can be bound to it";
  }
  return tree;
}

const char* to_string(AxisStatus status) {
  switch (status) {
    case AxisStatus::found:
      return "found";
    case AxisStatus::uncovered:
      return "uncovered";
    case AxisStatus::folded:
      return "folded";
    case AxisStatus::time_limit:
      return "time_limit";
    case AxisStatus::diverged:
      return "diverged";
  }
  return "";
}

CurvePair pair_of(const AxisCurve& curve) {
  const Interpolator through(degree_of(curve.points.size()), curve.points);
  return {through.knots(), through.solve(curve.points), through.solve(curve.orientation)};
}

}  // namespace tendril::axis
