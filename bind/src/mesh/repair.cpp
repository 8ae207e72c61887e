#include <tendril/base/error.h>
#include <tendril/bind/repair.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "closed_parts.h"
#include "merge.h"

namespace tendril::bind {
namespace {

using Ids = std::vector<std::uint32_t>;

Ids identity(std::size_t count) {
  Ids ids(count);
  std::iota(ids.begin(), ids.end(), 0U);
  return ids;
}

bool has(const Ids& ascending, std::uint32_t id) {
  return std::binary_search(ascending.begin(), ascending.end(), id);
}

/// A mesh on its way: faces that go are dropped at once, points at the end.
class Mender {
 public:
  explicit Mender(const PolygonMesh& mesh)
      : out_{mesh, identity(mesh.points.size()), identity(mesh.face_count()), {}, {}, {}, {}} {}

  /// \param to  of each point, an earlier one or itself
  void merge_points(const Ids& to) {
    out_.point = to;
    for (std::uint32_t& corner : out_.mesh.corners) corner = out_.point[corner];
    Ids shortened;
    keep_faces([&](std::uint32_t f, const Ids& corners, Ids& face) {
      const std::size_t before = face.size();
      const auto same = [&](std::uint32_t a, std::uint32_t b) { return corners[a] == corners[b]; };
      face.erase(std::unique(face.begin(), face.end(), same), face.end());
      while (face.size() > 1 && same(face.front(), face.back())) face.pop_back();
      if (face.size() < before && face.size() > 2) shortened.push_back(f);
      return face.size() > 2;
    });
    for (const std::uint32_t f : shortened) shortened_.push_back(f);
  }

  /// \param spared  ids before of faces that stay
  void drop_degenerate(const Ids& spared) { drop_faces(inspect(out_.mesh).degenerate_faces, spared); }

  void drop_duplicates(const Ids& spared) {
    Ids faces;
    for (const Duplicate& one : inspect(out_.mesh).duplicate_faces) faces.push_back(one.id);
    drop_faces(faces, spared);
  }

  void orient();
  void drop_isolated();

  Repaired finish() {
    for (const std::uint32_t f : shortened_)
      if (out_.face[f] != kDropped) out_.shortened.push_back(out_.face[f]);
    return std::move(out_);
  }

 private:
  /// One use of an edge by a face.
  struct Use {
    Edge edge;
    std::uint32_t face;
    bool forward;
  };
  /// Two faces across an edge; `agree` when they use it in opposite directions.
  struct Link {
    std::uint32_t face;
    bool agree;
    Edge edge;
  };

  /// Faces that `keep` wants. It is told their ids before, the corners of all faces, and which of these are
  /// the face's, of which it may take some out.
  template <class Keep>
  void keep_faces(const Keep& keep) {
    const PolygonMesh before = std::exchange(out_.mesh, PolygonMesh{});
    out_.mesh.points = before.points;
    out_.mesh.point_normals = before.point_normals;
    out_.mesh.point_colors = before.point_colors;
    out_.mesh.point_texture = before.point_texture;
    Ids now(before.face_count(), kDropped);
    Ids first(before.face_count(), kDropped);
    for (std::uint32_t f = 0; f < out_.face.size(); ++f)
      if (out_.face[f] != kDropped) first[out_.face[f]] = f;
    for (std::uint32_t f = 0; f < before.face_count(); ++f) {
      Ids face(before.face(f).size());
      std::iota(face.begin(), face.end(), before.face_begin[f]);
      if (!keep(first[f], before.corners, face)) continue;
      now[f] = static_cast<std::uint32_t>(out_.mesh.face_count());
      for (const std::uint32_t c : face) {
        out_.mesh.corners.push_back(before.corners[c]);
        if (!before.corner_texture.empty()) out_.mesh.corner_texture.push_back(before.corner_texture[c]);
      }
      out_.mesh.face_begin.push_back(static_cast<std::uint32_t>(out_.mesh.corners.size()));
      if (!before.face_colors.empty()) out_.mesh.face_colors.push_back(before.face_colors[f]);
    }
    for (std::uint32_t& id : out_.face)
      if (id != kDropped) id = now[id];
  }

  void drop_faces(const Ids& ids, const Ids& spared) {
    if (ids.empty()) return;
    std::uint32_t f = 0;
    keep_faces([&](std::uint32_t before, const Ids&, Ids&) { return !has(ids, f++) || has(spared, before); });
  }

  std::vector<std::vector<Link>> links() const;
  bool turns_better(const Ids& part, const std::vector<char>& over, std::size_t turned) const;
  void turn(const std::vector<char>& over);

