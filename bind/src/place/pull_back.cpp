#include <tendril/base/error.h>
#include <tendril/bind/binding.h>

#include <string>

#include "layout.h"
#include "mesh/parallel.h"
#include "moments.h"

namespace tendril::bind {
namespace {

constexpr std::size_t kPart = 16 * kMomentChunk;  // slots that one partial sum is taken over

void check(Points forces, std::size_t expected, int threads) {
  if (forces.size() != expected)
    throw InvalidInput("forces", std::to_string(forces.size()) + " of them", std::to_string(expected));
  require_threads(threads);
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (!is_finite(forces[i]))
      throw InvalidInput("forces[" + std::to_string(i) + "]", "not finite", "three finite numbers");
}

/// The runs cut into parts of at most kPart slots: the same for any number of threads.
std::vector<Run> parts_of(const Order& order) {
  std::vector<Run> parts;
  for (const Run& run : order.runs)
    for (std::uint32_t at = run.begin; at < run.end; at += kPart)
      parts.push_back({run.span, at, std::min(run.end, static_cast<std::uint32_t>(at + kPart)), run.off});
  return parts;
}

/// \param force_of  of an entry: the force on its position
template <class ForceOf>
void add_part(const Piece<double>& piece, const Order& order, const Records<double>& records, const Run& part,
              const ForceOf& force_of, Moments& to) {
  std::array<double, kMomentChunk> x, y, z, u, v;
  for (std::size_t at = part.begin; at < part.end; at += kMomentChunk) {
    const std::size_t count = std::min<std::size_t>(kMomentChunk, part.end - at);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 f = force_of(order.entry[at + i]);
      x[i] = f.x();
      y[i] = f.y();
      z[i] = f.z();
    }
    const RecordsView<double> given = records.from(at);
    const RecordsView<double> some =
        piece.turned ? turn_records(piece, given, count, u.data(), v.data()) : given;
    add_moments(piece, some, {x.data(), y.data(), z.data()}, count, to);
  }
}

/// Adds all of an order to the moments of its spans.
template <class ForceOf>
void add_order(const std::vector<Piece<double>>& pieces, const Order& order, const Records<double>& records,
               int threads, const ForceOf& force_of, std::vector<Moments>& to) {
  const std::vector<Run> parts = parts_of(order);
  std::vector<Moments> sums(parts.size());
  in_parts(parts.size(), threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      add_part(pieces[parts[p].span], order, records, parts[p], force_of, sums[p]);
  });
  for (std::size_t p = 0; p < parts.size(); ++p) to[parts[p].span] += sums[p];
}

/// From a span's polynomials to its control points: the transpose of pose().
void add_to_controls(const Span& span, const Piece<double>& piece, const Moments& moments,
                     ControlForces& to) {
  const auto vector = [](const std::array<double, 3>& a) { return Vec3(a[0], a[1], a[2]); };
  Vec3 base = vector(moments.c[0]);
  for (std::size_t i = 0; i < span.terms(); ++i) {
    Vec3 from_base = Vec3::Zero(), offset = Vec3::Zero();
    for (std::size_t j = 0; j < span.terms(); ++j) {
      from_base += span.power[j][i] * vector(moments.c[j]);
      offset += span.power[j][i] * vector(moments.d[j]);
    }
    offset *= piece.scale;
    base -= from_base;
    to.primary[span.first + i] += from_base - offset;
    to.orientation[span.first + i] += offset;
  }
  to.primary[span.reference()] += base;
}

/// On every pair's control points.
/// \param add  adds those of a span, where it has any
template <class Add>
std::vector<ControlForces> to_controls(const BindingLayout& layout, const Add& add) {
  std::vector<ControlForces> result;
  for (const KnotVector& knots : layout.knots) {
    const std::vector<Vec3> none(static_cast<std::size_t>(knots.control_points()), Vec3::Zero());
    result.push_back({none, none});
  }
  for (std::uint32_t s = 0; s < layout.spans.size(); ++s) add(s, result[layout.spans[s].pair]);
  return result;
}

}  // namespace

std::vector<ControlForces> Binding::pull_back(std::span<const CurvePair> posed, Points forces,
                                              int threads) const {
  const BindingLayout& layout = *layout_;
  layout.require_same_knots(posed);
  check(forces, layout.size, threads);
  const auto pieces = pose<double>(layout.spans, posed);
  std::vector<Moments> moments(pieces.size());
  if (layout.blends.empty()) {
    add_order(
        pieces, layout.nearest, layout.numbers.nearest, threads,
        [&](std::size_t entry) { return forces[entry]; }, moments);
  } else {
    add_order(
        pieces, layout.nearest, layout.numbers.nearest, threads,
        [&](std::size_t entry) { return Vec3(layout.kept[entry] * forces[entry]); }, moments);
    add_order(
        pieces, layout.others, layout.numbers.others, threads,
        [&](std::size_t entry) {
          const std::size_t k = entry - layout.size;
          return Vec3(layout.share[k] * forces[layout.owner[k]]);
        },
        moments);
  }
  return to_controls(layout, [&](std::uint32_t s, ControlForces& to) {
    add_to_controls(layout.spans[s], pieces[s], moments[s], to);
  });
}

std::vector<ControlForces> Binding::pull_back(std::span<const CurvePair> posed,
                                              std::span<const std::uint32_t> points, Points forces) const {
  const BindingLayout& layout = *layout_;
  layout.require_same_knots(posed);
  check(forces, points.size(), 1);
  auto pieces = on_demand<double>(layout.spans, posed);
  std::vector<Moments> moments(layout.spans.size());
  const auto add = [&](const Order& order, const Records<double>& records, std::size_t slot, const Vec3& f) {
    const std::uint32_t span = order.run_of(slot).span;
    double u, v;
    const RecordsView<double> given = records.from(slot);
    const Piece<double>& piece = pieces[span];
    const RecordsView<double> one = piece.turned ? turn_records(piece, given, 1, &u, &v) : given;
    add_moments(piece, one, {&f.x(), &f.y(), &f.z()}, 1, moments[span]);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    layout.require_point(points[i]);
    const BindingLayout::Blend* blend = layout.blend_of(points[i]);
    const double kept = blend ? layout.kept[points[i]] : 1.0;
    add(layout.nearest, layout.numbers.nearest, layout.slot[points[i]], kept * forces[i]);
    if (!blend) continue;
    for (std::size_t k = blend->begin; k < blend->end; ++k)
      add(layout.others, layout.numbers.others, layout.other_slot[k], layout.share[k] * forces[i]);
  }
  return to_controls(layout, [&](std::uint32_t s, ControlForces& to) {
    if (pieces.has(s)) add_to_controls(layout.spans[s], pieces[s], moments[s], to);
  });
}

}  // namespace tendril::bind
