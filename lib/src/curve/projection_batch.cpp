#include "projection_batch.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "group_lanes.h"

namespace tendril {

using search::kLanes;
using Found = CurveProjector::Data::Found;

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Pieces for groups to choose from: more come of points far apart, or of a tangle, and are not worth it.
constexpr std::size_t kMostPieces = 1024;

/// What the search of one point keeps.
struct Best {
  double slack, blur;
  double cut = kNone, least = kNone;
  double t = kNone, local = kNone;
  std::size_t piece = 0;
  bool open = false;  ///< the lanes do not settle it

  bool settled() const { return !open && t < kNone; }
  void lower(double upper) { cut = std::min(cut, upper + slack); }
  /// Of candidates within the cut there must be one.
  void candidate(double at, double distance, std::size_t of) {
    if (distance > cut) return;
    lower(distance);
    if (local <= cut && at != t) open = true;
    t = at;
    local = distance;
    piece = of;
  }
};

}  // namespace

template <int P>
struct ProjectionBatch<P>::Work {
  const CurveProjector::Data& data;
  const std::vector<search::Piece<P>>& pieces;
  const CapsuleTree& tree;
  const std::vector<int> spans = data.curve.knots().nonempty_spans();
  const std::size_t parts = pieces.size() / spans.size();

  search::GroupLanes group{};
  std::array<Best, kLanes> best{};
  std::vector<std::size_t> around, near;  // pieces of some groups, of one
  search::Balls balls;                    // of `around`
  std::vector<search::Segment> segments;
  std::vector<double> squares;  // kLanes of every segment

  search::PieceLanes<P> items{};  // a piece seen from a point each
  std::array<std::size_t, kLanes> lane_of{}, piece_of{};
  std::size_t waiting = 0;

  Work(const CurveProjector::Data& d, const std::vector<search::Piece<P>>& p, const CapsuleTree& t)
      : data(d), pieces(p), tree(t) {}

  /// Pieces that may be nearest to a point of the box; false when they are too many.
  bool gather(const Eigen::AlignedBox3d& box, double slack) {
    const Vec3 centre = box.center();
    const double across = box.diagonal().norm();
    around.clear();
    balls.clear();
    double upper = kNone;
    tree.descend(
        centre, [&] { return around.size() < kMostPieces ? upper + across + slack : -1.0; },
        [&](std::size_t piece) {
          upper = std::min(upper, std::sqrt(tree.of(piece).square(centre)) + tree.of(piece).radius);
          around.push_back(piece);
          balls.add(tree.of(piece));
        });
    return around.size() < kMostPieces;
  }

  /// Those that may be nearest to a point of a box within that box.
  void select(const Eigen::AlignedBox3d& box, double slack) {
    const std::size_t count = around.size();
    balls.distance.resize(count);
    balls.beyond.resize(count);
    const double *x = balls.x.data(), *y = balls.y.data(), *z = balls.z.data();
    search::measure(x, y, z, count, search::plain(box.center()), balls.distance.data());
    std::size_t least = 0;
    for (std::size_t i = 1; i < count; ++i)
      if (balls.distance[i] + balls.radius[i] < balls.distance[least] + balls.radius[least]) least = i;
    const search::Reference to{search::plain(0.5 * box.sizes()),
                               {x[least], y[least], z[least]},
                               balls.distance[least],
                               balls.radius[least] + slack,
                               box.diagonal().norm()};
    search::bisect(x, y, z, balls.radius.data(), balls.distance.data(), count, to, balls.beyond.data());
    near.clear();
    segments.clear();
    for (std::size_t i = 0; i < count; ++i) {
      if (balls.beyond[i] != 0) continue;
      const Capsule& c = tree.of(around[i]);
      near.push_back(around[i]);
      segments.push_back({search::plain(c.start), search::plain(c.axis), c.inverse_length2, c.radius});
    }
  }

  void push(std::size_t lane, std::size_t piece) {
    const search::Control<P> r = search::relative<P>(pieces[piece], point(lane));
    for (std::size_t k = 0; k <= P; ++k) {
      items.x[k][waiting] = r[k].x;
      items.y[k][waiting] = r[k].y;
      items.z[k][waiting] = r[k].z;
    }
    items.cut[waiting] = best[lane].cut;
    lane_of[waiting] = lane;
    piece_of[waiting] = piece;
    if (++waiting == kLanes) flush();
  }

  void flush() {
    if (waiting == 0) return;
    const std::size_t count = waiting;
    waiting = 0;
    search::settle<P>(items, (count + 7) / 8 * 8);
    for (std::size_t i = 0; i < count; ++i) take(best[lane_of[i]], piece_of[i], i);
  }