  Repaired out_;
  Ids shortened_;  ///< ids before
};

/// Neighbours of every face across edges of exactly two different faces.
std::vector<std::vector<Mender::Link>> Mender::links() const {
  std::vector<Use> uses;
  for (std::uint32_t f = 0; f < out_.mesh.face_count(); ++f) {
    const auto face = out_.mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (a != b) uses.push_back({{std::min(a, b), std::max(a, b)}, f, a < b});
    }
  }
  std::sort(uses.begin(), uses.end(),
            [](const Use& a, const Use& b) { return a.edge != b.edge ? a.edge < b.edge : a.face < b.face; });
  std::vector<std::vector<Link>> of(out_.mesh.face_count());
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i + 1;
    while (end < uses.size() && uses[end].edge == uses[i].edge) ++end;
    const Use &a = uses[i], &b = uses[end - 1];
    if (end == i + 2 && a.face != b.face) {
      of[a.face].push_back({b.face, a.forward != b.forward, a.edge});
      of[b.face].push_back({a.face, a.forward != b.forward, a.edge});
    }
    i = end;
  }
  return of;
}

void Mender::orient() {
  const auto links_of = links();
  const std::size_t count = out_.mesh.face_count();
  std::vector<char> over(count, 0), seen(count, 0);
  Ids part;
  std::vector<Ids> inside_out, others;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    if (seen[seed]) continue;
    part.assign(1, seed);
    seen[seed] = 1;
    std::size_t turned = 0;
    for (std::size_t k = 0; k < part.size(); ++k)
      for (const Link& link : links_of[part[k]]) {
        const char wanted = static_cast<char>(link.agree ? over[part[k]] : !over[part[k]]);
        if (seen[link.face]) {
          if (over[link.face] != wanted) out_.one_sided.push_back(link.edge);
          continue;
        }
        seen[link.face] = 1;
        over[link.face] = wanted;
        turned += wanted != 0;
        part.push_back(link.face);
      }
    const bool turns = turns_better(part, over, turned);
    if (turns)
      for (const std::uint32_t f : part) over[f] = !over[f];
    const std::size_t now = turns ? part.size() - turned : turned;
    (2 * now > part.size() ? inside_out : others).push_back(part);
  }
  // What is within a part that was inside out is turned with it: a cavity stays one.
  for (const Ids& outer : inside_out)
    for (const Ids& inner : others)
      if (within(out_.mesh, inner, outer))
        for (const std::uint32_t f : inner) over[f] = !over[f];
  std::sort(out_.one_sided.begin(), out_.one_sided.end());
  out_.one_sided.erase(std::unique(out_.one_sided.begin(), out_.one_sided.end()), out_.one_sided.end());
  turn(over);
}

/// Whether the faces of a part are to be turned the other way round than `over` says: where it is closed, so
/// that it encloses a positive volume; else so that fewer are turned.
bool Mender::turns_better(const Ids& part, const std::vector<char>& over, std::size_t turned) const {
  std::vector<ClosedPart::Face> faces;
  for (const std::uint32_t f : part) faces.push_back({f, over[f] != 0});
  const ClosedPart closed(out_.mesh, faces);
  if (closed.is_closed() && turned == 0 && closed.volume() > 0.0) return false;
  if (closed.is_closed() && !nested(out_.mesh, faces)) return closed.volume() < 0.0;
  return 2 * turned > part.size();
}

void Mender::turn(const std::vector<char>& over) {
  PolygonMesh& mesh = out_.mesh;
  std::vector<char> kept(mesh.points.size(), 0), touched(mesh.points.size(), 0);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    for (const std::uint32_t corner : mesh.face(f)) (over[f] ? touched : kept)[corner] = 1;
    if (!over[f]) continue;
    out_.turned.push_back(f);
    // The first corner stays the first.
    const auto reverse = [&](auto& of_corners) {
      if (!of_corners.empty())
        std::reverse(of_corners.begin() + mesh.face_begin[f] + 1,
                     of_corners.begin() + mesh.face_begin[f + 1]);
    };
    reverse(mesh.corners);
    reverse(mesh.corner_texture);
  }
  for (std::size_t i = 0; i < mesh.point_normals.size(); ++i)
    if (touched[i] && !kept[i]) mesh.point_normals[i] = -mesh.point_normals[i];
}

void Mender::drop_isolated() {
  PolygonMesh& mesh = out_.mesh;
  Ids now(mesh.points.size(), kDropped);
  for (const std::uint32_t corner : mesh.corners) now[corner] = 0;
  std::uint32_t next = 0;
  const auto move = [](auto& attribute, std::size_t to, std::size_t from) {
    if (!attribute.empty()) attribute[to] = attribute[from];
  };
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] == kDropped) continue;
    now[i] = next++;
    move(mesh.points, now[i], i);
    move(mesh.point_normals, now[i], i);
    move(mesh.point_colors, now[i], i);
    move(mesh.point_texture, now[i], i);
  }
  mesh.points.resize(next);
  if (!mesh.point_normals.empty()) mesh.point_normals.resize(next);
  if (!mesh.point_colors.empty()) mesh.point_colors.resize(next);
  if (!mesh.point_texture.empty()) mesh.point_texture.resize(next);
  for (std::uint32_t& corner : mesh.corners) corner = now[corner];
  for (std::uint32_t& id : out_.point) id = now[id];
}

}  // namespace

