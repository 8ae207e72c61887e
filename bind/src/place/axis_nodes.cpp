#include "axis_nodes.h"

namespace tendril::bind {
namespace {

Triple<double> triple(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <int P>
FrameColumns columns(const Moving<double>& at) {
  const Lengths<double> inverse = inverse_lengths(at);
  return {at.origin, inverse.x * at.x, inverse.both * cross(at.z, at.x), inverse.z * at.z};
}

/// Where the polynomials' frame is near degenerate, by the rules of CurvePair::frame.
FrameColumns columns_of(const AxisNode& node, const Piece<double>& piece, const CurvePair& posed) {
  return for_degree(piece.degree, [&](auto degree) {
    constexpr int p = decltype(degree)::value;
    const Moving<double> at = moving<double, p>(piece, node.s);
    if (!(at.sound > 0.5)) {
      const CurveFrame by_rule = posed.frame(node.t);
      return FrameColumns{triple(by_rule.origin), triple(by_rule.frame.x), triple(by_rule.frame.y),
                          triple(by_rule.frame.z)};
    }
    FrameColumns frame = columns<p>(at);
    if (piece.turned) turn_columns(turn_at(piece, node.s), frame);
    return frame;
  });
}

}  // namespace

template <class T>
AffineMap<T> map_between(const AxisNode& node, const FrameColumns& to) {
  Mat3 turned;
  turned << to.x.x, to.y.x, to.z.x, to.x.y, to.y.y, to.z.y, to.x.z, to.y.z, to.z.z;
  const Mat3 a = turned * node.frame.transpose();
  const Vec3 b = Vec3(to.origin.x, to.origin.y, to.origin.z) - a * node.origin;
  AffineMap<T> map;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) map.row[i][j] = static_cast<T>(a(i, j));
    map.row[i][3] = static_cast<T>(b[i]);
  }
  return map;
}

template <class T>
AffineMap<T> map_of(const AxisNode& node, const Piece<double>& piece, const CurvePair& posed,
                    const Vec3& base) {
  FrameColumns frame = columns_of(node, piece, posed);
  frame.origin = frame.origin - triple(base);
  return map_between<T>(node, frame);
}

template AffineMap<double> map_between(const AxisNode&, const FrameColumns&);
template AffineMap<float> map_between(const AxisNode&, const FrameColumns&);
template AffineMap<double> map_of(const AxisNode&, const Piece<double>&, const CurvePair&, const Vec3&);
template AffineMap<float> map_of(const AxisNode&, const Piece<double>&, const CurvePair&, const Vec3&);

}  // namespace tendril::bind
