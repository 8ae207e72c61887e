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
  bool open = false;  ///< the lanes do not resolve it

  bool resolved() const { return !open && t < kNone; }
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

/// Why a point gets the same bits here as alone. Every piece whose lower bound lies within the cut is
/// resolved by the arithmetic of the search of one point, on the same numbers; a piece that the lanes skip is
/// beyond the cut by more than `slack`, which that search would drop too, in whatever order it met the
/// pieces. What is compared in the end are the candidates within the cut; where two of them could win, or a
/// lane proves less than the search of one point demands, that search is made.
template <int P>
class ProjectionBatch final : public CurveProjector::Data::Batch {
 public:
  ProjectionBatch(const CurveProjector::Data& data, const std::vector<search::Piece<P>>& pieces,
                  const CapsuleTree& tree)
      : data_(data),
        pieces_(pieces),
        tree_(tree),
        spans_(data.curve.knots().nonempty_spans()),
        parts_(pieces.size() / spans_.size()) {}

  /// Group by group, after one descent of the tree for all.
  void find(Points points, std::span<const std::uint32_t> which, std::span<Found> found) override {
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
        resolve(group_of.size());
      }
      for (std::size_t i = 0; i < group_of.size(); ++i)
        found[group_of[i]] = fits && best_[i].resolved()
                                 ? Found{best_[i].t, best_[i].least, spans_[best_[i].piece / parts_]}
                                 : alone(i);
    }
  }

 private:
  /// Of a point p of the box and its centre c, |p - c| <= a / 2 with the diagonal a, so a distance from p
  /// differs by at most a / 2 from that from c. With u the least upper bound on the distance of a piece from
  /// c, every p has a piece within u + a / 2, and a piece whose capsule is farther than u + a from c is
  /// farther than u + a / 2 from p: it is nearest to none.
  /// Pieces that may be nearest to a point of the box; false when they are too many.
  bool gather(const Eigen::AlignedBox3d& box, double slack) {
    const Vec3 centre = box.center();
    const double across = box.diagonal().norm();
    around_.clear();
    balls_.clear();
    double upper = kNone;
    tree_.descend(
        centre, [&] { return around_.size() < kMostPieces ? upper + across + slack : -1.0; },
        [&](std::size_t piece) {
          upper = std::min(upper, std::sqrt(tree_.of(piece).square(centre)) + tree_.of(piece).radius);
          around_.push_back(piece);
          balls_.add(tree_.of(piece));
        });
    return around_.size() < kMostPieces;
  }

  /// Those that may be nearest to a point of a box within that box.
  void select(const Eigen::AlignedBox3d& box, double slack) {
    search::measure_balls(balls_, search::plain(box.center()));
    std::size_t least = 0;
    for (std::size_t i = 1; i < balls_.size(); ++i)
      if (balls_.distance[i] + balls_.radius[i] < balls_.distance[least] + balls_.radius[least]) least = i;
    search::mark_beyond(balls_, {search::plain(0.5 * box.sizes()),
                                 {balls_.x[least], balls_.y[least], balls_.z[least]},
                                 balls_.distance[least],
                                 balls_.radius[least] + slack,
                                 box.diagonal().norm()});
    near_.clear();
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      if (balls_.beyond[i] != 0) continue;
      const Capsule& c = tree_.of(around_[i]);
      near_.push_back(
          {around_[i], search::plain(c.start), search::plain(c.axis), c.inverse_length2, c.radius});
    }
  }

  void push(std::size_t lane, std::size_t piece) {
    const search::Control<P> r = search::relative<P>(pieces_[piece], point(lane));
    for (std::size_t k = 0; k <= P; ++k) {
      items_.x[k][waiting_] = r[k].x;
      items_.y[k][waiting_] = r[k].y;
      items_.z[k][waiting_] = r[k].z;
    }
    items_.cut[waiting_] = best_[lane].cut;
    lane_of_[waiting_] = lane;
    piece_of_[waiting_] = piece;
    if (++waiting_ == kLanes) flush();
  }

  void flush() {
    if (waiting_ == 0) return;
    const std::size_t count = waiting_;
    waiting_ = 0;
    search::resolve<P>(items_, (count + 7) / 8 * 8);
    for (std::size_t i = 0; i < count; ++i) take(best_[lane_of_[i]], piece_of_[i], i);
  }

  void take(Best& to, std::size_t piece, std::size_t i) const {
    if (items_.fate[i] == search::fate::dropped) return;
    to.lower(items_.upper[i]);
    if (items_.fate[i] == search::fate::open || !proven(i)) {
      to.open = true;
      return;
    }
    to.least = std::min(to.least, items_.least[i] - to.blur);
    to.candidate(pieces_[piece].parameter(items_.s[i]), items_.distance[i], piece);
  }

  /// Whether the search of one point would resolve the root.
  bool proven(std::size_t i) const {
    const double gap = items_.distance[i] - items_.least[i];
    return items_.fate[i] != search::fate::root || gap <= data_.bounds_for(data_.diagonal).proof ||
           gap <= data_.bounds(point(lane_of_[i])).proof;
  }

  Vec3 point(std::size_t lane) const { return {group_.x[lane], group_.y[lane], group_.z[lane]}; }

  static Eigen::AlignedBox3d box_of(Points points, std::span<const std::uint32_t> which) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t i : which) box.extend(points[i]);
    return box;
  }

  /// Not below that of any point of the box.
  search::Bounds bounds_of(const Eigen::AlignedBox3d& box) const {
    return data_.bounds_for(data_.size(box.center()) + box.diagonal().norm());
  }

  void fill(Points points, std::span<const std::uint32_t> which, const search::Bounds& bounds) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const Vec3& p = points[which[std::min(i, which.size() - 1)]];
      group_.x[i] = p.x();
      group_.y[i] = p.y();
      group_.z[i] = p.z();
      group_.square[i] = kNone;
      best_[i] = {bounds.slack, bounds.blur};
    }
  }

  Found alone(std::size_t lane) const {
    const double t = best_[lane].t;
    return data_.find(point(lane), data_.bounds(point(lane)), t < kNone ? t : kNaN);
  }

  void resolve(std::size_t count) {
    squares_.resize(kLanes * near_.size());
    for (std::size_t k = 0; k < near_.size(); ++k)
      search::measure_piece(group_, near_[k], static_cast<double>(k), squares_.data() + kLanes * k);
    for (std::size_t i = 0; i < kLanes; ++i) {
      // Squares that overflow are left to the search of one point.
      if (i >= count || !(group_.square[i] < kNone)) continue;
      best_[i].lower(std::sqrt(group_.square[i]) + group_.radius[i]);
      push(i, near_[static_cast<std::size_t>(group_.nearest[i])].piece);
    }
    flush();
    for (std::size_t i = 0; i < kLanes; ++i)
      group_.cut[i] = i < count && best_[i].cut < kNone ? best_[i].cut : kNaN;
    for (std::size_t k = 0; k < near_.size(); ++k) push_near(k);
    flush();
  }

  /// A piece for all points that it is not too far from and that have not begun with it.
  void push_near(std::size_t k) {
    std::array<unsigned char, kLanes> marks;
    search::mark_near(group_, near_[k].radius, squares_.data() + kLanes * k, marks.data());
    for (std::size_t begin = 0; begin < kLanes; begin += 8) {
      std::uint64_t eight;
      std::memcpy(&eight, marks.data() + begin, 8);
      for (std::size_t i = begin; eight != 0 && i < begin + 8; ++i)
        if (marks[i] != 0 && group_.nearest[i] != static_cast<double>(k)) push(i, near_[k].piece);
    }
  }

  const CurveProjector::Data& data_;
  const std::vector<search::Piece<P>>& pieces_;
  const CapsuleTree& tree_;
  const std::vector<int> spans_;  // with their pieces
  const std::size_t parts_;       // of a span

  search::GroupLanes group_{};
  std::array<Best, kLanes> best_{};
  std::vector<std::size_t> around_;      // pieces for some groups to choose from
  search::Balls balls_;                  // around those
  std::vector<search::NearPiece> near_;  // what one group has chosen
  std::vector<double> squares_;          // kLanes of each of these

  search::PieceLanes<P> items_{};  // a piece seen from a point each
  std::array<std::size_t, kLanes> lane_of_{}, piece_of_{};
  std::size_t waiting_ = 0;
};

}  // namespace

template <int P>
std::unique_ptr<CurveProjector::Data::Batch> make_batch(const CurveProjector::Data& data,
                                                        const std::vector<search::Piece<P>>& pieces,
                                                        const CapsuleTree& tree) {
  return std::make_unique<ProjectionBatch<P>>(data, pieces, tree);
}

using Batch = std::unique_ptr<CurveProjector::Data::Batch>;
template <int P>
using Pieces = std::vector<search::Piece<P>>;
template Batch make_batch(const CurveProjector::Data&, const Pieces<1>&, const CapsuleTree&);
template Batch make_batch(const CurveProjector::Data&, const Pieces<2>&, const CapsuleTree&);
template Batch make_batch(const CurveProjector::Data&, const Pieces<3>&, const CapsuleTree&);
template Batch make_batch(const CurveProjector::Data&, const Pieces<4>&, const CapsuleTree&);
template Batch make_batch(const CurveProjector::Data&, const Pieces<5>&, const CapsuleTree&);

}  // namespace tendril
