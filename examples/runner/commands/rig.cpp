#include "commands.h"
#include "draw/drawing.h"
#include "read/mesh_reader.h"
#include "rig/of_mesh.h"
#include "write/json_output.h"

#include <tendril/base/file.h>

#include <chrono>
#include <cmath>
#include <cstdio>

namespace tendril::runner {
namespace {

struct RigArguments {
  std::string mesh, out, picture;
  RigAxes axes;
  RigOptions rig;
  scene::ViewOptions view;
  int threads = 0;
  bool json = false;
};

/// The outline of a section, in the frame of its node.
Strand ring(const Frame& frame, const Vec3& centre, const RigSection& section, double radius,
            const Vec3f& color) {
  constexpr int kCorners = 32;
  Strand out{Strand::Kind::tube, {}, radius, color};
  for (int k = 0; k <= kCorners; ++k) {
    const double angle = 2.0 * M_PI * k / kCorners;
    out.points.emplace_back(centre + section.a * std::cos(angle) * frame.x +
                            section.b * std::sin(angle) * frame.y);
  }
  return out;
}

/// Curves red, masses dark, sections seen green and guessed grey, held nodes as large yellow balls.
void draw_rig(const RigArguments& options, const bind::PolygonMesh& mesh, const Rig& rig) {
  const Vec3f red(0.62F, 0.05F, 0.03F), dark(0.06F, 0.05F, 0.05F), green(0.05F, 0.35F, 0.10F),
      grey(0.30F, 0.30F, 0.30F), yellow(0.80F, 0.55F, 0.02F);
  scene::ViewOptions view = options.view;
  view.up = rig.stance.up;
  CameraFit fit(view);
  fit.include(mesh.points);
  const double radius = 0.0025 * fit.camera().size;
  Drawing drawing{&mesh, {}, {}};
  for (std::size_t k = 0; k < rig.curves.size(); ++k) {
    const RigCurve& curve = rig.curves[k];
    const std::vector<Frame> frames = node_frames(curve.points, curve.orientation).frame;
    drawing.over.push_back({Strand::Kind::tube, curve.points, radius, red});
    drawing.over.push_back({Strand::Kind::balls, curve.points, 2.0 * radius, dark});
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const RigSection& section = rig.body.sections[k][i];
      drawing.over.push_back(
          ring(frames[i], curve.points[i], section, 0.5 * radius, section.seen ? green : grey));
    }
  }
  Strand held{Strand::Kind::balls, {}, 5.0 * radius, yellow};
  for (const Held& h : rig.held)
    for (std::size_t i = h.first; i <= h.last; ++i) held.points.push_back(rig.curves[h.curve].points[i]);
  drawing.over.push_back(std::move(held));
  write_file_whole(options.picture,
                   png_bytes(draw(drawing, fit.camera(), view, thread_count(options.threads))));
}

OrderedJson to_json(const Rig& rig, double seconds) {
  OrderedJson curves = OrderedJson::array(), held = OrderedJson::array();
  for (std::size_t k = 0; k < rig.curves.size(); ++k) {
    std::vector<double> a, b;
    std::vector<bool> seen;
    for (const RigSection& s : rig.body.sections[k])
      a.push_back(s.a), b.push_back(s.b), seen.push_back(s.seen);
    curves.push_back({{"name", rig.curves[k].name},
                      {"nodes", rig.curves[k].points.size()},
                      {"a", a},
                      {"b", b},
                      {"seen", seen}});
  }
  for (const Held& h : rig.held)
    held.push_back({{"curve_pair", rig.curves[h.curve].name}, {"nodes", {h.first, h.last}}});
  return {{"curves", curves},
          {"doubt", rig.doubt},
          {"up", runner::to_json(rig.stance.up)},
          {"held_as", rig.held_as},
          {"held", held},
          {"material", rig.material.name},
          {"size_m", rig.size},
          {"unit_m", rig.unit},
          {"volume", rig.body.volume},
          {"overlap", rig.overlap},
          {"mass_kg", rig.mass},
          {"period_s", rig.load.period},
          {"slowest", rig.load.slowest},
          {"sag", rig.load.sag},
          {"legs_carry", std::isfinite(rig.load.carries) ? OrderedJson(rig.load.carries) : OrderedJson()},
          {"wall_s", seconds}};
}

std::string command_of(const RigArguments& options) {
  std::string out = "tendril rig " + options.mesh;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) out += std::string(" ") + name + " " + value;
  };
  add("--axis", options.axes.file);
  if (options.axes.close) out += " --close";
  if (options.axes.largest_part) out += " --largest-part";
  if (options.axes.spacing) add("--spacing", shortest(*options.axes.spacing));
  add("--material", options.rig.material);
  if (options.rig.size) add("--size", shortest(*options.rig.size));
  add("--hold", options.rig.hold);
  add("--up", options.rig.up);
  if (options.rig.wind) add("--wind", shortest(*options.rig.wind));
  return out;
}

