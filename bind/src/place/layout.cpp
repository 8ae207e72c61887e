#include "layout.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tendril::bind {
namespace {

/// Which span of which curve-pair an entry lies in.
class Spans {
 public:
  explicit Spans(const std::vector<KnotVector>& knots) : knots_(knots) {
    for (std::size_t k = 0; k < knots.size(); ++k) {
      index_.emplace_back(knots[k].knots().size(), 0);
      for (const int at : knots[k].nonempty_spans()) {
        index_[k][static_cast<std::size_t>(at)] = static_cast<std::uint32_t>(spans.size());
        spans.push_back(make_span(static_cast<std::uint32_t>(k), knots[k], at));
      }
    }
  }
  std::uint32_t of(std::uint32_t pair, double t) const {
    return index_[pair][static_cast<std::size_t>(knots_[pair].span(t))];
  }

  std::vector<Span> spans;

 private:
  const std::vector<KnotVector>& knots_;
  std::vector<std::vector<std::uint32_t>> index_;
};

/// Counting sort by twice the span, plus 1 off the normal plane: stable.
///
/// Why points are sorted: those of a run lie in one span, so one polynomial serves the whole loop over them,
/// its coefficients stay in registers, and the records stream through the vector lanes without a gather. In
/// the normal plane w is 0 and is not read; a point within rounding of it counts as in it. Equal keys keep
/// their order, in which neighbours of the mesh are often neighbours in memory.
Order sort_by_key(const std::vector<std::uint32_t>& key, std::size_t first_entry, std::size_t spans) {
  const auto keys = static_cast<std::uint32_t>(2 * spans);
  std::vector<std::uint32_t> begin(keys + 1, 0);
  for (const std::uint32_t k : key) ++begin[k + 1];
  for (std::size_t k = 0; k < keys; ++k) begin[k + 1] += begin[k];
  Order order;
  for (std::uint32_t k = 0; k < keys; ++k)
    if (begin[k] < begin[k + 1]) order.runs.push_back({k / 2, begin[k], begin[k + 1], k % 2 == 1});
  order.entry.resize(key.size());
  for (std::size_t i = 0; i < key.size(); ++i)
    order.entry[begin[key[i]]++] = static_cast<std::uint32_t>(first_entry + i);
  return order;
}

}  // namespace

const Run& Order::run_of(std::size_t slot) const {
  const auto after = std::upper_bound(runs.begin(), runs.end(), slot,
                                      [](std::size_t at, const Run& run) { return at < run.begin; });
  return *std::prev(after);
}

const BindingLayout::Blend* BindingLayout::blend_of(std::size_t point) const {
  const auto found = std::lower_bound(blends.begin(), blends.end(), point,
                                      [](const Blend& blend, std::size_t p) { return blend.point < p; });
  return found != blends.end() && found->point == point ? &*found : nullptr;
}

void BindingLayout::arrange(double negligible) {
  Spans all(knots);
  const auto order_of = [&](std::size_t first, std::size_t count) {
    std::vector<std::uint32_t> key(count);
    for (std::size_t i = 0; i < count; ++i) {
      const AxialPoint& at = entries[first + i];
      key[i] = 2 * all.of(pair_of(first + i), at.t) + (std::abs(at.w) > negligible ? 1 : 0);
    }
    return sort_by_key(key, first, all.spans.size());
  };
  nearest = order_of(0, size);
  others = order_of(size, entries.size() - size);
  spans = std::move(all.spans);
  const auto fill = [&](const Order& order, std::size_t first, std::vector<std::uint32_t>& slots) {
    Records<double> records(order.entry.size());
    slots.resize(order.entry.size());
    for (const Run& run : order.runs)
      for (std::size_t i = run.begin; i < run.end; ++i) {
        const AxialPoint& at = entries[order.entry[i]];
        slots[order.entry[i] - first] = static_cast<std::uint32_t>(i);
        records.s[i] = (at.t - spans[run.span].middle) / spans[run.span].length;
        records.u[i] = at.u;
        records.v[i] = at.v;
        records.w[i] = run.off ? at.w : 0.0;
      }
    return records;
  };
  if (!blends.empty()) kept.assign(size, 1.0);
  for (std::size_t k = 0; k < share.size(); ++k) kept[owner[k]] -= share[k];
  numbers.nearest = fill(nearest, 0, slot);
  numbers.others = fill(others, size, other_slot);
}

void BindingLayout::require_same_knots(std::span<const CurvePair> posed) const {
  if (posed.size() != knots.size())
    throw InvalidInput("posed", std::to_string(posed.size()) + " curve-pairs", std::to_string(knots.size()));
  for (std::size_t k = 0; k < posed.size(); ++k)
    if (posed[k].knots() != knots[k])
      throw InvalidInput("posed curve-pair", "other knots", "those it was bound with");
}

void BindingLayout::require_point(std::size_t point) const {
  if (point >= size) throw InvalidInput("point", std::to_string(point), "less than " + std::to_string(size));
}

}  // namespace tendril::bind
