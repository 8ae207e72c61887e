#include <tendril/base/error.h>
#include <tendril/bind/binding.h>

#include <string>

#include "place/layout.h"

namespace tendril::bind {
namespace {

/// A span's polynomials and those of its rates, the offset's in the scale of the former.
struct MovingPiece {
  Piece<double> at, rate;
};

MovingPiece moving_piece(const Span& span, std::span<const CurvePair> posed,
                         std::span<const CurvePair> rates) {
  MovingPiece result{pose<double>(span, posed[span.pair]), pose<double>(span, rates[span.pair])};
  const double by = result.rate.scale > 0.0 ? result.at.scale / result.rate.scale : 0.0;
  for (auto& row : result.rate.d)
    for (double& x : row) x *= by;
  return result;
}

/// The derivative of a unit vector a / |a|.
Triple<double> turn_of(const Triple<double>& unit, double inverse, const Triple<double>& rate) {
  return inverse * (rate - dot(unit, rate) * unit);
}

/// With z = c', x = d x z, X = x / |x|, Z = z / |z| the frame is (X, Z x X, Z). One that is near degenerate
/// does not turn.
template <int P>
FrameColumns rates(const MovingPiece& piece, double s) {
  const Moving<double> at = moving<double, P>(piece.at, s), by = moving<double, P>(piece.rate, s);
  if (!(at.sound > 0.5)) return {by.origin, {}, {}, {}};
  const Lengths<double> inverse = inverse_lengths(at);
  const Triple<double> x = inverse.x * at.x, z = inverse.z * at.z;
  const Triple<double> dx = turn_of(x, inverse.x, cross(by.offset, at.z) + cross(at.offset, by.z));
  const Triple<double> dz = turn_of(z, inverse.z, by.z);
  FrameColumns out{by.origin, dx, cross(dz, x) + cross(z, dx), dz};
  if (piece.at.turned) turn_columns(turn_at(piece.at, s), out);
  return out;
}

FrameColumns rates_of(const MovingPiece& piece, double s) {
  return for_degree(piece.at.degree, [&](auto degree) { return rates<decltype(degree)::value>(piece, s); });
}

}  // namespace

void Binding::velocities(std::span<const CurvePair> posed, std::span<const CurvePair> rates,
                         std::span<const std::uint32_t> points, MutablePoints out) const {
  const BindingLayout& layout = *layout_;
  layout.require_same_knots(posed);
  layout.require_same_knots(rates);
  if (out.size() != points.size())
    throw InvalidInput("out", std::to_string(out.size()) + " entries", std::to_string(points.size()));
  const auto make = [&](std::uint32_t span) { return moving_piece(layout.spans[span], posed, rates); };
  OnDemand<MovingPiece, decltype(make)> pieces(layout.spans.size(), make);
  const auto make_map = [&](std::uint32_t node) {
    const AxisNode& at = layout.nodes[node];
    return map_between<double>(at, rates_of(pieces[at.span], at.s));
  };
  OnDemand<AffineMap<double>, decltype(make_map)> maps(layout.nodes.size(), make_map);
  const auto map_of = [&](std::uint32_t node) -> const AffineMap<double>& { return maps[node]; };
  for (std::size_t i = 0; i < points.size(); ++i) {
    layout.require_point(points[i]);
    const std::size_t slot = layout.slot[points[i]];
    const Records<double>& record = layout.numbers.nearest;
    const FrameColumns by = rates_of(pieces[layout.nearest.run_of(slot).span], record.s[slot]);
    Triple<double> v = by.origin + record.u[slot] * by.x + record.v[slot] * by.y + record.w[slot] * by.z;
    if (const BindingLayout::Blend* blend = layout.blend_of(points[i]))
      v = mix(layout.shares_of(layout.numbers, *blend), map_of, layout.place_of(layout.numbers, *blend), v);
    out[i] = Vec3(v.x, v.y, v.z);
  }
}

}  // namespace tendril::bind
