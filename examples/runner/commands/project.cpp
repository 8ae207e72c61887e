#include "commands.h"
#include "read/csv_reader.h"
#include "write/json_output.h"

#include <tendril/curve/axial.h>
#include <tendril/curve/closest_point.h>
#include <tendril/scene/curve_file.h>

#include <iostream>

namespace tendril::runner {
namespace {

struct ProjectArguments {
  std::string curve, points;
  bool json = false;
};

/// One point's nearest point on the primary curve, and its record in axial space.
struct Found {
  Projection projection;
  AxialPoint record;
  FrameStatus status;
};

const char* to_string(ProjectionKind kind) {
  switch (kind) {
    case ProjectionKind::interior:
      return "interior";
    case ProjectionKind::start:
      return "start";
    case ProjectionKind::end:
      return "end";
    case ProjectionKind::joint:
      return "joint";
  }
  return "unknown";
}

Found record(const CurvePair& pair, const Projection& projection, const Vec3& point) {
  return {projection, to_axial(pair, projection.t, point), pair.frame(projection.t).status};
}

OrderedJson to_json(const Found& found) {
  const Projection& p = found.projection;
  const AxialPoint& r = found.record;
  return {{"t", p.t},
          {"point", runner::to_json(p.point)},
          {"distance", p.distance},
          {"kind", to_string(p.kind)},
          {"lambda", p.lambda},
          {"gap", p.gap},
          {"u", r.u},
          {"v", r.v},
          {"w", r.w},
          {"frame", runner::to_string(found.status)}};
}

void print_row(const Found& found) {
  const Projection& p = found.projection;
  const AxialPoint& r = found.record;
  for (const double x :
       {p.t, p.point.x(), p.point.y(), p.point.z(), p.distance, p.lambda, p.gap, r.u, r.v, r.w}) {
    std::cout << shortest(x) << ',';
  }
  std::cout << to_string(p.kind) << ',' << runner::to_string(found.status) << '\n';
}

int project(const ProjectArguments& options) {
  const scene::CurveFile curve = scene::read_curve(options.curve);
  const std::vector<Vec3> points = read_points_csv(options.points);
  const std::vector<Projection> nearest = CurveProjector(curve.pair.primary()).nearest(points);
  OrderedJson list = OrderedJson::array();
  if (!options.json) std::cout << "t,x,y,z,distance,lambda,gap,u,v,w,kind,frame\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Found found = record(curve.pair, nearest[i], points[i]);
    if (options.json) {
      list.push_back(to_json(found));
    } else {
      print_row(found);
    }
  }
  if (options.json) print({{"points", list}});
  return kDone;
}

}  // namespace

Command project_command(CLI::App& parent) {
  auto* app =
      parent.add_subcommand("project", "Nearest points on a curve-pair's primary curve, in axial space");
  const auto options = std::make_shared<ProjectArguments>();
  app->add_option("curve", options->curve, "curve file (JSON)")->required();
  app->add_option("points", options->points, "points, x,y,z a line (CSV)")->required();
  app->add_flag("--json", options->json, "print JSON instead of CSV");
  return {app, [options] { return project(*options); }};
}

}  // namespace tendril::runner
