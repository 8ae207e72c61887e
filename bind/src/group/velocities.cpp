#include <tendril/base/error.h>
#include <tendril/bind/binding.h>

#include <string>

#include "place/layout.h"
#include "place/sweep.h"

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

/// With z = c', x = d x z, X = x / |x|, Z = z / |z| the point is c + u X + v Z x X + w Z.
template <int P>
Triple<double> velocity(const MovingPiece& piece, const RecordsView<double>& record) {
  const double s = *record.s, u = *record.u, v = *record.v, w = *record.w;
  const Moving<double> at = moving<double, P>(piece.at, s), by = moving<double, P>(piece.rate, s);
  if (!(at.sound > 0.5)) return by.origin;
  const Lengths<double> inverse = inverse_lengths(at);
  const Triple<double> x = inverse.x * at.x, z = inverse.z * at.z;
  const Triple<double> dx = turn_of(x, inverse.x, cross(by.offset, at.z) + cross(at.offset, by.z));
  const Triple<double> dz = turn_of(z, inverse.z, by.z);
  return by.origin + u * dx + v * (cross(dz, x) + cross(z, dx)) + w * dz;
}

Triple<double> velocity_of(const MovingPiece& piece, const RecordsView<double>& record) {
  Triple<double> result{};
  for_degree(piece.at.degree,
             [&](auto degree) { result = velocity<decltype(degree)::value>(piece, record); });
  return result;
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
  const auto one = [&](const Order& order, const Records<double>& records, std::size_t slot) {
    const MovingPiece& piece = pieces[order.run_of(slot).span];
    double u, v;
    const RecordsView<double> given = records.from(slot);
    return velocity_of(piece, piece.at.turned ? turn_records(piece.at, given, 1, &u, &v) : given);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    layout.require_point(points[i]);
    const Triple<double> base = one(layout.nearest, layout.numbers.nearest, layout.slot[points[i]]);
    Triple<double> sum = base;
    if (const BindingLayout::Blend* blend = layout.blend_of(points[i]))
      for (std::size_t k = blend->begin; k < blend->end; ++k)
        sum =
            sum + layout.share[k] * (one(layout.others, layout.numbers.others, layout.other_slot[k]) - base);
    out[i] = Vec3(sum.x, sum.y, sum.z);
  }
}

}  // namespace tendril::bind
