#include <tendril/exact/bound_surface.h>

#include <algorithm>

#include "accuracy/collision/suite.h"
#include "collision/bound_meshes.h"
#include "collision/mesh_truth.h"

// Meshes that follow curve-pairs, bent, folded, twisted and thrown about, asked through the axial hierarchy
// and through a hierarchy refitted to the whole mesh updated, against brute force over all triangles of that
// mesh.
namespace tendril::suite {
namespace {

using collision::Relation;
using exact::Meeting;
using exact::Nearest;
using exact::Shape;
using test::BoundMesh;
using test::MeshTruth;
using test::Pose;
using test::Random;

constexpr long kQueriesAPose = 50;

enum class Kind { shape, inside, nearest };

struct Query {
  Kind kind;
  Shape shape;
};

Query next(Points at, int number, Random& random) {
  const auto somewhere = [&]() -> Vec3 {
    const Vec3& on = at[static_cast<std::size_t>(random.integer(static_cast<int>(at.size())))];
    if (random.integer(8) == 0) return on;
    return on + random.in_cube(std::exp(random.uniform(-6.0, 0.0)));
  };
  const Vec3 a = somewhere(), b = somewhere(), c = somewhere();
  switch (number % 5) {
    case 0:
      return {Kind::shape, exact::ball(a, 0.3 * (a - b).norm())};
    case 1:
      return {Kind::shape, exact::segment({a, b})};
    case 2:
      return {Kind::shape, exact::triangle({a, b, c})};
    case 3:
      return {Kind::inside, exact::point(a)};
    default:
      return {Kind::nearest, number % 2 == 0 ? exact::point(a) : exact::ball(a, 0.1 * (a - b).norm())};
  }
}

/// What was found, and what there is.
struct Answer {
  std::vector<Meeting> meetings;
  Relation side = Relation::free;
  Nearest nearest;
};

template <class Surface>
Answer ask(Surface& surface, const Query& query) {
  Answer out;
  if (query.kind == Kind::shape) out.meetings = surface.meetings(query.shape);
  if (query.kind == Kind::inside) out.side = surface.inside(query.shape.points[0]).answer.relation;
  if (query.kind == Kind::nearest) out.nearest = surface.nearest(query.shape);
  return out;
}

Answer brute_force(const MeshTruth& mesh, const Query& query) {
  Answer out;
  if (query.kind == Kind::inside) out.side = mesh.inside(query.shape.points[0]);
  if (query.kind == Kind::inside) return out;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Shape t = exact::triangle(mesh.corners(mesh.triangles()[i]));
    if (query.kind == Kind::shape) {
      const Relation r = exact::relation(query.shape, t).relation;
      if (r != Relation::free) out.meetings.push_back({i, 0, r});
    } else {
      const exact::Distance d = exact::distance(query.shape, t);
      if (i == 0 || d.upper < out.nearest.distance.upper) out.nearest = {d, i};
    }
  }
  return out;
}

/// All of `some` are in `all`, by triangle.
bool held(const std::vector<Meeting>& some, const std::vector<Meeting>& all) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end(),
                       [](const Meeting& a, const Meeting& b) { return a.triangle < b.triangle; });
}

void count(const Query& query, const Answer& said, const Answer& truth, Row& row) {
  ++row.queries;
  switch (query.kind) {
    case Kind::shape:
      row.positive += !truth.meetings.empty();
      row.missed += !held(truth.meetings, said.meetings);
      row.invented += !held(said.meetings, truth.meetings);
      row.wrong += held(truth.meetings, said.meetings) && held(said.meetings, truth.meetings) &&
                   said.meetings != truth.meetings;
      return;
    case Kind::inside:
      row.positive += truth.side != Relation::free;
      row.undecided += said.side == Relation::undecidable;
      row.missed += said.side == Relation::free && truth.side != Relation::free;
      row.invented += said.side != Relation::free && truth.side == Relation::free;
      row.wrong += said.side != truth.side && said.side != Relation::free && truth.side != Relation::free;
      return;
    case Kind::nearest:
      row.positive += truth.nearest.distance.upper == 0.0;
      row.wrong += said.nearest.triangle != truth.nearest.triangle ||
                   said.nearest.distance.lower != truth.nearest.distance.lower ||
                   said.nearest.distance.upper != truth.nearest.distance.upper;
  }
}

std::vector<std::uint32_t> flat(std::span<const collision::Triangle> triangles) {
  std::vector<std::uint32_t> out;
  for (const collision::Triangle& t : triangles) out.insert(out.end(), t.begin(), t.end());
  return out;
}

/// One pose and its queries.
void judge_pose(const BoundMesh& mesh, const Pose& pose, long queries, Random& random,
                exact::BoundSurface& axial, exact::Surface& whole, Row& axial_row, Row& whole_row) {
  std::vector<Vec3> at = mesh.at(pose);
  std::vector<Query> asked;
  for (long i = 0; i < queries; ++i) asked.push_back(next(at, static_cast<int>(i), random));
  std::vector<Answer> found, plainly;
  axial_row.us += 1e6 * bench::fastest(1, [&] {
                    axial.pose(pose);
                    for (const Query& q : asked) found.push_back(ask(axial, q));
                  });
  whole_row.us += 1e6 * bench::fastest(1, [&] {
                    mesh.binding.update(pose, at);
                    whole.refit(at);
                    for (const Query& q : asked) plainly.push_back(ask(whole, q));
                  });
  const MeshTruth truth(at, mesh.triangles);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Answer brute = brute_force(truth, asked[i]);
    count(asked[i], found[i], brute, axial_row);
    count(asked[i], plainly[i], brute, whole_row);
  }
}

void judge_mesh(const char* name, const BoundMesh& mesh, const Settings& settings, std::vector<Row>& rows) {
  Random random(settings.seed);
  exact::BoundSurface axial(mesh.rest, mesh.points, mesh.triangles);
  exact::Surface whole(mesh.at(mesh.rest), flat(mesh.triangles));
  Row axial_row{"bound", name, "tendril"}, whole_row{"bound", name, "tendril, whole mesh"};
  for (long left = settings.count; left > 0; left -= kQueriesAPose)
    judge_pose(mesh, test::random_pose(mesh.rest, random), std::min(left, kQueriesAPose), random, axial,
               whole, axial_row, whole_row);
  for (Row* row : {&axial_row, &whole_row}) {
    row->us /= static_cast<double>(row->queries);
    rows.push_back(*row);
  }
}

}  // namespace

void bound_section(const Settings& settings, std::vector<Row>& rows) {
  judge_mesh("tube", {{test::straight_pair(8, 0.05)}, test::tube(24, 16, 0.1)}, settings, rows);
  judge_mesh("leaf", {{test::straight_pair(6, 0.0)}, test::leaf(24, 16)}, settings, rows);
  judge_mesh("tube on three curve-pairs", test::bound_to_three(), settings, rows);
  judge_mesh("long tube", {{test::straight_pair(20, 0.05)}, test::tube(60, 10, 0.04)}, settings, rows);
}

}  // namespace tendril::suite
