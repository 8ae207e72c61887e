#include <sys/resource.h>
#include <sys/wait.h>
#include <tendril/bind/import.h>
#include <tendril/bind/judge.h>
#include <tendril/curve/fit.h>
#include <unistd.h>

#include <cstdio>
#include <functional>

#include "bench/binding/sections.h"

namespace tendril::bench {
namespace {

struct Run {
  int code = -1;  ///< of the process; -1 where it did not end by itself
  double seconds = 0.0, megabytes = 0.0;
};

Run run_of(const std::function<int()>& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child || !WIFEXITED(status)) return {};
  Run out{WEXITSTATUS(status), 0.0, 1e-6 * 1024.0 * static_cast<double>(used.ru_maxrss)};
  for (const timeval& part : {used.ru_utime, used.ru_stime})
    out.seconds += static_cast<double>(part.tv_sec) + 1e-6 * static_cast<double>(part.tv_usec);
  return out;
}

/// Time on the processor and the most memory of a process of its own, less what it began with. This one does
/// no work, so that it has no free memory to leave to the other.
Run apart(const std::function<int()>& work) {
  const Run idle = run_of([] { return 0; });
  Run out = run_of(work);
  out.megabytes -= idle.megabytes;
  return out;
}

/// A chain along the longest side of the mesh's box, and the same bent by 60 degrees.
std::array<CurvePair, 2> bent_axis(Points points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Eigen::Index along = 0;
  (high - low).maxCoeff(&along);
  const Vec3 x = Vec3::Unit(along), y = Vec3::Unit((along + 1) % 3), middle = 0.5 * (low + high);
  const double length = 0.9 * (high - low)[along], radius = length * 3.0 / 3.141592653589793;
  constexpr int kNodes = 21;
  std::vector<Vec3> rest, posed, rest_side, posed_side;
  const Vec3 side = 0.1 * length * x.cross(y);
  for (int i = 0; i < kNodes; ++i) {
    const double s = length * (i / (kNodes - 1.0) - 0.5), angle = s / radius;
    rest.push_back(middle + s * x);
    posed.push_back(middle + radius * (std::sin(angle) * x + (1.0 - std::cos(angle)) * y));
    rest_side.push_back(rest.back() + side);
    posed_side.push_back(posed.back() + side);
  }
  const Interpolator fit(3, rest);
  return {CurvePair(fit.knots(), fit.solve(rest), fit.solve(rest_side)),
          CurvePair(fit.knots(), fit.solve(posed), fit.solve(posed_side))};
}

}  // namespace

OrderedJson judging_section(Settings& settings) {
  heading("judging",
          "what a verdict on one pose takes, on one thread, memory of the process less what it began with");
  Table table({"mesh", "points", "bound", "seconds", "MB", "verdict"});
  OrderedJson out;
  for (const char* name : {"cube.off", "hand.off", "cactus.off", "camel.off", "elk.off", "bear.off",
                           "dino.off", "diplodocus.off"}) {
    bind::PolygonMesh mesh;
    try {
      mesh = bind::read_mesh(settings.meshes + "/" + name);
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", name, error.what());
      continue;
    }
    const auto [rest, posed] = bent_axis(mesh.points);
    const Run run = apart([&, &axis = rest, &pose = posed] {
      return static_cast<int>(bind::TearJudge({&axis, 1}, mesh, {}).judge({&pose, 1}).verdict);
    });
    if (run.code < 0) settings.broken.push_back(std::string("judging ") + name);
    const char* const said = run.code == static_cast<int>(bind::TearVerdict::tear) ? "tear" : "smooth";
    const std::size_t bound = bind::judge_cost(mesh).points;
    table.row({name, std::to_string(mesh.points.size()), std::to_string(bound), text("%.2f", run.seconds),
               text("%.0f", run.megabytes), said});
    out.push_back({{"mesh", name},
                   {"points", mesh.points.size()},
                   {"bound", bound},
                   {"seconds", run.seconds},
                   {"megabytes", run.megabytes},
                   {"verdict", said}});
  }
  table.print();
  return out;
}

}  // namespace tendril::bench