  void take(Best& to, std::size_t piece, std::size_t i) const {
    if (items.fate[i] == search::fate::dropped) return;
    to.lower(items.upper[i]);
    if (items.fate[i] == search::fate::open || !proven(i)) {
      to.open = true;
      return;
    }
    to.least = std::min(to.least, items.least[i] - to.blur);
    to.candidate(pieces[piece].parameter(items.s[i]), items.distance[i], piece);
  }

  /// Whether the search of one point would settle the root.
  bool proven(std::size_t i) const {
    const double gap = items.distance[i] - items.least[i];
    return items.fate[i] != search::fate::root || gap <= data.bounds_for(data.diagonal).proof ||
           gap <= data.bounds(point(lane_of[i])).proof;
  }

  Vec3 point(std::size_t lane) const { return {group.x[lane], group.y[lane], group.z[lane]}; }

  /// Group by group, after one way down the tree for all.
  void find(Points points, std::span<const std::uint32_t> which, std::span<Found> found) {
    const Eigen::AlignedBox3d whole = box_of(points, which);
    const bool all = which.size() > kLanes && gather(whole, bounds_of(whole).slack);
    for (std::size_t begin = 0; begin < which.size(); begin += kLanes) {
      const auto group_of = which.subspan(begin, std::min(kLanes, which.size() - begin));
      const Eigen::AlignedBox3d box = box_of(points, group_of);
      const search::Bounds bounds = bounds_of(box);
      fill(points, group_of, bounds);
      const bool fits = all || gather(box, bounds.slack);
      if (fits) {
        select(box, bounds.slack);
        settle(group_of.size());
      }
      for (std::size_t i = 0; i < group_of.size(); ++i)
        found[group_of[i]] = fits && best[i].settled()
                                 ? Found{best[i].t, best[i].least, spans[best[i].piece / parts]}
                                 : alone(i);
    }
  }

  static Eigen::AlignedBox3d box_of(Points points, std::span<const std::uint32_t> which) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t i : which) box.extend(points[i]);
    return box;
  }

  /// Not below that of any point of the box.
  search::Bounds bounds_of(const Eigen::AlignedBox3d& box) const {
    return data.bounds_for(data.size(box.center()) + box.diagonal().norm());
  }

  void fill(Points points, std::span<const std::uint32_t> which, const search::Bounds& bounds) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const Vec3& p = points[which[std::min(i, which.size() - 1)]];
      group.x[i] = p.x();
      group.y[i] = p.y();
      group.z[i] = p.z();
      group.square[i] = kNone;
      best[i] = {bounds.slack, bounds.blur};
    }
  }

  Found alone(std::size_t lane) const {
    const double t = best[lane].t;
    return data.find(point(lane), data.bounds(point(lane)), t < kNone ? t : kNaN);
  }

  void settle(std::size_t count) {
    squares.resize(kLanes * near.size());
    for (std::size_t k = 0; k < near.size(); ++k)
      search::measure(group, segments[k], static_cast<double>(k), squares.data() + kLanes * k);
    for (std::size_t i = 0; i < kLanes; ++i) {
      // Squares that overflow are left to the search of one point.
      if (i >= count || !(group.square[i] < kNone)) continue;
      best[i].lower(std::sqrt(group.square[i]) + group.radius[i]);
      push(i, near[static_cast<std::size_t>(group.nearest[i])]);
    }
    flush();
    for (std::size_t i = 0; i < kLanes; ++i)
      group.cut[i] = i < count && best[i].cut < kNone ? best[i].cut : kNaN;
    for (std::size_t k = 0; k < near.size(); ++k) push_near(k);
    flush();
  }

  /// A piece for all points that it is not too far from and that have not begun with it.
  void push_near(std::size_t k) {
    std::array<unsigned char, kLanes> marks;
    search::mark(group, segments[k].radius, squares.data() + kLanes * k, marks.data());
    for (std::size_t begin = 0; begin < kLanes; begin += 8) {
      std::uint64_t eight;
      std::memcpy(&eight, marks.data() + begin, 8);
      for (std::size_t i = begin; eight != 0 && i < begin + 8; ++i)
        if (marks[i] != 0 && group.nearest[i] != static_cast<double>(k)) push(i, near[k]);
    }
  }
};

template <int P>
ProjectionBatch<P>::ProjectionBatch(const CurveProjector::Data& data,
                                    const std::vector<search::Piece<P>>& pieces, const CapsuleTree& tree)
    : work_(new Work(data, pieces, tree)) {}

template <int P>
ProjectionBatch<P>::~ProjectionBatch() = default;

template <int P>
void ProjectionBatch<P>::find(Points points, std::span<const std::uint32_t> which, std::span<Found> found) {
  work_->find(points, which, found);
}

template class ProjectionBatch<1>;
template class ProjectionBatch<2>;
template class ProjectionBatch<3>;
template class ProjectionBatch<4>;
template class ProjectionBatch<5>;

}  // namespace tendril
