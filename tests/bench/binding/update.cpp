#include <tendril/bind/bindingf.h>
#include <tendril/bind/import.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "bench/binding/plain.h"
#include "bench/binding/sections.h"
#include "bench/clock.h"

namespace tendril::bench {
namespace {

using bind::Binding;
using bind::Bindingf;
using bind::Columns;

template <class T>
struct Arrays {
  std::vector<T> x, y, z;
  explicit Arrays(std::size_t n) : x(n), y(n), z(n) {}
  Columns<T> columns() { return {x, y, z}; }
};

/// Nanoseconds a vertex of every way to the same deformed points.
struct Times {
  std::size_t vertices;
  double update, rows, updatef, rowsf, stream, streamf, de_boor, skin;
  double rest_error_f;
};

/// Times of calls that take turns, so that what else the machine does meets all alike: seconds of the fastest
/// of many rounds, each long enough to be timed.
template <class... Calls>
std::array<double, sizeof...(Calls)> in_turns(std::size_t vertices, const Calls&... calls) {
  const int rounds = vertices > 1000000 ? 9 : 15;
  const double slice = vertices > 1000000 ? 0.0 : 0.01;
  std::array<double, sizeof...(Calls)> best;
  best.fill(std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round) {
    std::size_t k = 0;
    ((best[k] = std::min(best[k], fastest_of_many(1, slice, calls)), ++k), ...);
  }
  for (double& seconds : best) seconds *= 1e9 / static_cast<double>(vertices);
  return best;
}

template <class T>
void time_columns(const std::function<void(const Columns<T>&)>& update, std::size_t n, double& ours,
                  double& machine) {
  Arrays<T> out(n);
  const std::array<std::vector<T>, 4> in{out.x, out.x, out.x, out.x};
  const auto times = in_turns(
      n, [&] { stream(in, out.columns()); }, [&] { update(out.columns()); });
  machine = times[0];
  ours = times[1];
}

Times measure(int spans, std::size_t count, Settings& settings) {
  const CurvePair rest = wavy_pair(spans, 0.3), posed = wavy_pair(spans, 1.0);
  const std::vector<Vec3> points = tube(rest, count);
  const Binding binding(rest, points);
  const Bindingf single(binding);
  const std::size_t n = points.size();
  const std::span<const CurvePair> pose(&posed, 1);
  Times t{n, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  time_columns<double>([&](const Columns<double>& out) { binding.update(pose, out); }, n, t.update, t.stream);
  time_columns<float>([&](const Columns<float>& out) { single.update(pose, out); }, n, t.updatef, t.streamf);

  std::vector<Eigen::Vector3f> rowsf(n);
  std::vector<Vec3> rows(n), naive(n);
  const std::vector<AxialPoint> records(binding.records().begin(), binding.records().end());
  const Skin skin = make_skin(points, 32);
  const auto times = in_turns(
      n, [&] { single.update(pose, rowsf); }, [&] { binding.update(posed, rows); },
      [&] { skin_loop(skin, naive); }, [&] { de_boor_loop(posed, records, naive); });
  t.rowsf = times[0];
  t.rows = times[1];
  t.skin = times[2];
  t.de_boor = times[3];
  single.update({&rest, 1}, rowsf);
  double off = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    t.rest_error_f = std::max(t.rest_error_f, (rowsf[i].cast<double>() - points[i]).norm() / 10);
    off = std::max(off, (rows[i] - naive[i]).norm());
  }
  if (!(off < 1e-11)) settings.broken.push_back("update differs from de Boor's by " + text("%.1e", off));
  if (!(binding.report().rest_error < 1e-12)) settings.broken.push_back("rest shape lost");
  if (!(t.rest_error_f < 1e-6)) settings.broken.push_back("rest shape lost in single precision");
  return t;
}

}  // namespace

CurvePair wavy_pair(int spans, double wave) {
  const KnotVector knots = KnotVector::uniform(3, spans + 3);
  std::vector<Vec3> u, v;
  for (int i = 0; i < spans + 3; ++i) {
    const double s = 10.0 * i / (spans + 2);
    u.emplace_back(s, wave * std::sin(0.9 * s), wave * std::cos(0.7 * s));
    v.push_back(u.back() + Vec3(0, 0.1, 0.5));
  }
  return {knots, u, v};
}

std::vector<Vec3> tube(const CurvePair& axis, std::size_t count) {
  const auto around = static_cast<std::size_t>(std::sqrt(static_cast<double>(count) / 8.0));
  const std::size_t along = count / around;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < along; ++i) {
    const CurveFrame at = axis.frame(static_cast<double>(i) / static_cast<double>(along - 1));
    for (std::size_t k = 0; k < around; ++k) {
      const double angle = 6.283185307179586 * static_cast<double>(k) / static_cast<double>(around);
      points.push_back(at.origin + 0.4 * std::cos(angle) * at.frame.x + 0.3 * std::sin(angle) * at.frame.y);
    }
  }
  return points;
}

