#include <tendril/base/error.h>
#include <tendril/bind/binding_points.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "place/evaluator.h"

namespace tendril::bind {
namespace {

constexpr std::size_t kBlock = 256;  // points placed before they become rows

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

/// Each group's points sorted by span, those off the normal plane last.
class Groups : public PointGroups {
 public:
  Groups(std::shared_ptr<const BindingLayout> layout, std::span<const std::uint32_t> begin,
         std::span<const std::uint32_t> points)
      : layout_(std::move(layout)),
        begin_(begin.begin(), begin.end()),
        records_(points.size()),
        place_(points.size()) {
    order_.entry.resize(points.size());
    blend_begin_.push_back(0);
    for (std::size_t g = 0; g + 1 < begin.size(); ++g) arrange(points, begin[g], begin[g + 1]);
  }

  void pose(std::span<const CurvePair> posed) override {
    layout_->require_same_knots(posed);
    posed_.assign(posed.begin(), posed.end());
    pieces_ = bind::pose<double>(layout_->spans, posed_);
    maps_ = Evaluator<double>(*layout_, layout_->numbers, posed_).maps(pieces_);
  }

  void place(std::size_t group, MutablePoints out) const override {
    const Evaluator<double> evaluator(*layout_, layout_->numbers, posed_);
    std::array<double, kBlock> x, y, z;
    const std::size_t first = begin_[group], end = begin_[group + 1];
    for (std::size_t at = first; at < end; at += kBlock) {
      const std::size_t count = std::min(kBlock, end - at);
      evaluator.evaluate(pieces_, order_, records_, at, at + count, {x.data(), y.data(), z.data()});
      for (std::size_t i = 0; i < count; ++i) out[place_[at + i]] = Vec3(x[i], y[i], z[i]);
    }
    const auto map_of = [this](std::uint32_t node) -> const AffineMap<double>& { return maps_[node]; };
    for (std::size_t b = blend_begin_[group]; b < blend_begin_[group + 1]; ++b) {
      Vec3& to = out[blends_[b].place];
      const Triple<double> p = evaluator.blended(*blends_[b].blend, {to.x(), to.y(), to.z()}, map_of);
      to = Vec3(p.x, p.y, p.z);
    }
  }

 private:
  struct Blended {
    const BindingLayout::Blend* blend;
    std::uint32_t place;  ///< of its point, among those of the group
  };

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
    for (std::uint32_t i = 0; i < sorted.size(); ++i) {
      const std::uint32_t slot = begin + i, point = points[begin + sorted[i]];
      const Run* run = run_of(sorted[i]);
      if (run != last) order_.runs.push_back({run->span, slot, slot, run->off});
      order_.runs.back().end = slot + 1;
      last = run;
      order_.entry[slot] = point;
      place_[slot] = sorted[i];
      copy_record(layout.numbers.nearest, layout.slot[point], slot);
      if (const BindingLayout::Blend* blend = layout.blend_of(point)) blends_.push_back({blend, sorted[i]});
    }
    blend_begin_.push_back(blends_.size());
  }

  void copy_record(const Records<double>& all, std::size_t from, std::size_t to) {
    records_.s[to] = all.s[from];
    records_.u[to] = all.u[from];
    records_.v[to] = all.v[from];
    records_.w[to] = all.w[from];
  }

  std::shared_ptr<const BindingLayout> layout_;
  std::vector<std::uint32_t> begin_;
  Order order_;  ///< slots group by group
  Records<double> records_;
  std::vector<std::uint32_t> place_;  ///< of each slot, among the points of its group
  std::vector<Blended> blends_;
  std::vector<std::size_t> blend_begin_;
  std::vector<CurvePair> posed_;
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
