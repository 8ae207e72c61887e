#include "body_grid.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "mesh/disjoint_sets.h"

namespace tendril::bind {
namespace {

/// Largest |n . (corner - centre)| over a box of half sides `half`.
double reach(const Vec3& n, const Vec3& half) {
  return n.cwiseAbs().dot(half);
}

/// Whether n separates a triangle, about the box's centre, from the box.
bool separates(const Vec3& n, const std::array<Vec3, 3>& t, const Vec3& half) {
  const double a = n.dot(t[0]), b = n.dot(t[1]), c = n.dot(t[2]);
  const double most = reach(n, half);
  return std::min({a, b, c}) > most || std::max({a, b, c}) < -most;
}

/// By the separating axes of a box and a triangle [Akenine-Moller 2001].
bool meets(const std::array<Vec3, 3>& triangle, const Vec3& centre, const Vec3& half) {
  const std::array<Vec3, 3> t{triangle[0] - centre, triangle[1] - centre, triangle[2] - centre};
  const std::array<Vec3, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  for (Eigen::Index a = 0; a < 3; ++a) {
    const Vec3 axis = Vec3::Unit(a);
    if (separates(axis, t, half)) return false;
    for (const Vec3& edge : edges)
      if (separates(axis.cross(edge), t, half)) return false;
  }
  return !separates(edges[0].cross(edges[1]), t, half);
}

/// A segment and a box, the same way.
bool meets(const Vec3& from, const Vec3& to, const Vec3& centre, const Vec3& half) {
  const Vec3 p = from - centre, q = to - centre, along = q - p;
  const auto apart = [&](double a, double b, double most) {
    return std::min(a, b) > most || std::max(a, b) < -most;
  };
  for (Eigen::Index a = 0; a < 3; ++a) {
    const Eigen::Index b = (a + 1) % 3, c = (a + 2) % 3;
    if (apart(p[a], q[a], half[a])) return false;
    // The axis a times the segment: the same number at either end.
    const double at = along[b] * p[c] - along[c] * p[b];
    if (std::abs(at) > std::abs(along[b]) * half[c] + std::abs(along[c]) * half[b]) return false;
  }
  return true;
}

constexpr double kTouch = 1e-9;  ///< voxels, by which a feature may miss one

/// A convex polygon: a triangle cut by up to six planes has at most nine corners.
struct Polygon {
  std::array<Vec3, 9> p;
  std::size_t size = 0;

  void add(const Vec3& corner) { p[size++] = corner; }
};

/// The part of a convex polygon where s (p[axis] - at) >= 0.
Polygon clipped(const Polygon& polygon, Eigen::Index axis, double at, double s) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vec3 &p = polygon.p[i], &q = polygon.p[(i + 1) % polygon.size];
    const double from = s * (p[axis] - at), to = s * (q[axis] - at);
    if (from >= 0.0) out.add(p);
    if ((from < 0.0) != (to < 0.0)) out.add(p + (q - p) * (from / (from - to)));
  }
  return out;
}

/// Adds the part of a triangle that lies in a voxel: its area, and its centre by area.
void add_part(const std::array<Vec3, 3>& t, const Vec3& low, Vec3& sum, double& area) {
  Polygon part;
  for (const Vec3& corner : t) part.add(corner);
  const Vec3 least = t[0].cwiseMin(t[1]).cwiseMin(t[2]) - low,
             most = t[0].cwiseMax(t[1]).cwiseMax(t[2]) - low;
  const bool within = least.minCoeff() >= 0.0 && most.maxCoeff() <= 1.0;
  for (Eigen::Index a = 0; a < 3 && !within; ++a)
    part = clipped(clipped(part, a, low[a], 1.0), a, low[a] + 1.0, -1.0);
  for (std::size_t k = 2; k < part.size; ++k) {
    const double size = (part.p[k - 1] - part.p[0]).cross(part.p[k] - part.p[0]).norm();
    area += size;
    sum += size / 3.0 * (part.p[0] + part.p[k - 1] + part.p[k]);
  }
}

