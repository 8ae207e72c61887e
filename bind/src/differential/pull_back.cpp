#include <tendril/base/error.h>
#include <tendril/bind/binding.h>

#include <string>

#include "mesh/parallel.h"
#include "moments.h"
#include "place/layout.h"

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

/// force q^T, force: see MapForces.
MapForces times_place(const Vec3& force, const Triple<double>& q) {
  MapForces of;
  for (int i = 0; i < 3; ++i) {
    of.row[i][0] = force[i] * q.x;
    of.row[i][1] = force[i] * q.y;
    of.row[i][2] = force[i] * q.z;
    of.row[i][3] = force[i];
  }
  return of;
}

void add(double share, const MapForces& force, MapForces& to) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) to.row[i][j] += share * force.row[i][j];
}

/// Of the shares of blends [begin, end), each node's.
struct AddShares {
  static TENDRIL_INLINE void run(const BindingLayout& layout, Points forces, std::size_t begin,
                                 std::size_t end, MapForces* to) {
    for (std::size_t b = begin; b < end; ++b) {
      const auto& blend = layout.blends[b];
      const MapForces force = times_place(forces[blend.point], layout.numbers.place[b]);
      const Row<double> x = force.vector(0), y = force.vector(1), z = force.vector(2);
      for (std::size_t k = blend.begin; k < blend.end; ++k) {
        const double share = layout.numbers.share[k];
        MapForces& sum = to[layout.node[k]];
        sum.vector(0) += share * x;
        sum.vector(1) += share * y;
        sum.vector(2) += share * z;
      }
    }
  }
};

/// Adds the shares in nodes to the moments of their spans. The sums over a part of the blends are taken one
/// after the other, and how many parts there are depends on the blends alone.
void add_shares(const std::vector<Piece<double>>& pieces, const BindingLayout& layout, Points forces,
                int threads, std::vector<Moments>& to) {
  const std::size_t count = layout.blends.size(), parts = std::clamp<std::size_t>(count / 2048, 1, 16);
  const std::size_t nodes = layout.nodes.size();
  std::vector<MapForces> sums(parts * nodes, MapForces{});
  in_parts(parts, threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      OnUnits<AddShares>::run(widest_unit(), layout, forces, count * p / parts, count * (p + 1) / parts,
                              sums.data() + p * nodes);
  });
  for (std::size_t n = 0; n < nodes; ++n) {
    for (std::size_t p = 1; p < parts; ++p) add(1.0, sums[p * nodes + n], sums[n]);
    const AxisNode& node = layout.nodes[n];
    add_moments(node, pieces[node.span], sums[n], to[node.span]);
  }
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
    add_shares(pieces, layout, forces, threads, moments);
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
  const auto make_none = [](std::uint32_t) { return MapForces{}; };
  OnDemand<MapForces, decltype(make_none)> on_nodes(layout.nodes.size(), make_none);
  for (std::size_t i = 0; i < points.size(); ++i) {
    layout.require_point(points[i]);
    const BindingLayout::Blend* blend = layout.blend_of(points[i]);
    const Vec3 f = (blend ? layout.kept[points[i]] : 1.0) * forces[i];
    const std::size_t slot = layout.slot[points[i]];
    const std::uint32_t span = layout.nearest.run_of(slot).span;
    const Piece<double>& piece = pieces[span];
    double u, v;
    const RecordsView<double> given = layout.numbers.nearest.from(slot);
    const RecordsView<double> one = piece.turned ? turn_records(piece, given, 1, &u, &v) : given;
    add_moments(piece, one, {&f.x(), &f.y(), &f.z()}, 1, moments[span]);
    if (!blend) continue;
    const MapForces force = times_place(forces[i], layout.place_of(layout.numbers, *blend));
    for (std::size_t k = blend->begin; k < blend->end; ++k)
      add(layout.numbers.share[k], force, on_nodes[layout.node[k]]);
  }
  for (std::uint32_t n = 0; n < layout.nodes.size(); ++n)
    if (on_nodes.has(n)) {
      const AxisNode& node = layout.nodes[n];
      add_moments(node, pieces[node.span], on_nodes[n], moments[node.span]);
    }
  return to_controls(layout, [&](std::uint32_t s, ControlForces& to) {
    if (pieces.has(s)) add_to_controls(layout.spans[s], pieces[s], moments[s], to);
  });
}

}  // namespace tendril::bind
