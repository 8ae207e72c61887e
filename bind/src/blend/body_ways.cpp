#include <cmath>
#include <limits>

#include "body_grid.h"

namespace tendril::bind {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kWidestBall = 24;  ///< voxels, that a curve outside of the body is given
constexpr float kHop = 20.0F;    ///< voxels, from a piece to another that it is not joined to
constexpr double kClear = 0.2;   ///< mean cosine that says on which side of the faces a pocket lies

Vec3 corner_of(const std::array<int, 3>& c) {
  return Vec3(c[0], c[1], c[2]);
}
Vec3 middle_of(const std::array<int, 3>& c) {
  return corner_of(c) + Vec3::Constant(0.5);
}

}  // namespace

/// The nearest voxel that a surface meets, the first of those as near. Shell by shell, only their outermost
/// layer being looked at; a shell of radius r holds nothing nearer than r - 1, which ends the search.
BodyGrid::Cell BodyGrid::nearest_surface(const Vec3& p) const {
  const Cell here = cell_of(p);
  const int most = *std::max_element(count_.begin(), count_.end());
  Cell best = here;
  double least = std::numeric_limits<double>::infinity();
  for (int r = 0; r <= most && !(least < r - 1); ++r)
    for (int z = -r; z <= r; ++z)
      for (int y = -r; y <= r; ++y) {
        const bool whole = std::max({std::abs(y), std::abs(z)}) == r;
        for (int x = -r; x <= r; x += whole ? 1 : 2 * r) {
          const Cell c{here[0] + x, here[1] + y, here[2] + z};
          if (!holds(c) || state_[index(c)] != kSurface) continue;
          const Vec3 low = corner_of(c);
          const double away = (p - p.cwiseMax(low).cwiseMin(low + Vec3::Ones())).norm();
          if (away < least) least = away, best = c;
        }
      }
  return best;
}

/// Points along the curve within the grid, less than half a voxel apart along its control polygon.
std::vector<Vec3> BodyGrid::samples(const BSpline& curve) const {
  std::vector<Vec3> out{scaled(curve.value(curve.knots().start()))};
  for (const BezierPiece& piece : curve.bezier_pieces()) {
    double length = 0.0;
    for (std::size_t j = 1; j < piece.points.size(); ++j)
      length += (piece.points[j] - piece.points[j - 1]).norm() / h_;
    const int steps = 1 + static_cast<int>(std::min(2.0 * length, 1e5));
    for (int k = 1; k <= steps; ++k)
      out.push_back(scaled(curve.value(piece.begin + (piece.end - piece.begin) * k / steps)));
  }
  const Vec3 most(count_[0], count_[1], count_[2]);
  std::erase_if(out, [&](const Vec3& p) { return p.minCoeff() < 0.0 || (most - p).minCoeff() <= 0.0; });
  return out;
}

/// A lot that a curve runs in is body whatever its faces say. Of the others, what lies clearly on the other
/// side of the faces than the lot with most of the curves is a gap; where faces are turned anyhow the side
/// is a mean near 0, nothing is clear, and all stays body.
void BodyGrid::empty_pockets(std::span<const BSpline* const> curves) {
  std::vector<std::uint32_t> lot(state_.size(), 0);
  std::vector<Lot> lots(1);
  for (std::uint32_t cell = 0; cell < state_.size(); ++cell)
    if (state_[cell] == kInside && lot[cell] == 0)
      lots.push_back(look_at_lot(cell, static_cast<std::uint32_t>(lots.size()), lot));
  for (const BSpline* curve : curves)
    for (const Vec3& p : samples(*curve)) ++lots[lot[index(cell_of(p))]].samples;
  lots[0] = {};
  const auto body = std::max_element(lots.begin(), lots.end(), [](const Lot& a, const Lot& b) {
    return std::pair(a.samples, a.faces) < std::pair(b.samples, b.faces);
  });
  const double side = body->side;
  outward_ = side > 0.0 ? -1.0 : 1.0;
  for (std::uint32_t cell = 0; cell < state_.size(); ++cell) {
    const Lot& one = lots[lot[cell]];
    const bool clear = std::abs(one.side) > kClear * one.faces && std::abs(side) > kClear * body->faces;
    if (lot[cell] != 0 && one.samples == 0 && clear && one.side * side < 0.0) state_[cell] = kOutside;
  }
}

/// Numbers the voxels inside that faces of voxels join to this one.
BodyGrid::Lot BodyGrid::look_at_lot(std::uint32_t cell, std::uint32_t number,
                                    std::vector<std::uint32_t>& lot) const {
  Lot out;
  std::vector<std::uint32_t> waiting{cell};
  lot[cell] = number;
  while (!waiting.empty()) {
    const Cell at = cell_at(waiting.back());
    waiting.pop_back();
    const Vec3 middle = middle_of(at);
    for (std::size_t a = 0; a < 3; ++a)
      for (const int step : {-1, 1}) {
        Cell c = at;
        c[a] += step;
        const std::uint32_t next = index(c);
        if (state_[next] == kSurface) {
          out.side -= step * piece_normal_[piece_before(next, middle)][static_cast<Eigen::Index>(a)];
          out.faces += 1.0;
        } else if (state_[next] == kInside && lot[next] == 0) {
          lot[next] = number;
          waiting.push_back(next);
        }
      }
  }
  return out;
}

void BodyGrid::fill_about(const BSpline& curve) {
  for (const Vec3& p : samples(curve)) {
    const Cell c = cell_of(p);
    if (state_[index(c)] == kOutside) fill_ball(c);
  }
}