/// For each point the first of those at its place.
std::vector<std::uint32_t> firsts_of(Points points) {
  std::vector<std::uint32_t> order(points.size()), out(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 &p = points[a], &q = points[b];
    if (p.x() != q.x()) return p.x() < q.x();
    if (p.y() != q.y()) return p.y() < q.y();
    return p.z() != q.z() ? p.z() < q.z() : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    out[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? out[order[i - 1]] : order[i];
  return out;
}

}  // namespace

BodyGrid::BodyGrid(const PolygonMesh& mesh, int voxels) {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    low = i == 0 ? mesh.points[0] : Vec3(low.cwiseMin(mesh.points[i]));
    high = i == 0 ? mesh.points[0] : Vec3(high.cwiseMax(mesh.points[i]));
  }
  const double longest = (high - low).maxCoeff();
  if (longest > 0.0) h_ = longest / voxels;
  // Off the faces of the box, which flat parts of a mesh like to lie in.
  origin_ = low - h_ * Vec3(1.371, 1.417, 1.293);
  for (std::size_t a = 0; a < 3; ++a)
    count_[a] = static_cast<int>(scaled(high)[static_cast<Eigen::Index>(a)]) + 2;
  state_.assign(index({0, 0, count_[2]}), kInside);
  enter_faces(mesh);
  split_into_pieces(mesh);
  join_pieces();
  flood_outside();
  number_nodes();
}

BodyGrid::Cell BodyGrid::cell_at(std::uint32_t i) const {
  const int at = static_cast<int>(i);
  return {at % count_[0], at / count_[0] % count_[1], at / count_[0] / count_[1]};
}

bool BodyGrid::holds(const Cell& c) const {
  for (std::size_t a = 0; a < 3; ++a)
    if (c[a] < 0 || c[a] >= count_[a]) return false;
  return true;
}

BodyGrid::Cell BodyGrid::cell_of(const Vec3& p) const {
  Cell out;
  for (std::size_t a = 0; a < 3; ++a)
    out[a] = static_cast<int>(std::clamp(p[static_cast<Eigen::Index>(a)], 0.0, count_[a] - 1.0));
  return out;
}

/// Enters the voxels [low, high) that a triangle meets, halving the block of them: a large triangle meets few
/// of the voxels in its box, and whole blocks fall to one test.
void BodyGrid::rasterise(const std::array<Vec3, 3>& triangle, const Cell& low, const Cell& high,
                         const Entry& entry) {
  const Vec3 from(low[0], low[1], low[2]), to(high[0], high[1], high[2]);
  if (!meets(triangle, 0.5 * (from + to), 0.5 * (to - from))) return;
  std::size_t longest = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (high[a] - low[a] > high[longest] - low[longest]) longest = a;
  if (high[longest] - low[longest] == 1) {
    state_[index(low)] = kSurface;
    entries_.push_back(entry);
    entries_.back().cell = index(low);
    return;
  }
  Cell end = high, begin = low;
  end[longest] = begin[longest] = (low[longest] + high[longest]) / 2;
  rasterise(triangle, low, end, entry);
  rasterise(triangle, begin, high, entry);
}

void BodyGrid::enter_faces(const PolygonMesh& mesh) {
  const std::vector<std::uint32_t> first = firsts_of(mesh.points);
  std::vector<bool> used(mesh.points.size(), false);
  const auto enter = [&](std::uint32_t face, const std::array<std::uint32_t, 3>& corners) {
    const std::array<Vec3, 3> t{scaled(mesh.points[corners[0]]), scaled(mesh.points[corners[1]]),
                                scaled(mesh.points[corners[2]])};
    const Cell from = cell_of(t[0].cwiseMin(t[1]).cwiseMin(t[2]));
    Cell to = cell_of(t[0].cwiseMax(t[1]).cwiseMax(t[2]));
    for (int& x : to) ++x;
    rasterise(t, from, to, {0, face, static_cast<std::uint32_t>(triangles_.size()), 0});
    triangles_.push_back({first[corners[0]], first[corners[1]], first[corners[2]]});
  };
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    first_entry_.push_back(static_cast<std::uint32_t>(entries_.size()));
    for (const std::uint32_t i : face) used[i] = true;
    for (std::size_t k = 2; k < face.size(); ++k) enter(f, {face[0], face[k - 1], face[k]});
  }
  const auto faces = static_cast<std::uint32_t>(mesh.face_count());
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
    first_entry_.push_back(static_cast<std::uint32_t>(entries_.size()));
    if (!used[i]) enter(faces + i, {i, i, i});
  }
  first_entry_.push_back(static_cast<std::uint32_t>(entries_.size()));
  sort_entries();
}

/// A large face meets many voxels: each is to be found without a look at all.
void BodyGrid::sort_entries() {
  by_voxel_.resize(entries_.size());
  std::iota(by_voxel_.begin(), by_voxel_.end(), 0U);
  for (std::size_t face = 0; face + 1 < first_entry_.size(); ++face)
    std::sort(by_voxel_.begin() + first_entry_[face], by_voxel_.begin() + first_entry_[face + 1],
              [&](std::uint32_t a, std::uint32_t b) {
                return std::pair(entries_[a].cell, a) < std::pair(entries_[b].cell, b);
              });
}