int rig(const RigArguments& options) {
  require_other_file("--picture", options.picture, options.out);
  const bind::PolygonMesh mesh = read_mesh(options.mesh);
  const auto start = std::chrono::steady_clock::now();
  RigOptions how = options.rig;
  how.threads = thread_count(options.threads);
  const Rig rig = rig_mesh(mesh, options.mesh, options.axes, how);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_rig(rig, options.mesh, options.out, command_of(options));
  if (!options.picture.empty()) draw_rig(options, mesh, rig);
  if (options.json) {
    print(to_json(rig, seconds));
  } else {
    tell(rig);
    std::printf("%s, %.2f s; move it by: tendril run %s --out FOLDER\n", options.out.c_str(), seconds,
                options.out.c_str());
  }
  return kDone;
}

}  // namespace

Command rig_command(CLI::App& parent) {
  auto* app = parent.add_subcommand(
      "rig", "Makes a scene of a mesh: axes, sections, material, supports, gravity and wind");
  const auto options = std::make_shared<RigArguments>();
  app->add_option("mesh", options->mesh, "OFF, PLY, OBJ or STL file")->required();
  app->add_option("--out", options->out, "scene file (JSON) to write")->required();
  auto* axis = app->add_option("--axis", options->axes.file,
                               "curve file to start from, instead of axes that are found");
  app->add_flag("--close", options->axes.close, "find the axes of a copy whose holes are closed")
      ->excludes(axis);
  app->add_flag("--largest-part", options->axes.largest_part,
                "find the axes of the part with the largest area, and measure that alone");
  app->add_option("--spacing", options->axes.spacing, "between the nodes of the curves, about")
      ->excludes(axis);
  std::string names;
  for (const NamedMaterial& m : materials()) names += (names.empty() ? "" : ", ") + std::string(m.name);
  app->add_option("--material", options->rig.material, names + "; rubber where that stands, or else foam");
  app->add_option("--size", options->rig.size, "largest extent of the mesh in metres; 1 by default");
  app->add_option(
      "--hold", options->rig.hold,
      "feet, middle, root, lowest or a curve's name; feet where there are any, or else the middle");
  app->add_option("--up", options->rig.up, "x, y, z, -x, -y or -z; guessed by the feet");
  app->add_option("--wind", options->rig.wind,
                  "mean speed in metres a second, 0 for none; 8, or less where that would be a gale");
  expect_png(app->add_option("--picture", options->picture, "PNG file: curves, sections and what is held"));
  app->add_option("--yaw", options->view.yaw, "degrees, of the picture")->capture_default_str();
  app->add_option("--pitch", options->view.pitch, "degrees, of the picture")->capture_default_str();
  app->add_option("--threads", options->threads, "threads, 0 for all");
  app->add_flag("--json", options->json, "print JSON");
  return {app, [options] { return rig(*options); }};
}

}  // namespace tendril::runner
