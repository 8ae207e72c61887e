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

/// One point's nearest point on the primary curves, and its record in axial space.
struct Found {
  const scene::CurveFile* curve;
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

Found record(const scene::CurveFile& curve, const Projection& projection, const Vec3& point) {
  return {&curve, projection, to_axial(curve.pair, projection.t, point),
          curve.pair.frame(projection.t).status};
}

OrderedJson to_json(const Found& found, bool several) {
  const Projection& p = found.projection;
  const AxialPoint& r = found.record;
  OrderedJson out;
  if (several) out["curve"] = found.curve->name;
  out.update({{"t", p.t},
              {"point", runner::to_json(p.point)},
              {"distance", p.distance},
              {"kind", to_string(p.kind)},
              {"lambda", p.lambda},
              {"gap", p.gap},
              {"u", r.u},
              {"v", r.v},
              {"w", r.w},
              {"frame", runner::to_string(found.status)}});
  return out;
}

void print_row(const Found& found, bool several) {
  const Projection& p = found.projection;
  if (several) std::cout << found.curve->name << ',';
  const AxialPoint& r = found.record;
  for (const double x :
       {p.t, p.point.x(), p.point.y(), p.point.z(), p.distance, p.lambda, p.gap, r.u, r.v, r.w}) {
    std::cout << shortest(x) << ',';
  }
  std::cout << to_string(p.kind) << ',' << runner::to_string(found.status) << '\n';
}

/// Curves of a list have names; those that the file does not name are called after their places in it.
std::vector<scene::CurveFile> named_curves(const std::string& path) {
  std::vector<scene::CurveFile> curves = scene::read_curves(path);
  for (std::size_t c = 0; c < curves.size(); ++c)
    if (curves[c].name.empty()) curves[c].name = std::to_string(c);
  return curves;
}

int project(const ProjectArguments& options) {
  const std::vector<scene::CurveFile> curves = named_curves(options.curve);
  const std::vector<Vec3> points = read_points_csv(options.points);
  std::vector<std::vector<Projection>> nearest;
  for (const scene::CurveFile& curve : curves)
    nearest.push_back(CurveProjector(curve.pair.primary()).nearest(points));
  const bool several = curves.size() > 1;
  OrderedJson list = OrderedJson::array();
  if (!options.json)
    std::cout << (several ? "curve," : "") << "t,x,y,z,distance,lambda,gap,u,v,w,kind,frame\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t best = 0;
    for (std::size_t c = 1; c < curves.size(); ++c)
      if (nearest[c][i].distance < nearest[best][i].distance) best = c;
    const Found found = record(curves[best], nearest[best][i], points[i]);
    if (options.json) {
      list.push_back(to_json(found, several));
    } else {
      print_row(found, several);
    }
  }
  if (options.json) print({{"points", list}});
  return kDone;
}

}  // namespace

Command project_command(CLI::App& parent) {
  auto* app =
      parent.add_subcommand("project", "Nearest points on curve-pairs' primary curves, in axial space");
  const auto options = std::make_shared<ProjectArguments>();
  app->add_option("curve", options->curve, "curve file (JSON): one curve-pair or a list")->required();
  app->add_option("points", options->points, "points, x,y,z a line (CSV)")->required();
  app->add_flag("--json", options->json, "print JSON instead of CSV");
  return {app, [options] { return project(*options); }};
}

}  // namespace tendril::runner