/// In each voxel, triangles that share an edge or a corner that is there are one piece. What they share
/// elsewhere does not count: two fingers share a palm, and a voxel between their tips has a piece of each.
/// Features are taken to be there by a little more than the voxel, since one that lies in its face may be
/// rounded out of both.
void BodyGrid::split_into_pieces(const PolygonMesh& mesh) {
  std::vector<std::uint32_t> order(entries_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return entries_[a].cell < entries_[b].cell; });
  DisjointSets sets(entries_.size());
  struct Feature {
    std::uint32_t a, b, entry;
    bool operator<(const Feature& o) const { return std::tie(a, b, entry) < std::tie(o.a, o.b, o.entry); }
  };
  std::vector<Feature> features;
  const Vec3 half = Vec3::Constant(0.5 + kTouch);
  // A sort and a scan, voxel by voxel: the features of one voxel are few, a table of all would not fit the
  // cache.
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const std::uint32_t cell = entries_[order[begin]].cell;
    while (end < order.size() && entries_[order[end]].cell == cell) ++end;
    if (end == begin + 1) continue;
    const Cell c = cell_at(cell);
    const Vec3 centre = Vec3(c[0], c[1], c[2]) + Vec3::Constant(0.5);
    features.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const auto& t = triangles_[entries_[order[k]].triangle];
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t a = std::min(t[e], t[(e + 1) % 3]), b = std::max(t[e], t[(e + 1) % 3]);
        const Vec3 p = scaled(mesh.points[a]), q = scaled(mesh.points[b]);
        if (meets(p, q, centre, half)) features.push_back({a, b, order[k]});
        const Vec3 corner = scaled(mesh.points[t[e]]) - centre;
        if ((corner.cwiseAbs() - half).maxCoeff() <= 0.0) features.push_back({t[e], t[e], order[k]});
      }
    }
    std::sort(features.begin(), features.end());
    for (std::size_t i = 1; i < features.size(); ++i)
      if (features[i].a == features[i - 1].a && features[i].b == features[i - 1].b)
        sets.join(features[i].entry, features[i - 1].entry);
  }
  first_piece_.assign(state_.size() + 1, 0);
  for (const std::uint32_t i : order) {
    if (sets.is_root(i)) {
      entries_[i].piece = static_cast<std::uint32_t>(piece_cell_.size());
      piece_cell_.push_back(entries_[i].cell);
      ++first_piece_[entries_[i].cell + 1];
    }
    entries_[i].piece = entries_[sets.root(i)].piece;
  }
  for (std::size_t i = 1; i < first_piece_.size(); ++i) first_piece_[i] += first_piece_[i - 1];
  find_centres(mesh);
}

/// What pieces of one voxel are told apart by, and where what is known at the nodes is looked at.
void BodyGrid::find_centres(const PolygonMesh& mesh) {
  piece_centre_.assign(piece_cell_.size(), Vec3::Zero());
  piece_normal_ = piece_centre_;
  std::vector<double>& area = piece_area_;
  area.assign(piece_cell_.size(), 0.0);
  for (const Entry& entry : entries_) {
    const auto& [i, j, k] = triangles_[entry.triangle];
    const Vec3 &p = mesh.points[i], &q = mesh.points[j], &r = mesh.points[k];
    const Vec3 normal = (q - p).cross(r - p);
    if (normal.norm() > 0.0) piece_normal_[entry.piece] += normal.normalized();
    const Cell c = cell_at(entry.cell);
    add_part({scaled(p), scaled(q), scaled(r)}, Vec3(c[0], c[1], c[2]), piece_centre_[entry.piece],
             area[entry.piece]);
  }
  for (std::size_t p = 0; p < area.size(); ++p) {
    const Cell c = cell_at(piece_cell_[p]);
    if (piece_normal_[p].norm() > 0.0) piece_normal_[p].normalize();
    piece_centre_[p] =
        area[p] > 0.0 ? Vec3(piece_centre_[p] / area[p]) : Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5);
  }
}

