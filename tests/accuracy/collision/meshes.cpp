#include <tendril/exact/surface.h>

#include "accuracy/collision/suite.h"
#include "collision/bound_meshes.h"
#include "collision/made_meshes.h"
#include "collision/mesh_truth.h"

// Points within meshes and balls on them, against all triangles in whole numbers.
namespace tendril::suite {
namespace {

using collision::Relation;
using collision::Triangle;
using test::MeshTruth;
using test::Random;

struct Mesh {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

/// Points that coincide made one, for libraries that know neighbours by index.
Mesh mesh_of(const test::MadeMesh& made) {
  Mesh out;
  std::vector<std::uint32_t> now;
  for (const Vec3& x : made.points) {
    const auto known = std::find(out.points.begin(), out.points.end(), x);
    now.push_back(static_cast<std::uint32_t>(known - out.points.begin()));
    if (known == out.points.end()) out.points.push_back(x);
  }
  for (std::size_t i = 0; i < made.corners.size(); i += 3)
    out.triangles.push_back({now[made.corners[i]], now[made.corners[i + 1]], now[made.corners[i + 2]]});
  return out;
}

/// A tube bent and twisted by its curve-pair, not so far that it folds.
Mesh bent_tube() {
  const test::BoundMesh bound{{test::straight_pair(8, 0.05)}, test::tube(24, 16, 0.1)};
  return {bound.at({test::bent(bound.rest[0], 1.5, 2.0)}), bound.triangles};
}

struct Ball {
  Vec3 centre;
  double radius;
};

/// A mesh and a way to make the next ball, of which points are the centres.
struct Family {
  std::string name;
  Mesh mesh;
  Ball (*next)(const Mesh&, Random&);
};

Ball on_grid(const Mesh&, Random& random) {
  Vec3 x;
  for (double& c : x) c = 0.25 * (random.integer(11) - 5);
  return {x, 0.25 * (1 + random.integer(4))};
}

Ball anywhere(const Mesh& mesh, Random& random) {
  const Vec3& near =
      mesh.points[static_cast<std::size_t>(random.integer(static_cast<int>(mesh.points.size())))];
  const double far = std::exp(random.uniform(-5.0, 0.3));
  return {near + random.in_cube(far), random.uniform(0.0, far)};
}

/// Points of faces as well as doubles can say, or a hair off; balls that touch where they do not miss by a
/// hair.
Ball on_face(const Mesh& mesh, Random& random) {
  const Triangle& t =
      mesh.triangles[static_cast<std::size_t>(random.integer(static_cast<int>(mesh.triangles.size())))];
  const double s = random.uniform(), r = random.uniform() * (1 - s);
  const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
  const int kind = random.integer(3);
  if (kind == 0) return {a, 1e-9};
  const Vec3 x = a + s * (b - a) + r * (c - a);
  if (kind == 1) return {x, 1e-16};
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const double off = random.uniform(-0.01, 0.01);
  return {x + off * normal, std::abs(off)};
}

std::vector<Family> families() {
  return {{"cube on its grid", mesh_of(test::cube(4)), on_grid},
          {"wavy ball", mesh_of(test::wavy_ball(10)), anywhere},
          {"wavy ball, on its faces, rounded", mesh_of(test::wavy_ball(10)), on_face},
          {"bent tube", bent_tube(), anywhere},
          {"bent tube, on its faces, rounded", bent_tube(), on_face}};
}

std::vector<Ball> balls_of(const Family& family, const Settings& settings) {
  Random random(settings.seed);
  std::vector<Ball> out;
  for (long i = 0; i < settings.count; ++i) out.push_back(family.next(family.mesh, random));
  return out;
}

std::vector<char> meeting(const std::vector<Relation>& truth) {
  std::vector<char> out;
  for (const Relation r : truth) out.push_back(r != Relation::free);
  return out;
}

exact::Surface surface_of(const Mesh& mesh) {
  return {mesh.points, {mesh.triangles.front().data(), 3 * mesh.triangles.size()}};
}

/// \return  balls whose relation is not the true one, with the surface or with what it encloses
long wrong_balls(const Mesh& mesh, const MeshTruth& truth, const std::vector<Ball>& balls,
                 const std::vector<Relation>& surface) {
  const exact::Surface own = surface_of(mesh);
  long wrong = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const auto& [centre, radius] = balls[i];
    const Relation centre_in = surface[i] == Relation::hit ? Relation::free : truth.inside(centre);
    const Relation solid = std::max(surface[i], centre_in);
    wrong += own.relation(exact::ball(centre, radius)).relation != surface[i] ||
             own.solid_relation(centre, radius).relation != solid;
  }
  return wrong;
}

}  // namespace

void inside_section(const Settings& settings, std::vector<Row>& rows) {
  for (const Family& family : families()) {
    const MeshTruth exact(family.mesh.points, family.mesh.triangles);
    const std::vector<Ball> balls = balls_of(family, settings);
    std::vector<Relation> truth;
    for (const Ball& ball : balls) truth.push_back(exact.inside(ball.centre));
    for (const Adapter& adapter : adapters()) {
      if (!adapter.holds) continue;
      const auto peer = adapter.mesh(family.mesh.points, family.mesh.triangles);
      Row row =
          judge({"inside", family.name, adapter.name}, balls, meeting(truth),
                std::vector<char>(balls.size(), 1), [&](const Ball& b) { return peer->holds(b.centre); });
      if (row.own()) {
        const exact::Surface own = surface_of(family.mesh);
        for (std::size_t i = 0; i < balls.size(); ++i)
          row.wrong += own.inside(balls[i].centre).answer.relation != truth[i];
      }
      rows.push_back(row);
    }
  }
}

void balls_section(const Settings& settings, std::vector<Row>& rows) {
  for (const Family& family : families()) {
    const MeshTruth exact(family.mesh.points, family.mesh.triangles);
    const std::vector<Ball> balls = balls_of(family, settings);
    std::vector<Relation> truth;
    for (const auto& [centre, radius] : balls) truth.push_back(exact.ball(centre, radius));
    for (const Adapter& adapter : adapters()) {
      if (!adapter.meets) continue;
      const auto peer = adapter.mesh(family.mesh.points, family.mesh.triangles);
      Row row = judge({"balls", family.name, adapter.name}, balls, meeting(truth),
                      std::vector<char>(balls.size(), 1),
                      [&](const Ball& b) { return peer->meets(b.centre, b.radius); });
      if (row.own()) row.wrong = wrong_balls(family.mesh, exact, balls, truth);
      rows.push_back(row);
    }
  }
}

}  // namespace tendril::suite
