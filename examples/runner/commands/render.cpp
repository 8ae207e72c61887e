#include "commands.h"
#include "draw/drawing.h"
#include "read/mesh_reader.h"
#include "write/json_output.h"

#include <tendril/base/file.h>
#include <tendril/scene/curve_file.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <thread>

namespace tendril::runner {
namespace {

struct RenderArguments {
  std::string mesh, out, axis, size = "960x720", view = "35,12", up = "y";
  int samples = scene::ViewOptions{}.samples;
  int threads = 0;
  bool json = false;
};

/// Two numbers around a separator; all of the text.
template <class T>
std::pair<T, T> two(const std::string& option, const std::string& text, char separator,
                    const std::string& expected) {
  std::pair<T, T> out{};
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, out.first);
  if (first.ec == std::errc{} && first.ptr != end && *first.ptr == separator) {
    const auto second = std::from_chars(first.ptr + 1, end, out.second);
    if (second.ec == std::errc{} && second.ptr == end) return out;
  }
  throw InvalidInput(option, "'" + text + "'", expected);
}

scene::ViewOptions read_view(const RenderArguments& options) {
  scene::ViewOptions view;
  view.up = up_direction(options.up);
  const auto angles = two<double>("--view", options.view, ',', "yaw,pitch in degrees");
  if (!(std::abs(angles.first) <= 1e6) || !(std::abs(angles.second) <= 89.0)) {
    throw InvalidInput("--view", "'" + options.view + "'", "a pitch from -89 to 89 degrees");
  }
  view.yaw = angles.first;
  view.pitch = angles.second;
  const auto size = two<int>("--size", options.size, 'x', "WIDTHxHEIGHT in pixels");
  if (std::min(size.first, size.second) < 16 || std::max(size.first, size.second) > 8192) {
    throw InvalidInput("--size", "'" + options.size + "'", "16 to 8192 pixels each way");
  }
  view.width = size.first;
  view.height = size.second;
  if (options.samples < 1 || options.samples > 1024) {
    throw InvalidInput("--samples", std::to_string(options.samples), "1 to 1024");
  }
  view.samples = options.samples;
  return view;
}

int render(const RenderArguments& options) {
  const scene::ViewOptions view = read_view(options);
  const int threads = thread_count(options.threads);
  const bind::PolygonMesh mesh = read_mesh(options.mesh);
  CameraFit fit(view);
  fit.include(mesh.points);
  Drawing drawing{&mesh, {}, {}};
  std::vector<scene::CurveFile> curves;
  if (!options.axis.empty()) curves = scene::read_curves(options.axis);
  for (const scene::CurveFile& curve : curves) fit.include(curve.pair.primary().control_points());
  for (const scene::CurveFile& curve : curves)
    for (Strand& strand : axis_strands(curve.pair, curve.masses, 0.002 * fit.camera().size))
      drawing.over.push_back(std::move(strand));
  Picture picture = draw(drawing, fit.camera(), view, threads);
  for (const scene::CurveFile& curve : curves) name_axis(picture, fit.camera(), curve.pair, curve.name);
  write_file_whole(options.out, png_bytes(picture));
  if (options.json) {
    print({{"picture", options.out},
           {"width", view.width},
           {"height", view.height},
           {"faces", mesh.face_count()}});
  } else {
    std::cout << options.out << ": " << view.width << " x " << view.height << '\n';
  }
  return kDone;
}

}  // namespace

void require_other_file(const std::string& option, const std::string& path, const std::string& out) {
  namespace fs = std::filesystem;
  if (!path.empty() && fs::absolute(path).lexically_normal() == fs::absolute(out).lexically_normal())
    throw InvalidInput(option, "'" + path + "', which --out writes", "another file");
}

void expect_png(CLI::Option* option) {
  option->check([](const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    for (const char* other :
         {".jpg", ".jpeg", ".gif", ".bmp", ".tif", ".tiff", ".webp", ".svg", ".pdf", ".ppm"})
      if (ending == other) return "'" + path + "'; expected a name that ends in .png: pictures are PNG";
    return std::string();
  });
}

int thread_count(int asked) {
  if (asked < 0 || asked > 256) throw InvalidInput("--threads", std::to_string(asked), "0 (all) to 256");
  return asked > 0 ? asked : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

Command render_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("render", "A picture of a mesh or a frame, without a display");
  const auto options = std::make_shared<RenderArguments>();
  app->add_option("mesh", options->mesh, "OFF, PLY, OBJ or STL file")->required();
  expect_png(app->add_option("--out", options->out, "PNG file to write")->required());
  app->add_option("--axis", options->axis, "curve file (JSON) to draw over the mesh, with nodes and names");
  app->add_option("--size", options->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  app->add_option("--view", options->view, "YAW,PITCH in degrees")->capture_default_str();
  app->add_option("--up", options->up, "the axis that points up: x, y, z, -x, -y, -z")->capture_default_str();
  app->add_option("--samples", options->samples, "samples per pixel")->capture_default_str();
  app->add_option("--threads", options->threads, "threads, 0 for all; the picture is the same");
  app->add_flag("--json", options->json, "print JSON");
  return {app, [options] { return render(*options); }};
}

}  // namespace tendril::runner
