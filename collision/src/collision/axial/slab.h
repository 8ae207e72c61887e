#pragma once

#include <tendril/collision/box_tree.h>
#include <tendril/curve/knots.h>

#include <array>

/// Slabs: short pieces of a curve-pair's parameter, with bounds of the curve and of its frame that hold on
/// all of the piece.
namespace tendril::collision {

inline constexpr std::size_t kMostControls = kMaxDegree + 1;

/// How the control points of a span become those of the slab in Bernstein form; depends on the knots alone.
struct SlabWeights {
  std::array<std::array<double, kMostControls>, kMostControls> row{};
  double width = 1.0;  ///< of the span
};

/// The control points of a span, and sizes that rounding errors are relative to. All of them finite.
struct SpanControls {
  SpanControls() {
    c.fill(Vec3::Zero());
    n.fill(Vec3::Zero());
  }

  std::size_t count = 0;                           ///< degree + 1
  Vec3 base = Vec3::Zero();                        ///< what c is relative to
  std::array<Vec3, kMostControls> c, n;            ///< of c - base, and of c_D - c
  double reach = 0.0, offset = 0.0, origin = 0.0;  ///< largest |c_i|, |n_i|; of c and c_D from the origin
};

/// Bounds in the middle-and-radius form: a coordinate is middle[k] up to radius[k].
struct Spread {
  Vec3 middle = Vec3::Zero(), radius = Vec3::Zero();
};

struct Slab {
  Spread c;
  std::array<Spread, 3> axis;  ///< l_x, l_y, l_z, where framed
  bool framed = false;         ///< false: nothing is known of the frame but that its axes have length 1
};

/// Bounds for every place that BoundPoints may compute in the slab.
///
/// The curve lies in the hull of its control points. For the frame, choose axes e_x, e_y, e_z near it. With
/// c' = sum B_j (a_j, b_j, g_j) in them and all g_j > 0, alpha = c'_x / c'_z is a mean of a_j / g_j with the
/// weights B_j g_j, so between the least and the largest of these; so beta = c'_y / c'_z, and with
/// n = sum B_j (p_j, q_j, r_j) and all q_j > 0 also P = n_x / n_y and R = n_z / n_y. Then
///   l_z ~ (alpha, beta, 1),  l_x ~ n x l_z ~ (1, xi, zeta),  xi = (R alpha - P) / (1 - R beta),
///   zeta = (P beta - alpha) / (1 - R beta),  l_y = l_z x l_x,
/// in interval arithmetic. What rounding does before the ratios (control points, components) is a change of
/// c' by at most 2^-40 of the reach and of n by 2^-40 of the offset; with that of BoundPoints it turns the
/// frame by no more than `turn` below, which is added to each component. Slabs that bend more than half a
/// right angle, where |dc/ds| is below 1/64 of the reach or the part of n across it below 1/16 of the offset,
/// are not framed.
Slab bound_slab(const SpanControls& span, const SlabWeights& weights);

/// Ranges of (u, v, w) in the same form; w's holds 0.
struct AxialRange {
  Vec3 middle, radius;
  double reach;  ///< largest |u| + |v| + |w|
};

/// The smallest known box about all points whose record lies in the slab and the range; all space where the
/// numbers are too large.
Box bound(const Slab& slab, const AxialRange& range);

}  // namespace tendril::collision
