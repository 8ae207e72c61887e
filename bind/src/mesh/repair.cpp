#include <tendril/bind/repair.h>

#include <algorithm>
#include <numeric>
#include <utility>

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
      : out_{mesh, identity(mesh.points.size()), identity(mesh.face_count()), {}, {}, {}} {}

  void merge_points() {
    for (const Duplicate& one : inspect(out_.mesh).duplicate_points) out_.point[one.id] = one.first;
    for (std::uint32_t& corner : out_.mesh.corners) corner = out_.point[corner];
    Ids shortened;
    keep_faces([&](std::uint32_t f, Ids& face) {
      const std::size_t before = face.size();
      face.erase(std::unique(face.begin(), face.end()), face.end());
      while (face.size() > 1 && face.front() == face.back()) face.pop_back();
      if (face.size() < before && face.size() > 2) shortened.push_back(f);
      return face.size() > 2;
    });
    for (const std::uint32_t f : shortened) shortened_.push_back(f);
  }

  void drop_degenerate() { drop_faces(inspect(out_.mesh).degenerate_faces); }

  void drop_duplicates() {
    Ids faces;
    for (const Duplicate& one : inspect(out_.mesh).duplicate_faces) faces.push_back(one.id);
    drop_faces(faces);
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

  /// Faces that `keep` wants, as it leaves their corners; it is told their ids before.
  template <class Keep>
  void keep_faces(const Keep& keep) {
    const PolygonMesh before = std::exchange(out_.mesh, PolygonMesh{});
    out_.mesh.points = before.points;
    out_.mesh.point_normals = before.point_normals;
    out_.mesh.point_colors = before.point_colors;
    Ids now(before.face_count(), kDropped);
    Ids first(before.face_count(), kDropped);
    for (std::uint32_t f = 0; f < out_.face.size(); ++f)
      if (out_.face[f] != kDropped) first[out_.face[f]] = f;
    for (std::uint32_t f = 0; f < before.face_count(); ++f) {
      const auto corners = before.face(f);
      Ids face(corners.begin(), corners.end());
      if (!keep(first[f], face)) continue;
      now[f] = static_cast<std::uint32_t>(out_.mesh.face_count());
      out_.mesh.corners.insert(out_.mesh.corners.end(), face.begin(), face.end());
      out_.mesh.face_begin.push_back(static_cast<std::uint32_t>(out_.mesh.corners.size()));
      if (!before.face_colors.empty()) out_.mesh.face_colors.push_back(before.face_colors[f]);
    }
    for (std::uint32_t& id : out_.face)
      if (id != kDropped) id = now[id];
  }

  void drop_faces(const Ids& ids) {
    if (ids.empty()) return;
    std::uint32_t f = 0;
    keep_faces([&](std::uint32_t, Ids&) { return !has(ids, f++); });
  }

  std::vector<std::vector<Link>> links() const;
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
    if (2 * turned > part.size())
      for (const std::uint32_t f : part) over[f] = !over[f];
  }
  std::sort(out_.one_sided.begin(), out_.one_sided.end());
  out_.one_sided.erase(std::unique(out_.one_sided.begin(), out_.one_sided.end()), out_.one_sided.end());
  turn(over);
}

void Mender::turn(const std::vector<char>& over) {
  PolygonMesh& mesh = out_.mesh;
  std::vector<char> kept(mesh.points.size(), 0), touched(mesh.points.size(), 0);
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    for (const std::uint32_t corner : mesh.face(f)) (over[f] ? touched : kept)[corner] = 1;
    if (!over[f]) continue;
    out_.turned.push_back(f);
    // The first corner stays the first.
    std::reverse(mesh.corners.begin() + mesh.face_begin[f] + 1,
                 mesh.corners.begin() + mesh.face_begin[f + 1]);
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
  }
  mesh.points.resize(next);
  if (!mesh.point_normals.empty()) mesh.point_normals.resize(next);
  if (!mesh.point_colors.empty()) mesh.point_colors.resize(next);
  for (std::uint32_t& corner : mesh.corners) corner = now[corner];
  for (std::uint32_t& id : out_.point) id = now[id];
}

}  // namespace

bool Repaired::changed() const {
  return point != identity(point.size()) || face != identity(face.size()) || !shortened.empty() ||
         !turned.empty();
}

Repaired repair(const PolygonMesh& mesh, const RepairOptions& options) {
  require_valid(mesh);
  Mender mender(mesh);
  if (options.merge_points) mender.merge_points();
  if (options.drop_degenerate) mender.drop_degenerate();
  if (options.drop_duplicates) mender.drop_duplicates();
  if (options.orient) mender.orient();
  if (options.drop_isolated) mender.drop_isolated();
  return mender.finish();
}

}  // namespace tendril::bind
