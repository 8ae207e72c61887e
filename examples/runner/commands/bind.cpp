#include "commands.h"
#include "commands/mode.h"
#include "draw/drawing.h"
#include "read/axes.h"
#include "read/mesh_reader.h"
#include "write/json_output.h"

#include <tendril/base/file.h>
#include <tendril/bind/distortion.h>
#include <tendril/bind/judge.h>

#include <cmath>
#include <cstdio>
#include <iostream>

namespace tendril::runner {
namespace {

struct BindArguments {
  std::string mesh, picture;
  std::vector<std::string> axes, poses;
  ModeFlags mode;
  bool json = false;
  double band = bind::BindOptions{}.band;
  int refinements = bind::JudgeOptions{}.refinements, threads = 0;
};

/// Parts listed; there may be as many as faces.
constexpr std::size_t kParts = 100;

OrderedJson to_json(const bind::BindReport& report, const Axes& axes) {
  OrderedJson loose = OrderedJson::array();
  for (std::size_t k = 0; k < std::min(report.loose.size(), kParts); ++k) {
    const bind::LoosePart& part = report.loose[k];
    loose.push_back({{"first", part.first},
                     {"points", part.points},
                     {"curve_pair", axes.names[part.pair]},
                     {"parameter", part.t}});
  }
  return {{"rest_error", report.rest_error},
          {"largest_gap", report.largest_gap},
          {"shares", report.shares},
          {"beyond_ends", report.beyond_ends},
          {"clusters", report.clusters},
          {"ambiguous", runner::to_json(report.ambiguous)},
          {"gated", runner::to_json(report.gated)},
          {"past_focus", runner::to_json(report.past_focus)},
          {"degenerate", runner::to_json(report.degenerate)},
          {"loose_count", report.loose.size()},
          {"loose", loose}};
}

constexpr double kSecondsAlways = 0.2, kSecondsPerPoint = 1.1e-5;
constexpr double kSecondsPerBranch = 0.035, kMorePerBranch = 0.05;
constexpr double kMegabytesAlways = 55.0, kMegabytesPerPoint = 6e-4;

/// Share of a mesh's area that a pose may spoil and still be right.
constexpr double kMostSpoilt = 1e-3;

/// What the judge finds and what becomes of the triangles, in a word.
const char* verdict_of(const bind::JudgeReport& report, const bind::Distortion& distortion) {
  if (report.verdict == bind::TearVerdict::tear) return "tear";
  return distortion.spoilt > kMostSpoilt ? "crumpled" : "right";
}

OrderedJson to_json(const bind::JudgeReport& report, const bind::Distortion& distortion) {
  OrderedJson levels = OrderedJson::array();
  for (const bind::JudgeLevel& level : report.levels)
    levels.push_back({{"points", level.points},
                      {"edges", level.edges},
                      {"faces", level.faces},
                      {"quantiles", level.quantile},
                      {"max", level.max},
                      {"beyond", level.beyond},
                      {"flipped", level.flipped},
                      {"rest_error", level.rest_error},
                      {"ambiguous", level.ambiguous}});
  OrderedJson tears = OrderedJson::array();
  for (const bind::Tear& tear : report.tears)
    tears.push_back({{"place", runner::to_json(tear.place)}, {"gap", tear.gap}});
  OrderedJson worst = OrderedJson::array();
  for (const bind::WorstEdge& edge : report.worst)
    worst.push_back({{"points", {edge.a, edge.b}}, {"stretch", edge.stretch}});
  return {{"verdict", verdict_of(report, distortion)},
          {"torn", report.torn},
          {"tears", tears},
          {"steepest", report.steepest},
          {"growth", report.growth},
          {"growth_of_max",
           std::isfinite(report.growth_of_max) ? OrderedJson(report.growth_of_max) : OrderedJson()},
          {"exponent", report.exponent},
          {"distortion", runner::to_json(distortion)},
          {"levels", levels},
          {"worst", worst}};
}

void print_row(const char* name, const bind::JudgeReport& report, const bind::Distortion& distortion) {
  std::printf("%-11s %s\n", name, verdict_of(report, distortion));
  std::printf(
      "  %.2g %% of the mesh spoilt (up to %.2g %% is right): %zu triangle(s) folded, %zu stretched and %zu "
      "crushed more than tenfold\n",
      100.0 * distortion.spoilt, 100.0 * kMostSpoilt, distortion.folded, distortion.stretched,
      distortion.crushed);
  for (std::size_t k = 0; k < std::min<std::size_t>(5, distortion.zones.size()); ++k) {
    const bind::SpoiltZone& zone = distortion.zones[k];
    std::printf("    %.2g %% about %g %g %g, radius %.3g\n", 100.0 * zone.area, zone.centre.x(),
                zone.centre.y(), zone.centre.z(), zone.radius);
  }
  if (report.torn > 0)
    std::printf("  torn across %zu edge(s) looked at, the widest by %.3g about %g %g %g\n", report.torn,
                report.tears[0].gap, report.tears[0].place.x(), report.tears[0].place.y(),
                report.tears[0].place.z());
  std::printf("  largest stretch in the limit, elsewhere: %.3g\n", report.steepest);
  std::printf("  %10s %8s %8s %8s %8s %8s %8s %8s %9s %8s\n", "edges", "p50", "p90", "p99", "p99.9", "p99.99",
              "max", "> limit", "flipped", "rest");
  for (const bind::JudgeLevel& level : report.levels) {
    std::printf("  %10zu", level.edges);
    for (const double q : level.quantile) std::printf(" %8.3g", q);
    std::printf(" %8.3g %8zu %9zu %8.1e\n", level.max, level.beyond, level.flipped, level.rest_error);
  }
}

/// Grey where nothing is stretched, over yellow to red at twenty times and more.
bind::Color heat(double stretch) {
  const double s = std::clamp(std::log(std::max(1.0, stretch)) / std::log(20.0), 0.0, 1.0);
  const auto mix = [](double a, double b, double part) {
    return static_cast<std::uint8_t>(a + part * (b - a));
  };
  if (s < 0.5) return {mix(170, 240, 2 * s), mix(172, 200, 2 * s), mix(178, 60, 2 * s), 255};
  return {mix(240, 200, 2 * s - 1), mix(200, 30, 2 * s - 1), mix(60, 30, 2 * s - 1), 255};
}

void color_by_stretch(bind::PolygonMesh& mesh, Points rest) {
  std::vector<double> stretch(mesh.points.size(), 1.0);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      const double before = (rest[a] - rest[b]).norm();
      const double now = before > 0.0 ? (mesh.points[a] - mesh.points[b]).norm() / before : 1.0;
      stretch[a] = std::max(stretch[a], now);
      stretch[b] = std::max(stretch[b], now);
    }
  }
  mesh.point_colors.clear();
  for (const double s : stretch) mesh.point_colors.push_back(heat(s));
}

