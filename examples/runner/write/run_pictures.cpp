#include "write/run_pictures.h"

#include "draw/drawing.h"
#include "draw/solid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <span>
#include <thread>

namespace tendril::runner {
namespace {

constexpr double kThinnest = 0.003;  // radius of a line over the size of what is seen

constexpr bind::Color kMark{201, 74, 40, 255};

class Painter {
 public:
  Painter(const scene::SceneRun& run, const Camera& camera, const PictureOptions& options)
      : run_(run), file_(run.file()), camera_(camera) {
    if (run.mesh() == nullptr) return;
    mesh_ = run.mesh()->mesh();
    if (!options.mark_ambiguous) return;
    mesh_ = colored(std::move(mesh_));
    for (const std::uint32_t i : run.mesh()->binding().report().ambiguous) mesh_.point_colors[i] = kMark;
  }

  /// The same picture on any number of threads.
  Picture paint(const scene::Snapshot& moment, const scene::ViewOptions& view, int threads) {
    Drawing drawing;
    if (!moment.points.empty()) {
      mesh_.points = moment.points;
      drawing.mesh = &mesh_;
    }
    for (std::size_t r = 0; r < moment.pairs.size(); ++r) {
      const double thin = kThinnest * camera_.size;
      const std::vector<Strand> axis = axis_strands(moment.pairs[r], moment.masses[r], thin);
      const bool hidden = std::find(file_.bound_to.begin(), file_.bound_to.end(), r) != file_.bound_to.end();
      if (drawing.mesh == nullptr || !hidden) {
        drawing.solid.push_back(
            rod_strand(moment.pairs[r], run_.simulation().parameters(r), file_.scene.rods[r].width, thin));
      }
      if (file_.draw_axis) drawing.over.insert(drawing.over.end(), axis.begin(), axis.end());
    }
    bind::PolygonMesh all;
    if (!moment.bodies.empty()) {
      if (drawing.mesh != nullptr) all = colored(mesh_);
      for (std::size_t i = 0; i < moment.bodies.size(); ++i)
        add_solid(file_.bodies[i].shape, moment.bodies[i], camera_.centre, camera_.size, all);
      drawing.mesh = &all;
    }
    return draw(drawing, camera_, view, threads);
  }

 private:
  /// The mesh with a color at every point, as solids have.
  static bind::PolygonMesh colored(bind::PolygonMesh mesh) {
    if (mesh.point_colors.empty()) mesh.point_colors.assign(mesh.points.size(), {176, 161, 146, 255});
    mesh.face_colors.clear();
    return mesh;
  }

  const scene::SceneRun& run_;
  const scene::SceneFile& file_;
  bind::PolygonMesh mesh_;  ///< moved from moment to moment
  Camera camera_;
};

/// Makes pictures 0 to count - 1, several at a time: trees of rays, normals and PNG are made on one thread
/// each. Asks `go_on` on this thread, before each picture that it makes itself.
/// \param make  by a painter of the thread's own, for the picture of an index, on so many threads
/// \return  whether all were made
bool for_each_picture(const Painter& painter, std::size_t count, int threads,
                      const std::function<bool(double part)>& go_on,
                      const std::function<void(Painter&, std::size_t, int)>& make) {
  const int at_once = std::clamp(static_cast<int>(std::min<std::size_t>(count, 1024)), 1, threads);
  const int each = threads / at_once;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  std::vector<std::exception_ptr> failed(static_cast<std::size_t>(at_once));
  const auto work = [&](int which) {
    try {
      Painter own = painter;
      for (std::size_t k = next++; k < count && !stopped; k = next++) {
        if (which == 0 && !go_on(static_cast<double>(k) / static_cast<double>(count))) stopped = true;
        if (!stopped) make(own, k, each);
      }
    } catch (...) {
      failed[static_cast<std::size_t>(which)] = std::current_exception();
      stopped = true;
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int which = 1; which < at_once; ++which) helpers.emplace_back(work, which);
    work(0);
  }
  for (const std::exception_ptr& e : failed)
    if (e) std::rethrow_exception(e);
  return !stopped;
}

std::string caption(double time) {
  char text[32];
  const int hundredths = static_cast<int>(std::lround(std::min(time, 1e6) * 100.0));
  std::snprintf(text, sizeof text, "t = %d.%02d", hundredths / 100, hundredths % 100);
  return text;
}

scene::ViewOptions panel_view(scene::ViewOptions view) {
  view.width = std::max(16, view.width / 2);
  view.height = std::max(16, view.height / 2);
  return view;
}

}  // namespace

bool draw_run(const scene::SceneRun& run, Recorder& recorder, const PictureOptions& options,
              const std::function<bool(double)>& go_on) {
  const scene::ViewOptions& view = run.file().view;
  Painter painter(run, recorder.camera(), options);
  const scene::ViewOptions small = panel_view(view);
  // A run that stopped may have come to none of the outputs that the sheet shows.
  std::span<const scene::Snapshot> moments = recorder.panels();
  if (moments.empty()) moments = {&recorder.last(), 1};
  std::vector<Picture> panels(moments.size(), Picture(0, 0));
  const auto paint = [&](Painter& own, std::size_t k, int threads) {
    panels[k] = own.paint(moments[k], small, threads);
  };
  if (!for_each_picture(painter, panels.size(), options.threads, go_on, paint)) return false;
  std::vector<std::string> captions;
  for (const scene::Snapshot& moment : moments) captions.push_back(caption(moment.time));
  const Picture last = painter.paint(recorder.last(), view, options.threads);
  if (!go_on(1.0)) return false;
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(panels.size()))));
  recorder.write("contact_sheet.png", png_bytes(contact_sheet(panels, captions, columns)));
  recorder.write("final.png", png_bytes(last));
  return true;
}

std::vector<std::string> draw_moments(const scene::SceneRun& run, const Recorder& recorder, std::size_t count,
                                      const std::function<scene::Snapshot(std::size_t)>& moment,
                                      const PictureOptions& options,
                                      const std::function<bool(double part)>& go_on) {
  const scene::ViewOptions view = panel_view(run.file().view);
  std::vector<std::string> out(count);
  const auto paint = [&](Painter& own, std::size_t m, int threads) {
    out[m] = png_bytes(own.paint(moment(m), view, threads));
  };
  if (!for_each_picture({run, recorder.camera(), options}, count, options.threads, go_on, paint)) return {};
  return out;
}

}  // namespace tendril::runner