OrderedJson update_section(Settings& settings) {
  heading("update", "nanoseconds a vertex, 32 spans; stream: four arrays read and three written, no more");
  const std::size_t large = settings.quick ? 1000000 : 5000000;
  const std::vector<Times> all{measure(32, 24000, settings), measure(32, large, settings)};
  Table table({"vertices", "", "binding order", "points' order", "stream", "of the stream's rate",
               "de Boor / ours", "skinning / ours"});
  OrderedJson out;
  for (const Times& t : all) {
    const auto row = [&](const char* precision, double update, double rows, double machine) {
      table.row({std::to_string(t.vertices), precision, text("%.2f", update), text("%.2f", rows),
                 text("%.2f", machine), text("%.0f %%", 100 * machine / update),
                 text("%.1f", t.de_boor / update), text("%.1f", t.skin / update)});
      out["times"].push_back({{"vertices", t.vertices},
                              {"precision", precision},
                              {"ns", update},
                              {"ns_in_points_order", rows},
                              {"stream_ns", machine},
                              {"de_boor_ns", t.de_boor},
                              {"skinning_ns", t.skin}});
    };
    row("f64", t.update, t.rows, t.stream);
    row("f32", t.updatef, t.rowsf, t.streamf);
  }
  table.print();
  std::printf("single precision at rest: within %.1e of the size\n", all[1].rest_error_f);
  const double arap = arap_seconds(settings, "diplodocus.off");
  if (arap > 0.0) {
    const bind::PolygonMesh mesh = bind::read_mesh(settings.meshes + "/diplodocus.off");
    const double ours = 1e-9 * all[0].rows * static_cast<double>(mesh.points.size());
    std::printf("CGAL's ARAP deformation of diplodocus, 5 iterations: %s a frame, %.0f times an update\n",
                duration(arap).c_str(), arap / ours);
    out["arap_over_update"] = arap / ours;
  }
  return out;
}

OrderedJson transpose_section(Settings& settings) {
  heading("transpose", "nanoseconds a vertex, f64, 32 spans; forces and points in the points' order");
  Table table({"vertices", "update", "transpose", "ratio"});
  OrderedJson out;
  for (const std::size_t count : {std::size_t{24000}, std::size_t{settings.quick ? 1000000u : 5000000u}}) {
    const CurvePair rest = wavy_pair(32, 0.3), posed = wavy_pair(32, 1.0);
    const std::vector<Vec3> points = tube(rest, count);
    const Binding binding(rest, points);
    std::vector<Vec3> rows(points.size()), forces(points.size());
    Vec3 sum = Vec3::Zero();
    double size = 0.0;
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const double k = static_cast<double>(i % 1000);
      sum += forces[i] = Vec3(std::sin(k), std::cos(2 * k), std::sin(3 * k));
      size += forces[i].norm();
    }
    std::vector<ControlForces> g;
    const auto [forward, back] = in_turns(
        points.size(), [&] { binding.update(posed, rows); },
        [&] {
          g = binding.pull_back({&posed, 1}, forces);
        });
    for (const Vec3& f : g[0].primary) sum -= f;
    for (const Vec3& f : g[0].orientation) sum -= f;
    if (!(sum.norm() < 1e-12 * size)) settings.broken.push_back("the transpose loses force");
    table.row({std::to_string(points.size()), text("%.2f", forward), text("%.2f", back),
               text("%.2f", back / forward)});
    out.push_back({{"vertices", points.size()}, {"update_ns", forward}, {"transpose_ns", back}});
  }
  table.print();
  return out;
}

}  // namespace tendril::bench