/// Pieces are joined where a sheet passes through the face between their voxels, that is, where one
/// triangle has a part in both. From these, pieces of voxels with an edge or a corner in common by one or
/// two voxels in between.
void BodyGrid::join_pieces() {
  std::vector<std::array<std::uint32_t, 2>> cells;  // of one triangle: voxel, piece
  for (std::size_t begin = 0, end = 0; begin < entries_.size(); begin = end) {
    cells.clear();
    while (end < entries_.size() && entries_[end].triangle == entries_[begin].triangle) {
      cells.push_back({entries_[end].cell, entries_[end].piece});
      ++end;
    }
    std::sort(cells.begin(), cells.end());
    const std::array<std::uint32_t, 3> ahead{1, index({0, 1, 0}), index({0, 0, 1})};
    for (const auto& [cell, piece] : cells)
      for (const std::uint32_t step : ahead) {
        const auto at = std::lower_bound(cells.begin(), cells.end(), std::array{cell + step, 0U});
        if (at == cells.end() || (*at)[0] != cell + step) continue;
        joined_.push_back({piece, (*at)[1]});
        joined_.push_back({(*at)[1], piece});
      }
  }
  const Neighbours faces(piece_cell_.size(), joined_);
  std::vector<std::array<std::uint32_t, 2>> all = joined_;
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    const Cell p = cell_at(piece_cell_[a]), q = cell_at(piece_cell_[b]);
    return std::max({std::abs(p[0] - q[0]), std::abs(p[1] - q[1]), std::abs(p[2] - q[2])}) == 1;
  };
  for (std::uint32_t a = 0; a < piece_cell_.size(); ++a)
    for (const std::uint32_t b : faces.of(a))
      for (const std::uint32_t c : faces.of(b)) {
        if (!near(a, c)) continue;
        all.push_back({a, c});
        for (const std::uint32_t d : faces.of(c))
          if (near(a, d)) all.push_back({a, d});
      }
  joins_ = Neighbours(piece_cell_.size(), std::move(all));
}

/// From a corner of the grid, which no surface meets, through faces of voxels.
void BodyGrid::flood_outside() {
  std::vector<Cell> waiting{{0, 0, 0}};
  state_[0] = kOutside;
  while (!waiting.empty()) {
    const Cell at = waiting.back();
    waiting.pop_back();
    for (std::size_t a = 0; a < 3; ++a)
      for (const int step : {-1, 1}) {
        Cell next = at;
        next[a] += step;
        if (!holds(next) || state_[index(next)] != kInside) continue;
        state_[index(next)] = kOutside;
        waiting.push_back(next);
      }
  }
}

/// A corner of two joined pieces is one node; so a corner has as many nodes as sheets pass it.
void BodyGrid::number_nodes() {
  const auto pieces = static_cast<std::uint32_t>(piece_cell_.size());
  DisjointSets sets(8 * static_cast<std::size_t>(pieces));
  for (const auto& [a, b] : joined_) {
    const Cell from = cell_at(piece_cell_[a]), to = cell_at(piece_cell_[b]);
    for (std::uint32_t k = 0; k < 8; ++k) {
      const int x = from[0] + static_cast<int>(k & 1) - to[0],
                y = from[1] + static_cast<int>(k >> 1 & 1) - to[1],
                z = from[2] + static_cast<int>(k >> 2) - to[2];
      if (std::min({x, y, z}) < 0 || std::max({x, y, z}) > 1) continue;
      sets.join(8 * a + k, 8 * b + static_cast<std::uint32_t>(x + 2 * y + 4 * z));
    }
  }
  std::vector<std::uint32_t> number(8 * static_cast<std::size_t>(pieces));
  std::vector<std::array<std::uint32_t, 2>> pairs;
  std::vector<Vec3> sum;
  std::vector<double> area;
  piece_nodes_.resize(pieces);
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    const Cell c = cell_at(piece_cell_[piece]);
    for (std::uint32_t k = 0; k < 8; ++k) {
      const std::uint32_t element = 8 * piece + k, root = sets.root(element);
      if (root == element) {
        number[element] = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(origin_ + h_ * (Vec3(c[0], c[1], c[2]) + Vec3(k & 1, k >> 1 & 1, k >> 2)));
      }
      piece_nodes_[piece][k] = number[root];
      sum.resize(nodes_.size(), Vec3::Zero());
      area.resize(nodes_.size(), 0.0);
      sum[number[root]] += piece_area_[piece] * piece_centre_[piece];
      area[number[root]] += piece_area_[piece];
    }
    for (const std::uint32_t a : piece_nodes_[piece])
      for (const std::uint32_t b : piece_nodes_[piece])
        if (a != b) pairs.push_back({a, b});
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (area[i] > 0.0) nodes_[i] = origin_ + h_ * Vec3(sum[i] / area[i]);
  neighbours_ = Neighbours(nodes_.size(), std::move(pairs));
  joined_ = {};
}

}  // namespace tendril::bind
