// A frame and its queries on a bound mesh, everything counted: the axial hierarchy beside a full update with
// a refit or a rebuild of other hierarchies, on the same poses, on one thread. Arguments: those of
// command_line.h.
#include <tendril/bind/import.h>

#include "bench/clock.h"
#include "bench/collision/hierarchy_peers.h"
#include "bench/collision/plain_tree.h"
#include "bench/command_line.h"
#include "collision/bound_meshes.h"

namespace tendril::bench {
namespace {

using test::BoundMesh;
using Pose = std::vector<CurvePair>;

/// The elephant, or a tube where there are no meshes, along x from 0 to 1.
bind::PolygonMesh animal(const Settings& settings) {
  try {
    return test::along_x(bind::read_mesh(settings.meshes + "/elephant.off"));
  } catch (const std::exception&) {
    return test::tube(100, 28, 0.15);
  }
}

/// Poses about a bend of 0.9 and a twist of 0.6, all different.
std::vector<Pose> poses_of(const BoundMesh& mesh, int count) {
  std::vector<Pose> out;
  for (int i = 0; i < count; ++i) out.push_back({test::bent(mesh.rest[0], 0.9 + 0.01 * i, 0.6 - 0.007 * i)});
  return out;
}

/// The medians of frames, one pose each.
double median(std::vector<double> seconds) {
  std::nth_element(seconds.begin(), seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2),
                   seconds.end());
  return seconds[seconds.size() / 2];
}

template <class Frame>
double frames(std::size_t count, const Frame& frame) {
  std::vector<double> seconds;
  for (std::size_t i = 0; i < count; ++i) {
    const double begin = cpu_seconds();
    frame(i);
    seconds.push_back(cpu_seconds() - begin);
  }
  return median(seconds);
}

struct Case {
  BoundMesh mesh;
  std::vector<Pose> poses;
  std::vector<Vec3> balls;  ///< on the surface of each pose
  double radius = 0.01;
};

Case make_case(const bind::PolygonMesh& surface, int frames) {
  Case out{{{test::straight_pair(8, 0.02)}, surface}, {}, {}};
  out.poses = poses_of(out.mesh, frames);
  test::Random random(1);
  for (const Pose& pose : out.poses) {
    const auto point = static_cast<std::size_t>(random.integer(static_cast<int>(surface.points.size())));
    out.balls.push_back(out.mesh.binding.at(pose, point) + random.in_cube(0.005));
  }
  return out;
}

std::size_t axial_count(collision::AxialHierarchy& hierarchy, const Vec3& centre, double radius) {
  std::size_t found = 0;
  hierarchy.near(centre, radius, [&](const collision::PlacedTriangle& t) {
    found += square_distance(centre, t.corners[0], t.corners[1], t.corners[2]) <= radius * radius;
  });
  return found;
}

std::vector<Vec3> rest_points(const Case& c) {
  return c.mesh.at(c.mesh.rest);
}

/// Median seconds of a frame with a ball;
/// \param counts  of each frame, compared where there are some
double time_peer(const Case& c, NamedPeer& named, std::vector<std::size_t>& counts, Settings& settings) {
  std::vector<Vec3> at(c.mesh.binding.size());
  std::vector<std::size_t> mine(c.poses.size());
  const double seconds = frames(c.poses.size(), [&](std::size_t i) {
    c.mesh.binding.update(c.poses[i], at);
    named.peer->move(at);
    mine[i] = named.peer->count(c.balls[i], c.radius);
  });
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (named.counts ? mine[i] != counts[i] : (mine[i] > 0) != (counts[i] > 0))
      settings.broken.push_back(named.name + " finds other triangles");
  return seconds;
}

OrderedJson ball_frames(const Case& c, Table& table, Settings& settings) {
  OrderedJson json;
  json["triangles"] = c.mesh.triangles.size();
  collision::AxialHierarchy hierarchy(c.mesh.rest, c.mesh.points, c.mesh.triangles);
  std::vector<std::size_t> counts(c.poses.size());
  const double prepare = frames(c.poses.size(), [&](std::size_t i) { hierarchy.pose(c.poses[i]); });
  const double axial = frames(c.poses.size(), [&](std::size_t i) {
    hierarchy.pose(c.poses[i]);
    counts[i] = axial_count(hierarchy, c.balls[i], c.radius);
  });
  json["prepare"] = prepare;
  json["axial"] = axial;
  std::vector<std::string> row{std::to_string(c.mesh.triangles.size()), duration(prepare), duration(axial)};
  const std::vector<Vec3> rest = rest_points(c);
  for (const auto& make : {own_refit, embree_refit, cgal_rebuild, fcl_obbrss_refit}) {
    NamedPeer named = make(rest, c.mesh.triangles);
    if (!named.peer) {
      row.push_back(named.name);
      continue;
    }
    const double seconds = time_peer(c, named, counts, settings);
    json[named.name] = seconds;
    row.push_back(duration(seconds) + " (" + text("%.0f", seconds / axial) + "x)");
  }
  table.row(row);
  return json;
}

bind::PolygonMesh after(bind::PolygonMesh mesh, int times) {
  for (int i = 0; i < times; ++i) mesh = test::subdivided(mesh);
  return mesh;
}

OrderedJson ball_section(Settings& settings) {
  heading("ball",
          "one frame and one ball of 1 % of the length, update of the mesh counted for all but the axial");
  Table table(
      {"triangles", "pose alone", "axial", "own refit", "Embree refit", "CGAL rebuild", "FCL OBBRSS refit"});
  OrderedJson json = OrderedJson::array();
  const bind::PolygonMesh mesh = animal(settings);
  for (const int times : settings.quick ? std::vector<int>{1} : std::vector<int>{1, 2, 4})
    json.push_back(ball_frames(make_case(after(mesh, times), settings.quick ? 3
                                                             : times == 4   ? 15
                                                                            : 25),
                               table, settings));
  table.print();
  return json;
}

/// What is asked of one pose: balls of a size, so many.
struct Load {
  std::string name;
  std::size_t balls;
  double radius;
};

OrderedJson load_frames(const Case& c, const Load& load, Table& table, Settings& settings) {
  collision::AxialHierarchy hierarchy(c.mesh.rest, c.mesh.points, c.mesh.triangles);
  std::vector<Vec3> at = rest_points(c);
  NamedPeer own = own_refit(at, c.mesh.triangles);
  std::vector<std::vector<Vec3>> balls;
  test::Random random(2);
  for (const Pose& pose : c.poses) {
    const std::vector<Vec3> posed = c.mesh.at(pose);
    balls.emplace_back();
    for (std::size_t k = 0; k < load.balls; ++k)
      balls.back().push_back(posed[static_cast<std::size_t>(random.integer(static_cast<int>(posed.size())))]);
  }
  std::vector<std::size_t> mine(c.poses.size()), its(c.poses.size());
  const double axial = frames(c.poses.size(), [&](std::size_t i) {
    hierarchy.pose(c.poses[i]);
    for (const Vec3& ball : balls[i]) mine[i] += axial_count(hierarchy, ball, load.radius);
  });
  const double touched =
      static_cast<double>(hierarchy.work().touched) / static_cast<double>(hierarchy.work().cells);
  const double plain = frames(c.poses.size(), [&](std::size_t i) {
    c.mesh.binding.update(c.poses[i], at);
    own.peer->move(at);
    for (const Vec3& ball : balls[i]) its[i] += own.peer->count(ball, load.radius);
  });
  if (mine != its) settings.broken.push_back("other triangles: " + load.name);
  table.row({std::to_string(c.mesh.triangles.size()), load.name, text("%.3f", touched),
             hierarchy.work().refitted ? "yes" : "no", duration(axial), duration(plain),
             text("%.2f", plain / axial)});
  return {
      {"triangles", c.mesh.triangles.size()}, {"load", load.name}, {"axial", axial}, {"own refit", plain}};
}

OrderedJson load_section(Settings& settings) {
  heading("load", "the axial hierarchy and an own refit as queries touch more of the mesh");
  Table table({"triangles", "balls", "touched", "refitted", "axial", "own refit", "ratio"});
  OrderedJson json = OrderedJson::array();
  const bind::PolygonMesh mesh = animal(settings);
  const std::vector<Load> loads{{"10 of 1 %", 10, 0.01},     {"100 of 1 %", 100, 0.01},
                                {"1000 of 1 %", 1000, 0.01}, {"10000 of 1 %", 10000, 0.01},
                                {"1 of 10 %", 1, 0.1},       {"1 around all", 1, 9.0}};
  for (const int times : settings.quick ? std::vector<int>{1} : std::vector<int>{1, 2, 4}) {
    const Case c = make_case(after(mesh, times), settings.quick ? 3 : 9);
    for (const Load& load : loads) json.push_back(load_frames(c, load, table, settings));
  }
  table.print();
  return json;
}

OrderedJson pose_section(Settings& settings) {
  heading("pose", "what a pose costs before the first query, by the size of the mesh");
  Table table({"triangles", "pose", "slabs"});
  OrderedJson json = OrderedJson::array();
  for (const int side : settings.quick ? std::vector<int>{70} : std::vector<int>{70, 220, 700, 2200}) {
    const Case c = make_case(test::tube(side, side, 0.1), 25);
    collision::AxialHierarchy hierarchy(c.mesh.rest, c.mesh.points, c.mesh.triangles);
    const double seconds = frames(c.poses.size(), [&](std::size_t i) { hierarchy.pose(c.poses[i]); });
    table.row(
        {std::to_string(c.mesh.triangles.size()), duration(seconds), std::to_string(hierarchy.work().slabs)});
    json.push_back({{"triangles", c.mesh.triangles.size()}, {"pose", seconds}});
  }
  table.print();
  return json;
}

}  // namespace
}  // namespace tendril::bench

int main(int argc, char** argv) {
  using namespace tendril::bench;
  return run_bench(
      argc, argv, true, {},
      {{"ball", "ball", ball_section}, {"load", "load", load_section}, {"pose", "pose", pose_section}});
}