bool Repaired::changed() const {
  return point != identity(point.size()) || face != identity(face.size()) || !shortened.empty() ||
         !turned.empty();
}

namespace {

/// What is still to be tried.
struct Plan {
  RepairOptions options;
  Ids merge;   ///< of each point, what it becomes
  Ids spared;  ///< faces that stay though they are degenerate or doubled; ascending
};

Repaired mend(const PolygonMesh& mesh, const Plan& plan) {
  Mender mender(mesh);
  mender.merge_points(plan.merge);
  if (plan.options.drop_degenerate) mender.drop_degenerate(plan.spared);
  if (plan.options.drop_duplicates) mender.drop_duplicates(plan.spared);
  if (plan.options.orient) mender.orient();
  if (plan.options.drop_isolated) mender.drop_isolated();
  return mender.finish();
}

/// Whether some count of inspect is larger than it was. What was not to be mended does not count: merging and
/// dropping may bring it about.
bool is_worse(const MeshReport& now, const MeshReport& before, const RepairOptions& asked) {
  return now.duplicate_points.size() > before.duplicate_points.size() ||
         (asked.drop_isolated && now.isolated_points.size() > before.isolated_points.size()) ||
         (asked.drop_degenerate && now.degenerate_faces.size() > before.degenerate_faces.size()) ||
         (asked.drop_duplicates && now.duplicate_faces.size() > before.duplicate_faces.size()) ||
         now.non_manifold_edges.size() > before.non_manifold_edges.size() ||
         now.non_manifold_points.size() > before.non_manifold_points.size() ||
         (asked.orient && now.inconsistent_edges.size() > before.inconsistent_edges.size()) ||
         now.boundary_loops > before.boundary_loops;
}

/// Undoes the merging of the points at which something is wrong now. \return  whether there were any
bool unmerge(const Repaired& now, const MeshReport& report, Plan& plan) {
  std::vector<char> wrong(now.mesh.points.size(), 0);
  for (const std::uint32_t v : report.non_manifold_points) wrong[v] = 1;
  for (const auto* edges : {&report.non_manifold_edges, &report.inconsistent_edges})
    for (const Edge& edge : *edges) wrong[edge[0]] = wrong[edge[1]] = 1;
  for (const std::uint32_t f : report.degenerate_faces)
    for (const std::uint32_t v : now.mesh.face(f)) wrong[v] = 1;
  bool any = false;
  for (std::uint32_t i = 0; i < plan.merge.size(); ++i) {
    const std::uint32_t at = now.point[plan.merge[i]];
    if (plan.merge[i] == i || at == kDropped || !wrong[at]) continue;
    plan.merge[i] = i;
    any = true;
  }
  return any;
}

/// Spares the dropped faces along whose edges the surface is open now. \return  whether there were any
bool spare(const PolygonMesh& before, const Repaired& now, Plan& plan) {
  const std::vector<Edge> open = open_edges(now.mesh);
  const std::size_t count = plan.spared.size();
  for (std::uint32_t f = 0; f < before.face_count(); ++f) {
    if (now.face[f] != kDropped) continue;
    const auto face = before.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = now.point[face[k]], b = now.point[face[(k + 1) % face.size()]];
      if (std::binary_search(open.begin(), open.end(), Edge{std::min(a, b), std::max(a, b)})) {
        plan.spared.push_back(f);
        break;
      }
    }
  }
  std::sort(plan.spared.begin(), plan.spared.end());
  plan.spared.erase(std::unique(plan.spared.begin(), plan.spared.end()), plan.spared.end());
  return plan.spared.size() > count;
}

/// Leaves out the next step that can be left out. \return  false when none is left
bool give_up_a_step(Plan& plan) {
  for (bool* step : {&plan.options.drop_degenerate, &plan.options.drop_duplicates, &plan.options.orient,
                     &plan.options.drop_isolated}) {
    if (!*step) continue;
    *step = false;
    return true;
  }
  const Ids apart = identity(plan.merge.size());
  return std::exchange(plan.merge, apart) != apart;
}

}  // namespace

Repaired repair(const PolygonMesh& mesh, const RepairOptions& options) {
  require_valid(mesh);
  if (!(options.merge_distance >= 0.0 && options.merge_distance <= 0.01))
    throw InvalidInput("merge_distance", std::to_string(options.merge_distance),
                       "a share of the bounding box's diagonal in [0, 0.01]");
  const MeshReport before = inspect(mesh);
  Plan plan{options, identity(mesh.points.size()), {}};
  if (options.merge_points) plan.merge = merge_targets(mesh, options.merge_distance);
  for (;;) {
    Repaired out = mend(mesh, plan);
    out.left = inspect(out.mesh);
    if (!is_worse(out.left, before, options)) return out;
    if (!unmerge(out, out.left, plan) && !spare(mesh, out, plan) && !give_up_a_step(plan)) return out;
  }
}

}  // namespace tendril::bind