/// Within a layer of voxels at the border of the grid nothing is filled: ways are looked for without asking
/// whether a voxel has a neighbour.
void BodyGrid::fill_ball(const Cell& c) {
  const Vec3 centre = corner_of(c);
  const Cell nearest = nearest_surface(centre + Vec3::Constant(0.5));
  const double radius = (corner_of(nearest) - centre).norm();
  if (!(radius <= kWidestBall)) return;
  const int r = static_cast<int>(radius);
  for (int z = -r; z <= r; ++z)
    for (int y = -r; y <= r; ++y)
      for (int x = -r; x <= r; ++x) {
        const Cell at{c[0] + x, c[1] + y, c[2] + z};
        const bool inner =
            holds({at[0] - 1, at[1] - 1, at[2] - 1}) && holds({at[0] + 1, at[1] + 1, at[2] + 1});
        if (x * x + y * y + z * z > radius * radius || !inner) continue;
        if (state_[index(at)] == kOutside) state_[index(at)] = kFilled;
      }
}

/// Of those in a voxel, the one that p is the farthest behind: of two limbs that touch, the one that p is
/// in. The first of those that are alike.
std::uint32_t BodyGrid::piece_before(std::uint32_t cell, const Vec3& p) const {
  std::uint32_t best = first_piece_[cell];
  const auto depth = [&](std::uint32_t k) { return outward_ * piece_normal_[k].dot(piece_centre_[k] - p); };
  for (std::uint32_t k = best + 1; k < first_piece_[cell + 1]; ++k)
    if (depth(k) > depth(best)) best = k;
  return best;
}

/// Voxels and pieces are nodes of one graph. A way comes into a voxel of the surface by the piece that it
/// meets from behind, and leaves it by the same piece: so it does not pass through a sheet, however thin.
std::vector<float> BodyGrid::ways_from(const BSpline& curve) const {
  const auto cells = static_cast<std::uint32_t>(state_.size());  // pieces are numbered behind them
  std::vector<float> way(state_.size() + piece_cell_.size(), kFar);
  // By the whole part of their lengths [Dial 1969]: no step is shorter than 1, so none of those with one
  // part leads to another.
  std::vector<std::vector<std::uint32_t>> waiting;
  const auto enter = [&](std::uint32_t at, float length) {
    if (!(length < way[at])) return;
    way[at] = length;
    const auto part = static_cast<std::size_t>(length);
    if (part >= waiting.size()) waiting.resize(part + 1);
    waiting[part].push_back(at);
  };
  for (const Vec3& p : samples(curve)) {
    const Cell c = cell_of(p);
    const std::uint32_t cell = index(c);
    if (state_[cell] == kOutside) continue;
    const bool surface = state_[cell] == kSurface;
    enter(surface ? cells + piece_before(cell, p) : cell, static_cast<float>((p - middle_of(c)).norm()));
  }
  std::vector<std::uint32_t> now;
  for (std::size_t part = 0; part < waiting.size(); ++part) {
    now.swap(waiting[part]);
    for (const std::uint32_t at : now) {
      if (static_cast<std::size_t>(way[at]) != part) continue;
      if (at < cells)
        leave_voxel(at, way[at], enter);
      else
        leave_piece(at - cells, way[at], enter);
    }
    now.clear();
  }
  std::vector<float> out(nodes_.size(), kFar);
  for (std::size_t piece = 0; piece < piece_nodes_.size(); ++piece)
    for (const std::uint32_t node : piece_nodes_[piece])
      out[node] = std::min(out[node], static_cast<float>(h_) * (way[cells + piece] + 0.8660254F));
  return out;
}

/// The voxels of the body about one, with the lengths of the steps there. The outermost layer of the grid
/// is outside and has no ways, so no step leaves it.
template <class Step>
void BodyGrid::around(std::uint32_t cell, const Step& step) const {
  static constexpr float kLength[]{0.0F, 1.0F, 1.41421356F, 1.73205081F};
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y) {
      const std::uint32_t row = cell + static_cast<std::uint32_t>((z * count_[1] + y) * count_[0]);
      for (int x = -1; x <= 1; ++x) {
        const std::uint32_t next = row + static_cast<std::uint32_t>(x);
        if (next != cell && state_[next] != kOutside) step(next, kLength[x * x + y * y + z * z]);
      }
    }
}

template <class Enter>
void BodyGrid::leave_voxel(std::uint32_t cell, float length, const Enter& enter) const {
  const auto cells = static_cast<std::uint32_t>(state_.size());
  const Vec3 here = middle_of(cell_at(cell));
  around(cell, [&](std::uint32_t next, float step) {
    enter(state_[next] == kSurface ? cells + piece_before(next, here) : next, length + step);
  });
}

template <class Enter>
void BodyGrid::leave_piece(std::uint32_t piece, float length, const Enter& enter) const {
  const auto cells = static_cast<std::uint32_t>(state_.size());
  const std::uint32_t cell = piece_cell_[piece];
  const Vec3 here = middle_of(cell_at(cell));
  for (const std::uint32_t next : joins_.of(piece))
    enter(cells + next, length + static_cast<float>((middle_of(cell_at(piece_cell_[next])) - here).norm()));
  for (std::uint32_t next = first_piece_[cell]; next < first_piece_[cell + 1]; ++next)
    enter(cells + next, length + kHop);
  around(cell, [&](std::uint32_t next, float step) {
    if (state_[next] != kSurface && piece_before(cell, middle_of(cell_at(next))) == piece)
      enter(next, length + step);
  });
}

}  // namespace tendril::bind