Picture picture_of(const bind::PolygonMesh& mesh, const std::vector<CurvePair>& axes, int threads) {
  const scene::ViewOptions view;
  CameraFit fit(view);
  fit.include(mesh.points);
  for (const CurvePair& pair : axes) fit.include(pair.primary().control_points());
  Drawing drawing{&mesh, {}, {}};
  for (const CurvePair& pair : axes)
    for (Strand& strand : axis_strands(pair, {}, 0.002 * fit.camera().size)) drawing.over.push_back(strand);
  return draw(drawing, fit.camera(), view, threads);
}

/// The mesh at rest with its ambiguous points in blue, and posed with its edges' stretch in colour.
void draw_bound(const BindArguments& options, bind::PolygonMesh mesh, const bind::Binding& binding,
                const Axes& axes, int threads) {
  const std::vector<Vec3> rest = mesh.points;
  mesh.point_colors.assign(mesh.points.size(), bind::Color{200, 200, 196, 255});
  for (const std::uint32_t i : binding.report().ambiguous)
    mesh.point_colors[i] = bind::Color{70, 120, 210, 255};
  std::vector<Picture> panels{picture_of(mesh, axes.rest, threads)};
  if (!axes.posed.empty()) {
    binding.update(axes.posed, mesh.points, threads);
    color_by_stretch(mesh, rest);
    panels.push_back(picture_of(mesh, axes.posed, threads));
  }
  const std::vector<std::string> captions(panels.size());
  write_file_whole(options.picture, png_bytes(contact_sheet(panels, captions, 2)));
}

