#include "slab_table.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <limits>
#include <string>

namespace tendril::collision {
namespace {

// A slab reaches over its ends, as which slab a parameter belongs to is rounded. Of the span's length.
constexpr double kOver = 1e-12;

// Slabs come from weights that the knots alone determine, so that a frame costs no evaluation of the curves
// but sums of products, and a slab that no query asks for costs nothing.

/// The weight of control point i in the blossom of the span's piece at `arguments`: de Boor's triangle.
double blossom(const KnotVector& knots, int span, std::size_t i, const std::array<double, kMaxDegree>& at) {
  const auto p = static_cast<std::size_t>(knots.degree());
  const double* knot = knots.knots().data() + span;
  std::array<double, kMostControls> d{};
  d[i] = 1.0;
  for (std::size_t level = 1; level <= p; ++level)
    for (std::size_t j = p; j >= level; --j) {
      const double left = knot[static_cast<std::ptrdiff_t>(j) - static_cast<std::ptrdiff_t>(p)];
      const double right = knot[j + 1 - level];
      const double w = (at[level - 1] - left) / (right - left);
      d[j] = (1.0 - w) * d[j - 1] + w * d[j];
    }
  return d[p];
}

/// A polynomial's Bernstein coefficients on [from, to] are its blossom at p - j times `from` and j times `to`
/// [Ramshaw 1989]; the weights are those of the unit control points, one after the other.
SlabWeights weights_of(const KnotVector& knots, int span, double from, double to) {
  const auto p = static_cast<std::size_t>(knots.degree());
  const double a = knots.knots()[static_cast<std::size_t>(span)];
  const double length = knots.knots()[static_cast<std::size_t>(span) + 1] - a;
  SlabWeights weights;
  weights.width = to - from;
  std::array<double, kMaxDegree> at{};
  for (std::size_t j = 0; j <= p; ++j) {
    for (std::size_t k = 0; k < p; ++k) at[k] = a + length * (k < p - j ? from : to);
    for (std::size_t i = 0; i <= p; ++i) weights.row[j][i] = blossom(knots, span, i, at);
  }
  return weights;
}

bool same(const Vec3* a, const Vec3* b, std::size_t count) {
  return std::equal(a, a + count, b,
                    [](const Vec3& x, const Vec3& y) { return (x.array() == y.array()).all(); });
}

SpanControls controls_of(const Vec3* u, const Vec3* v, std::size_t count) {
  // Relative to a point of their own, so that rounding is relative to the span's size and not to its place.
  SpanControls out;
  out.count = count;
  out.base = u[count / 2];
  for (std::size_t i = 0; i < count; ++i) {
    out.c[i] = u[i] - out.base;
    out.n[i] = v[i] - u[i];
    out.reach = std::max(out.reach, out.c[i].norm());
    out.offset = std::max(out.offset, out.n[i].norm());
    out.origin = std::max(out.origin, std::max(u[i].norm(), v[i].norm()));
  }
  return out;
}

std::size_t spans_of(std::span<const CurvePair> rest) {
  std::size_t count = 0;
  for (const CurvePair& pair : rest) count += pair.knots().nonempty_spans().size();
  return count;
}

}  // namespace

SlabTable::SlabTable(std::span<const CurvePair> rest, std::size_t wanted) {
  const std::size_t per_span = std::max<std::size_t>(1, wanted / spans_of(rest));
  for (const CurvePair& pair : rest) add_pair(pair, per_span);
  slabs_.resize(weights_.size());
  made_at_.assign(weights_.size(), 0);
}

void SlabTable::add_pair(const CurvePair& rest, std::size_t per_span) {
  const KnotVector& knots = rest.knots();
  PairSpans pair{knots, std::vector<std::uint32_t>(knots.knots().size()), {}, {}, {}, 0};
  pair.first_span = static_cast<std::uint32_t>(spans_.size());
  for (const int at : knots.nonempty_spans()) {
    const auto index = static_cast<std::size_t>(at);
    const double begin = knots.knots()[index], length = knots.knots()[index + 1] - begin;
    pair.span_at[index] = static_cast<std::uint32_t>(spans_.size());
    spans_.push_back({static_cast<std::uint32_t>(pairs_.size()), static_cast<std::uint32_t>(weights_.size()),
                      static_cast<std::uint32_t>(per_span), index - static_cast<std::size_t>(knots.degree()),
                      static_cast<std::size_t>(knots.degree()) + 1, begin, length,
                      weights_of(knots, at, -kOver, 1.0 + kOver)});
    for (std::size_t k = 0; k < per_span; ++k) {
      const double part = 1.0 / static_cast<double>(per_span), from = static_cast<double>(k) * part;
      weights_.push_back(weights_of(knots, at, from - kOver, from + part + kOver));
      span_of_.push_back(static_cast<std::uint32_t>(spans_.size() - 1));
    }
  }
  pairs_.push_back(std::move(pair));
}

std::uint32_t SlabTable::slab_of(std::uint32_t pair, double t) const {
  const Span& span = spans_[pairs_[pair].span_at[static_cast<std::size_t>(pairs_[pair].knots.span(t))]];
  const double at = (t - span.begin) / span.length * span.slabs;
  return span.first_slab + static_cast<std::uint32_t>(std::clamp(at, 0.0, span.slabs - 1.0));
}

Slab SlabTable::make(const Span& span, const SlabWeights& weights) {
  ++made_;
  const Slab slab = bound_slab(span.controls, weights);
  if (!slab.framed) ++unframed_;
  return slab;
}

const Slab& SlabTable::slab(std::size_t index) {
  const Span& span = spans_[span_of_[index]];
  if (made_at_[index] < span.changed) {
    slabs_[index] = make(span, weights_[index]);
    made_at_[index] = span.changed;
  }
  return slabs_[index];
}

Box SlabTable::box(std::uint32_t first, std::uint32_t last, const AxialRange& range) {
  Box out{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (std::uint32_t i = first; i <= last;) {
    const Span& span = spans_[span_of_[i]];
    // One bound for all of a span serves the large nodes near the root, and spares them its slabs.
    const bool whole = i == span.first_slab && last + 1 >= i + span.slabs;
    out = join(out, bound(whole ? span.whole : slab(i), range));
    i += whole ? span.slabs : 1;
  }
  return out;
}

void SlabTable::change(Span& span, const CurvePair& posed, std::uint32_t frame) {
  // A frame turned beyond its orientation curve counts as none: about it points may be anywhere.
  const BSpline& side = posed.turn().empty() ? posed.orientation() : posed.primary();
  span.controls = controls_of(posed.primary().control_points().data() + span.first_control,
                              side.control_points().data() + span.first_control, span.count);
  span.whole = make(span, span.weights);
  span.changed = frame;
  span.framed = true;
  // A frame on the whole span holds on its slabs. Else each has to be asked, now: whether the span has a
  // frame everywhere decides what may be kept in the next frame.
  if (span.whole.framed) return;
  for (std::size_t i = span.first_slab; i < span.first_slab + span.slabs; ++i)
    span.framed = slab(i).framed && span.framed;
}

void SlabTable::pose(std::span<const CurvePair> posed, std::uint32_t frame) {
  if (posed.size() != pairs_.size())
    throw InvalidInput("posed", std::to_string(posed.size()) + " curve-pairs", std::to_string(pairs_.size()));
  for (std::size_t k = 0; k < posed.size(); ++k)
    if (posed[k].knots() != pairs_[k].knots)
      throw InvalidInput("posed curve-pair", "other knots", "those of the rest");
  made_ = unframed_ = 0;
  // By value, not by a flag of the caller's: what is compared is what the bounds were made from.
  for (Span& span : spans_) {
    const PairSpans& pair = pairs_[span.pair];
    const Points u = posed[span.pair].primary().control_points();
    const Points v = posed[span.pair].orientation().control_points();
    const auto unmoved = [&](std::size_t from, std::size_t count) {
      return span.changed > 0 && same(u.data() + from, pair.primary.data() + from, count) &&
             same(v.data() + from, pair.orientation.data() + from, count);
    };
    // Where a frame is near degenerate, all control points of its curve-pair may have a say.
    const bool same_turn = std::ranges::equal(posed[span.pair].turn(), pair.turn);
    const bool kept = !same_turn    ? false
                      : span.framed ? unmoved(span.first_control, span.count)
                                    : unmoved(0, u.size());
    if (!kept) change(span, posed[span.pair], frame);
  }
  for (std::size_t k = 0; k < posed.size(); ++k) {
    const Points u = posed[k].primary().control_points(), v = posed[k].orientation().control_points();
    pairs_[k].primary.assign(u.begin(), u.end());
    pairs_[k].orientation.assign(v.begin(), v.end());
    pairs_[k].turn.assign(posed[k].turn().begin(), posed[k].turn().end());
  }
}

std::uint32_t SlabTable::last_change(std::uint32_t first, std::uint32_t last) const {
  std::uint32_t frame = 0;
  for (std::size_t k = span_of_[first]; k <= span_of_[last]; ++k) frame = std::max(frame, spans_[k].changed);
  return frame;
}

}  // namespace tendril::collision
