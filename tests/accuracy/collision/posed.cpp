#include <tendril/exact/bound_surface.h>

#include <algorithm>

#include "accuracy/collision/suite.h"
#include "collision/bound_meshes.h"
#include "collision/mesh_truth.h"

// A mesh that follows its curve-pairs from pose to pose, with a few balls and points asked of each: tendril
// deforms what they touch, other libraries are handed the whole mesh updated.
namespace tendril::suite {
namespace {

using collision::Relation;
using test::BoundMesh;
using test::MeshTruth;
using test::Pose;
using test::Random;

constexpr long kQueriesAPose = 10;

/// A ball, or a point where the radius is 0.
struct Query {
  Vec3 centre;
  double radius;
  bool ball() const { return radius > 0.0; }
};

Query next(Points at, long number, Random& random) {
  const Vec3& on = at[static_cast<std::size_t>(random.integer(static_cast<int>(at.size())))];
  const double far = std::exp(random.uniform(-6.0, -1.0));
  return {on + random.in_cube(far), number % 2 == 0 ? random.uniform(0.1, 1.0) * far : 0.0};
}

/// One pose, and what is truly so of it.
struct Frame {
  Pose pose;
  std::vector<Query> queries;
  std::vector<char> truth;
};

std::vector<Frame> frames_of(const BoundMesh& mesh, const Settings& settings) {
  Random random(settings.seed);
  std::vector<Frame> out;
  for (long left = settings.count; left > 0; left -= kQueriesAPose) {
    Frame frame{test::random_pose(mesh.rest, random), {}, {}};
    const std::vector<Vec3> at = mesh.at(frame.pose);
    const MeshTruth exact(at, mesh.triangles);
    for (long i = 0; i < std::min(left, kQueriesAPose); ++i) {
      // Where a folded mesh covers a place twice, libraries that count crossings mean something else by
      // inside.
      Query query = next(at, i, random);
      while (!query.ball() && exact.is_gone_round_evenly(query.centre)) query = next(at, i, random);
      frame.queries.push_back(query);
      const auto& [centre, radius] = query;
      const Relation r = radius > 0.0 ? exact.ball(centre, radius) : exact.inside(centre);
      frame.truth.push_back(r != Relation::free);
    }
    out.push_back(std::move(frame));
  }
  return out;
}

void count(const Frame& frame, const std::vector<Said>& said, Row& row) {
  for (std::size_t i = 0; i < said.size(); ++i) {
    ++row.queries;
    row.positive += frame.truth[i];
    row.undecided += !said[i];
    row.missed += said[i] && !*said[i] && frame.truth[i];
    row.invented += said[i] && *said[i] && !frame.truth[i];
  }
}

/// \param answer  of a frame: what is said of its queries; timed
template <class Answer>
Row judge_frames(Row row, const std::vector<Frame>& frames, const Answer& answer) {
  double seconds = 0.0;
  for (const Frame& frame : frames) {
    std::vector<Said> said;
    seconds += bench::fastest(1, [&] { said = answer(frame); });
    count(frame, said, row);
  }
  row.us = 1e6 * seconds / static_cast<double>(row.queries);
  return row;
}

Said said(const exact::Answer& answer) {
  if (answer.relation == Relation::undecidable) return {};
  return answer.relation != Relation::free;
}

Row judge_axial(const char* family, const BoundMesh& mesh, const std::vector<Frame>& frames) {
  exact::BoundSurface surface(mesh.rest, mesh.points, mesh.triangles);
  return judge_frames({"posed", family, "tendril"}, frames, [&](const Frame& frame) {
    surface.pose(frame.pose);
    std::vector<Said> out;
    for (const Query& q : frame.queries)
      out.push_back(said(q.ball() ? surface.relation(exact::ball(q.centre, q.radius))
                                  : surface.inside(q.centre).answer));
    return out;
  });
}

Row judge_peer(const char* family, const Adapter& adapter, const BoundMesh& mesh,
               const std::vector<Frame>& frames) {
  std::vector<Vec3> at(mesh.binding.size());
  return judge_frames({"posed", family, adapter.name}, frames, [&](const Frame& frame) {
    mesh.binding.update(frame.pose, at);
    const auto peer = adapter.mesh(at, mesh.triangles);
    std::vector<Said> out;
    for (const Query& q : frame.queries)
      out.push_back(q.ball() ? peer->meets(q.centre, q.radius) : peer->holds(q.centre));
    return out;
  });
}

void judge_mesh(const char* family, const BoundMesh& mesh, const Settings& settings, std::vector<Row>& rows) {
  const std::vector<Frame> frames = frames_of(mesh, settings);
  rows.push_back(judge_axial(family, mesh, frames));
  for (const Adapter& adapter : adapters())
    if (adapter.mesh && adapter.name != "tendril") rows.push_back(judge_peer(family, adapter, mesh, frames));
}

}  // namespace

void posed_section(const Settings& settings, std::vector<Row>& rows) {
  judge_mesh("tube", {{test::straight_pair(8, 0.05)}, test::tube(40, 24, 0.1)}, settings, rows);
  judge_mesh("leaf", {{test::straight_pair(6, 0.0)}, test::leaf(40, 32)}, settings, rows);
  judge_mesh("tube on three curve-pairs", test::bound_to_three(), settings, rows);
}

}  // namespace tendril::suite