void tell_binding(const BindArguments& options, const bind::BindReport& report, const Axes& axes,
                  std::size_t points) {
  std::printf("%s: %zu points, %zu ambiguous, %zu gated, %zu shares, rest error %.1e\n", options.mesh.c_str(),
              points, report.ambiguous.size(), report.gated.size(), report.shares, report.rest_error);
  constexpr std::size_t kPrinted = 10;
  for (std::size_t k = 0; k < std::min(report.loose.size(), kPrinted); ++k)
    std::printf("  a part of %zu point(s), from point %u on, follows %s whole\n", report.loose[k].points,
                report.loose[k].first, axes.names[report.loose[k].pair].c_str());
  if (report.loose.size() > kPrinted)
    std::printf("  and %zu part(s) more, see --json\n", report.loose.size() - kPrinted);
}

/// What judging will take, on standard error, as it is told before and is no result. Measured on one core,
/// with one axis (tests/bench/binding, section judging) and trees of five to eleven.
void tell_cost(const bind::JudgeCost& cost, std::size_t axes) {
  const auto points = static_cast<double>(cost.points), branches = static_cast<double>(axes - 1);
  std::fprintf(stderr, "tendril: judging binds %zu points: some %.1g s of one core, and %.0f MB\n",
               cost.points,
               kSecondsAlways + kSecondsPerBranch * branches +
                   kSecondsPerPoint * points * (1.0 + kMorePerBranch * branches),
               kMegabytesAlways + kMegabytesPerPoint * points);
}

/// \return  whether the pose is right
bool judge_pose(const BindArguments& options, const Axes& axes, const bind::TearJudge& judged,
                OrderedJson& out) {
  const bind::JudgeReport report = judged.judge(axes.posed);
  std::vector<Vec3> points(judged.mesh().points.size());
  const int threads = thread_count(options.threads);
  judged.binding().update(axes.posed, points, threads);
  const bind::Distortion distortion =
      bind::measure_distortion(judged.binding(), axes.rest, judged.mesh(), axes.posed, points);
  out["judge"] = to_json(report, distortion);
  if (!options.json) print_row(options.mode.nearest ? "nearest" : "continuous", report, distortion);
  if (!options.picture.empty()) draw_bound(options, judged.mesh(), judged.binding(), axes, threads);
  return std::string(verdict_of(report, distortion)) == "right";
}

int judge(const BindArguments& options) {
  const int threads = thread_count(options.threads);
  const bind::PolygonMesh mesh = read_mesh(options.mesh);
  const Axes axes = read_axes(options.axes, options.poses);
  const bind::BindOptions how{options.mode.mode(), options.band, threads};
  OrderedJson out{{"mesh", options.mesh}, {"points", mesh.points.size()}};
  const auto tell = [&](const bind::Binding& binding) {
    out["binding"] = to_json(binding.report(), axes);
    if (!options.json) tell_binding(options, binding.report(), axes, mesh.points.size());
  };
  bool right = true;
  if (axes.posed.empty()) {
    const bind::Binding binding(axes.rest, mesh, how);
    tell(binding);
    if (!options.picture.empty()) draw_bound(options, mesh, binding, axes, threads);
  } else {
    bind::JudgeOptions judging;
    judging.refinements = options.refinements;
    tell_cost(bind::judge_cost(mesh, judging), axes.rest.size());
    const bind::TearJudge judged(axes.rest, mesh, how, judging);
    tell(judged.own_binding());
    right = judge_pose(options, axes, judged, out);
  }
  if (options.json) print(out);
  return right ? kDone : kNoSuccess;
}

}  // namespace

Command bind_command(CLI::App& parent) {
  auto* app = parent.add_subcommand(
      "bind", "Binds a mesh to axes and judges by refinement whether a pose tears or crumples it");
  const auto options = std::make_shared<BindArguments>();
  app->add_option("mesh", options->mesh, "OFF, PLY, OBJ or STL file")->required();
  app->add_option("--axis", options->axes,
                  "curve file (JSON) at rest, of one or several curve-pairs; may be given several times")
      ->required();
  app->add_option("--pose", options->poses, "curve file (JSON) of the posed axis, one for each --axis");
  app->add_option("--band", options->band, "width of transitions, in distances to the axis")
      ->capture_default_str();
  options->mode.add_to(*app);
  app->add_option("--refinements", options->refinements, "splits to judge by, 1 to 4")->capture_default_str();
  expect_png(app->add_option("--picture", options->picture,
                             "PNG file: ambiguous points at rest, stretch in the pose"));
  app->add_option("--threads", options->threads, "threads, 0 for all; the result is the same");
  app->add_flag("--json", options->json, "print JSON, with the ids of all that is odd");
  return {app, [options] { return judge(*options); }};
}

}  // namespace tendril::runner
