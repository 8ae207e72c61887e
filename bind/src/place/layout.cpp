#include "layout.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tendril::bind {
namespace {

/// Counting sort by twice the span, plus 1 off the normal plane: stable.
///
/// Why points are sorted: those of a run lie in one span, so one polynomial serves the whole loop over them,
/// its coefficients stay in registers, and the records stream through the vector lanes without a gather. In
/// the normal plane w is 0 and is not read; a point within rounding of it counts as in it. Equal keys keep
/// their order, in which neighbours of the mesh are often neighbours in memory.
Order sort_by_key(const std::vector<std::uint32_t>& key, std::size_t spans) {
  const auto keys = static_cast<std::uint32_t>(2 * spans);
  std::vector<std::uint32_t> begin(keys + 1, 0);
  for (const std::uint32_t k : key) ++begin[k + 1];
  for (std::size_t k = 0; k < keys; ++k) begin[k + 1] += begin[k];
  Order order;
  for (std::uint32_t k = 0; k < keys; ++k)
    if (begin[k] < begin[k + 1]) order.runs.push_back({k / 2, begin[k], begin[k + 1], k % 2 == 1});
  order.entry.resize(key.size());
  for (std::size_t i = 0; i < key.size(); ++i) order.entry[begin[key[i]]++] = static_cast<std::uint32_t>(i);
  return order;
}

}  // namespace

const Run& Order::run_of(std::size_t slot) const {
  const auto after = std::upper_bound(runs.begin(), runs.end(), slot,
                                      [](std::size_t at, const Run& run) { return at < run.begin; });
  return *std::prev(after);
}

std::size_t Order::index_of_run(std::size_t slot) const {
  const auto found = std::upper_bound(runs.begin(), runs.end(), slot,
                                      [](std::size_t at, const Run& run) { return at < run.end; });
  return static_cast<std::size_t>(found - runs.begin());
}

const BindingLayout::Blend* BindingLayout::blend_of(std::size_t point) const {
  const auto found = std::lower_bound(blends.begin(), blends.end(), point,
                                      [](const Blend& blend, std::size_t p) { return blend.point < p; });
  return found != blends.end() && found->point == point ? &*found : nullptr;
}

AxialPoint BindingLayout::record(const Blend& blend, std::size_t share) const {
  const AxisNode& at = nodes[node[share]];
  const Triple<double>& place = place_of(numbers, blend);
  const Vec3 a = at.frame.transpose() * (Vec3(place.x, place.y, place.z) - at.origin);
  return {at.t, a.x(), a.y(), a.z()};
}

Vec3 BindingLayout::base_of(std::span<const CurvePair> pairs) {
  const Points u = pairs[0].primary().control_points();
  return u[u.size() / 2];
}

void BindingLayout::make_spans() {
  for (std::size_t k = 0; k < knots.size(); ++k) {
    span_index_.emplace_back(knots[k].knots().size(), 0);
    for (const int at : knots[k].nonempty_spans()) {
      span_index_[k][static_cast<std::size_t>(at)] = static_cast<std::uint32_t>(spans.size());
      spans.push_back(make_span(static_cast<std::uint32_t>(k), knots[k], at));
    }
  }
}

std::uint32_t BindingLayout::span_of(std::uint32_t of_pair, double t) const {
  return span_index_[of_pair][static_cast<std::size_t>(knots[of_pair].span(t))];
}

AxisNode BindingLayout::make_node(std::uint32_t of_pair, double t, const CurvePair& rest) const {
  const CurveFrame at = rest.frame(t);
  const std::uint32_t span = span_of(of_pair, t);
  AxisNode made{of_pair, span, t, spans[span].local(t), at.origin - rest_base, Mat3()};
  made.frame << at.frame.x, at.frame.y, at.frame.z;
  return made;
}

void BindingLayout::arrange(double negligible) {
  std::vector<std::uint32_t> key(size);
  for (std::size_t i = 0; i < size; ++i)
    key[i] = 2 * span_of(pair_of(i), entries[i].t) + (std::abs(entries[i].w) > negligible ? 1 : 0);
  nearest = sort_by_key(key, spans.size());
  slot.resize(size);
  numbers.nearest = Records<double>(size);
  Records<double>& records = numbers.nearest;
  for (const Run& run : nearest.runs)
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const AxialPoint& at = entries[nearest.entry[i]];
      slot[nearest.entry[i]] = static_cast<std::uint32_t>(i);
      records.s[i] = spans[run.span].local(at.t);
      records.u[i] = at.u;
      records.v[i] = at.v;
      records.w[i] = run.off ? at.w : 0.0;
    }
  if (!blends.empty()) kept.assign(size, 1.0);
  for (const Blend& blend : blends)
    for (std::size_t k = blend.begin; k < blend.end; ++k) kept[blend.point] -= numbers.share[k];
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
