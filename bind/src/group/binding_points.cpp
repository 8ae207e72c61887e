#include <tendril/base/error.h>
#include <tendril/bind/binding_points.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

#include "place/evaluator.h"

namespace tendril::bind {
namespace {

constexpr std::size_t kBlock = 256;  // points placed before they become rows

/// Memory that is wanted next. In place: g++ drops calls of a function that only fetches.
[[gnu::always_inline]] inline void fetch(const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  for (std::size_t i = 0; i < bytes; i += 64) __builtin_prefetch(at + i);
}

void check(std::span<const std::uint32_t> begin, std::span<const std::uint32_t> points, std::size_t size) {
  if (begin.empty() || begin.front() != 0 || begin.back() != points.size() ||
      !std::is_sorted(begin.begin(), begin.end()))
    throw InvalidInput("begin", "not the beginnings of groups",
                       "ascending from 0 to " + std::to_string(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i] >= size)
      throw InvalidInput("points[" + std::to_string(i) + "]", std::to_string(points[i]),
                         "less than " + std::to_string(size));
}

/// Each group's points sorted by span, those off the normal plane last. What a group is placed from lies
/// together: a frame comes to few of them, and to each when it is in no cache.
class Groups : public PointGroups {
 public:
  Groups(std::shared_ptr<const BindingLayout> layout, std::span<const std::uint32_t> begin,
         std::span<const std::uint32_t> points)
      : layout_(std::move(layout)), records_(3 * points.size()), w_(points.size()), place_(points.size()) {
    order_.entry.resize(points.size());
    for (std::size_t g = 0; g + 1 < begin.size(); ++g) arrange(points, begin[g], begin[g + 1]);
    begin_.push_back({points.size(), order_.runs.size(), blends_.size()});
  }

  void pose(std::span<const CurvePair> posed) override {
    layout_->require_same_knots(posed);
    evaluator_.reset();
    posed_.assign(posed.begin(), posed.end());
    pieces_ = bind::pose<double>(layout_->spans, posed_);
    evaluator_.emplace(*layout_, layout_->numbers, posed_);
    maps_ = evaluator_->maps(pieces_);
  }

  void place(std::size_t group, MutablePoints out) const override {
    if (!evaluator_) throw InvalidInput("place", "no pose", "pose() before");
    std::array<double, kBlock> x, y, z;
    const Begin &first = begin_[group], &end = begin_[group + 1];
    fetch(records_.data() + 3 * first.slot, (end.slot - first.slot) * 3 * sizeof(double));
    fetch(place_.data() + first.slot, (end.slot - first.slot) * sizeof(std::uint32_t));
    for (std::size_t at = first.slot; at < end.slot; at += kBlock) {
      const std::size_t count = std::min(kBlock, end.slot - at);
      evaluator_->evaluate(pieces_, order_, first.run, records_from(group, at), at, at + count,
                           {x.data(), y.data(), z.data()});
      for (std::size_t i = 0; i < count; ++i) out[place_[at + i]] = Vec3(x[i], y[i], z[i]);
    }
    const auto map_of = [this](std::uint32_t node) -> const AffineMap<double>& { return maps_[node]; };
    for (std::size_t b = first.blend; b < end.blend; ++b) {
      Vec3& to = out[blends_[b].place];
      const Triple<double> p = evaluator_->blended(*blends_[b].blend, {to.x(), to.y(), to.z()}, map_of);
      to = Vec3(p.x, p.y, p.z);
    }
  }

 private:
  /// Where a group's slots, runs and blends begin; they end where the next one's begin.
  struct Begin {
    std::size_t slot, run, blend;
  };
  struct Blended {
    const BindingLayout::Blend* blend;
    std::uint32_t place;  ///< of its point, among those of the group
  };

  /// A group's s, then its u, then its v.
  RecordsView<double> records_from(std::size_t group, std::size_t slot) const {
    const std::size_t first = begin_[group].slot, count = begin_[group + 1].slot - first;
    const double* s = records_.data() + 3 * first + (slot - first);
    return {s, s + count, s + 2 * count, w_.data() + slot};
  }

  void arrange(std::span<const std::uint32_t> points, std::uint32_t begin, std::uint32_t end) {
    const BindingLayout& layout = *layout_;
    std::vector<std::uint32_t> sorted(end - begin);
    std::iota(sorted.begin(), sorted.end(), 0U);
    const auto run_of = [&](std::uint32_t i) {
      return &layout.nearest.run_of(layout.slot[points[begin + i]]);
    };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return run_of(a) < run_of(b); });
    const Run* last = nullptr;
    begin_.push_back({begin, order_.runs.size(), blends_.size()});
    for (std::uint32_t i = 0; i < sorted.size(); ++i) {
      const std::uint32_t slot = begin + i, point = points[begin + sorted[i]];
      const Run* run = run_of(sorted[i]);
      if (run != last) order_.runs.push_back({run->span, slot, slot, run->off});
      order_.runs.back().end = slot + 1;
      last = run;
      order_.entry[slot] = point;
      place_[slot] = sorted[i];
      copy_record(layout.slot[point], slot, 3 * begin + i, end - begin);
      if (const BindingLayout::Blend* blend = layout.blend_of(point)) blends_.push_back({blend, sorted[i]});
    }
  }

  /// \param to     of its s among the records
  /// \param count  of the group's slots
  void copy_record(std::size_t from, std::size_t slot, std::size_t to, std::size_t count) {
    const Records<double>& all = layout_->numbers.nearest;
    w_[slot] = all.w[from];
    records_[to] = all.s[from];
    records_[to + count] = all.u[from];
    records_[to + 2 * count] = all.v[from];
  }

  std::shared_ptr<const BindingLayout> layout_;
  std::vector<Begin> begin_;
  Order order_;                       ///< slots group by group
  std::vector<double> records_;       ///< s, u and v group by group
  std::vector<double> w_;             ///< of each slot; read where it is more than rounding
  std::vector<std::uint32_t> place_;  ///< of each slot, among the points of its group
  std::vector<Blended> blends_;
  std::vector<CurvePair> posed_;
  std::optional<Evaluator<double>> evaluator_;
  std::vector<Piece<double>> pieces_;
  std::vector<AffineMap<double>> maps_;
};

}  // namespace

void BindingPoints::shares(std::size_t point, std::vector<BoundShare>& out) const {
  const BindingLayout& layout = *binding_.layout_;
  layout.require_point(point);
  const BindingLayout::Blend* blend = layout.blend_of(point);
  out.clear();
  out.push_back({layout.pair_of(point), blend ? layout.kept[point] : 1.0, layout.entries[point]});
  for (std::size_t k = blend ? blend->begin : 0; k < (blend ? blend->end : 0); ++k) {
    out.push_back({layout.nodes[layout.node[k]].pair, layout.numbers.share[k], layout.record(*blend, k)});
  }
}

std::unique_ptr<PointGroups> BindingPoints::group(std::span<const std::uint32_t> begin,
                                                  std::span<const std::uint32_t> points) const {
  check(begin, points, size());
  return std::make_unique<Groups>(binding_.layout_, begin, points);
}

}  // namespace tendril::bind
