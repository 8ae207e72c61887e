#include "elastic.h"

#include <cmath>
#include <cstdint>

#include "dynamics/vector/column_access.h"
#include "held.h"
#include "hinge.h"
#include "kinematics.h"
#include "spring_loops.h"

namespace tendril {
namespace {

using Segment = Model::Segment;
using lanes::Reader;
using lanes::V3;
using lanes::Writer;

/// What a loop over springs does beside the gradient (viscous, third, energy), and what it takes for granted:
/// that all are straight at rest, that all angles are small.
struct Wanted {
  bool viscous = false, third = false, energy = false, straight = false, near = false;
};

/// What a loop reads and writes; see bend and twist.
struct Columns {
  TENDRIL_INLINE Columns(const Model& model, const State& from, const Kinematics& kin, Gradient& grad)
      : k_l(model.bending.k_l.data()),
        k_m(model.bending.k_m.data()),
        k_t(model.bending.k_t.data()),
        rest_l(model.bending.rest_l.data()),
        rest_m(model.bending.rest_m.data()),
        rest_t(model.bending.rest_t.data()),
        viscosity(model.viscosity.data()),
        k_stretch(model.stretch.data()),
        rest_length(model.rest_length.data()),
        k_twist(model.twist.data()),
        rest_twist(model.rest_twist.data()),
        reference(from.twist.data()),
        spin(kin.spin.data()),
        length(kin.length.data()),
        e(kin.e),
        e_rate(kin.rate.e_rate),
        m(kin.frame.y),
        t(kin.frame.z),
        turning(kin.rate.turning),
        g_bend(grad.bend),
        twist_tangent(grad.twist_tangent),
        g_length(grad.length.data()),
        g_spin(grad.spin.data()),
        twist_torque(grad.twist_torque.data()),
        twist_strain(grad.twist_strain.data()),
        energy(grad.energy.data()),
        heat(grad.heat.data()) {}

  const double* __restrict k_l;
  const double* __restrict k_m;
  const double* __restrict k_t;
  const double* __restrict rest_l;
  const double* __restrict rest_m;
  const double* __restrict rest_t;
  const double* __restrict viscosity;
  const double* __restrict k_stretch;
  const double* __restrict rest_length;
  const double* __restrict k_twist;
  const double* __restrict rest_twist;
  const double* __restrict reference;
  const double* __restrict spin;
  const double* __restrict length;
  const Reader e, e_rate, m, t, turning;
  const Writer g_bend, twist_tangent;
  double* __restrict g_length;
  double* __restrict g_spin;
  double* __restrict twist_torque;
  double* __restrict twist_strain;
  double* __restrict energy;
  double* __restrict heat;
};

struct Axes {
  V3 l, m, t;
};

/// What bends a node: the components x, y of half the difference of its edges across the tangent, their
/// square, and the angle's arc.
struct Bend {
  double x, y, across2, sine, z;
  lanes::Arc arc;
};

template <Wanted W>
TENDRIL_INLINE Bend bend_at(double x, double y, double z) {
  const double across2 = x * x + y * y;
  if constexpr (W.near) return {x, y, across2, 0.0, 1.0, lanes::near_arc(across2)};
  const double sine = std::sqrt(across2);
  return {x, y, across2, sine, z, lanes::arc(across2, sine, z)};
}

/// k (angle - rest) / (sin angle cos angle), the third spring's slope over the sine.
template <Wanted W>
TENDRIL_INLINE double third_slope(double k, double rest, const Bend& at, double& energy) {
  const double inverse_cosine = at.arc.ratio + at.arc.rise * at.across2;
  if constexpr (W.near) return k * at.arc.ratio * inverse_cosine;
  const double strain = at.arc.ratio * at.sine - rest;
  if constexpr (W.energy) energy += k * strain * strain;
  // At angle 0 what it is multiplied with is 0.
  const bool away = at.sine > 1e-12 && at.z > 0.0;
  return away ? k * strain / (away ? at.sine * at.z : 1.0) : 0.0;
}

/// Slopes by x and y of the two deviations' springs, with what resists: with the deviations r x and r y, r
/// the arc's ratio, and their forces f_l and f_m, r f + rise (x f_l + y f_m) (x, y).
struct Slopes {
  double l, m;
};
template <Wanted W>
TENDRIL_INLINE Slopes deviation_slopes(const Columns& c, std::size_t i, const Axes& f, const Bend& at,
                                       double& energy, double& heat) {
  const auto [x, y, across2, sine, z, arc] = at;
  const double strain_l = W.straight ? arc.ratio * x : arc.ratio * x - c.rest_l[i];
  const double strain_m = W.straight ? arc.ratio * y : arc.ratio * y - c.rest_m[i];
  double fl = c.k_l[i] * strain_l;
  double fm = c.k_m[i] * strain_m;
  if constexpr (W.energy) energy += fl * strain_l + fm * strain_m;
  if constexpr (W.viscous) {
    const V3 d_rate = 0.5 * (c.e_rate.at(i) - c.e_rate.at(i - 1));
    const double x_rate = lanes::dot(d_rate, f.l) + c.spin[i] * y;
    const double y_rate = lanes::dot(d_rate, f.m) - c.spin[i] * x;
    const double rising = arc.rise * (x * x_rate + y * y_rate);
    const double l_rate = arc.ratio * x_rate + rising * x;
    const double m_rate = arc.ratio * y_rate + rising * y;
    heat += 2.0 * c.viscosity[i] * (c.k_l[i] * l_rate * l_rate + c.k_m[i] * m_rate * m_rate);
    fl += c.viscosity[i] * c.k_l[i] * l_rate;
    fm += c.viscosity[i] * c.k_m[i] * m_rate;
  }
  const double both = arc.rise * (x * fl + y * fm);
  return {arc.ratio * fl + both * x, arc.ratio * fm + both * y};
}

/// Bending at node i. With d half the difference of the unit edges b and a at a free node, |d| is the sine of
/// the angle phi that b makes with the tangent between them; x = d.l, y = d.m, and d.t = 0. The turn of b
/// away from the tangent is phi (x, y) / |d|, that of a the opposite, and both edges together have
///   E = k_l (phi x / |d| - r_l)^2 + k_m (phi y / |d| - r_m)^2 + k_t (phi - r_t)^2,
/// in isotropic straight rods K phi^2, as without a twist state (hinge.cpp). As d.t = 0, a tangent that turns
/// with its director does not change x and y: dx = l.dd + y ds, dy = m.dd - x ds. The gradient by b is half
/// that by d, that by a its opposite. False where an angle was not small and was taken for it.
template <Wanted W>
TENDRIL_INLINE bool bend(const Columns& c, std::size_t i, const Axes& f, double& energy, double& heat) {
  const V3 a = c.e.at(i - 1);
  const V3 b = c.e.at(i);
  const V3 d = 0.5 * (b - a);
  const Bend at =
      bend_at<W>(lanes::dot(d, f.l), lanes::dot(d, f.m), W.near ? 1.0 : 0.5 * lanes::dot(a + b, f.t));
  Slopes g = deviation_slopes<W>(c, i, f, at, energy, heat);
  c.g_spin[i] = 2.0 * (g.l * at.y - g.m * at.x);
  bool straight = true;
  if constexpr (W.third) {
    const double rest = W.straight ? 0.0 : c.rest_t[i];
    const double k = third_slope<W>(c.k_t[i], rest, at, energy);
    g.l += k * at.x;
    g.m += k * at.y;
    straight = rest == 0.0;
  }
  c.g_bend.put(i, g.l * f.l + g.m * f.m);
  const bool near = (at.across2 <= lanes::kNearSquare) & straight;
  return near | (c.k_l[i] + c.k_m[i] + c.k_t[i] == 0.0);
}

/// The twist spring of edge i, at tau from its rest: the angle about t_a from m_a to m_b, carried there by
/// the smallest rotation of the tangents. d tau = s_b - s_a + q.(dt_a + dt_b), q = (t_a x t_b) / (1 +
/// t_a.t_b): what that rotation turns by itself.
template <Wanted W>
TENDRIL_INLINE bool twist(const Columns& c, std::size_t i, const Axes& f, double& energy, double& heat) {
  const V3 tb = c.t.at(i + 1);
  const V3 mb = c.m.at(i + 1);
  const double spread = 1.0 + lanes::dot(f.t, tb);
  const double s = 1.0 / spread;
  const double back = lanes::dot(f.t, mb) * s;
  const double sine = back * lanes::dot(f.l, tb) - lanes::dot(f.l, mb);
  const double along = lanes::dot(f.m, mb);
  const double raw =
      W.near ? sine * lanes::asin_ratio(sine * sine) : lanes::angle(sine, along - back * lanes::dot(f.m, tb));
  const double tau = c.reference[i] + lanes::less_turns(raw - c.reference[i]);
  const double strain = tau - c.rest_twist[i];
  double torque = c.k_twist[i] * strain;
  if constexpr (W.energy) energy += 0.5 * torque * strain;
  if constexpr (W.viscous) {
    // q.(t_a' + t_b'), with t' = (t x t') x t.
    const double rotating = s * (lanes::dot(f.t, c.turning.at(i + 1)) - lanes::dot(tb, c.turning.at(i)));
    const double rate = c.spin[i + 1] - c.spin[i] + rotating;
    const double resistance = c.viscosity[i] * c.k_twist[i] * rate;
    heat += resistance * rate;
    torque += resistance;
    c.twist_strain[i] = strain;
  }
  c.twist_torque[i] = torque;
  c.twist_tangent.put(i, (torque * s) * lanes::cross(f.t, tb));
  // Between tangents less than 41 degrees apart the directors tell an angle near 0 from one near a half turn.
  const bool near = (sine * sine <= lanes::kNearSquare) & (spread >= 1.75) & (along > 0.0);
  return near | (c.k_twist[i] == 0.0);
}

/// Stretch of edge i.
template <Wanted W>
TENDRIL_INLINE void stretch(const Columns& c, std::size_t i, double& energy) {
  const double strain = c.length[i] - c.rest_length[i];
  c.g_length[i] = c.k_stretch[i] * strain;
  if constexpr (W.energy) energy += 0.5 * c.g_length[i] * strain;
}

/// Bending of nodes [first, end), stretch and twist of the edges that begin there.
template <Wanted W>
TENDRIL_INLINE bool strain(const Model& model, const State& from, std::size_t first, std::size_t end,
                           const Kinematics& kin, Gradient& grad) {
  const Columns c(model, from, kin, grad);
  std::int64_t far = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 m = c.m.at(i);
    const V3 t = c.t.at(i);
    const Axes f{lanes::cross(m, t), m, t};
    double energy = 0.0;
    double heat = 0.0;
    stretch<W>(c, i, energy);
    const bool bent_near = bend<W>(c, i, f, energy, heat);
    const bool twisted_near = twist<W>(c, i, f, energy, heat);
    far |= (bent_near & twisted_near) ? 0 : 1;
    if constexpr (W.energy) c.energy[i] = energy;
    if constexpr (W.viscous) c.heat[i] = heat;
  }
  return !W.near || far == 0;
}

TENDRIL_LANES bool plain_near(const Model& model, const State& from, std::size_t first, std::size_t end,
                              const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.near = true}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool plain_straight(const Model& model, const State& from, std::size_t first, std::size_t end,
                                  const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.straight = true, .near = true}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool plain_far(const Model& model, const State& from, std::size_t first, std::size_t end,
                             const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool thrice_near(const Model& model, const State& from, std::size_t first, std::size_t end,
                               const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.third = true, .near = true}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool thrice_straight(const Model& model, const State& from, std::size_t first, std::size_t end,
                                   const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.third = true, .straight = true, .near = true}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool thrice_far(const Model& model, const State& from, std::size_t first, std::size_t end,
                              const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.third = true}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool viscous_near(const Model& model, const State& from, std::size_t first, std::size_t end,
                                const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.viscous = true, .third = true, .near = true}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool viscous_far(const Model& model, const State& from, std::size_t first, std::size_t end,
                               const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.viscous = true, .third = true}>(model, from, first, end, kin, grad);
}
TENDRIL_LANES bool with_energy(const Model& model, const State& from, std::size_t first, std::size_t end,
                               const Kinematics& kin, Gradient& grad) {
  return strain<Wanted{.third = true, .energy = true}>(model, from, first, end, kin, grad);
}

Loops loops_of(const Segment& segment, bool viscous) {
  if (viscous) return {viscous_near, viscous_far};
  if (segment.third) return {segment.straight ? thrice_straight : thrice_near, thrice_far};
  return {segment.straight ? plain_straight : plain_near, plain_far};
}

/// What the twist springs give the nodes, and the gyroscopic force of their spin: -I w t x t' by the tangent.
template <bool Gyroscopic>
TENDRIL_INLINE void gather(const Model& model, const Segment& segment, const Kinematics& kin,
                           Gradient& grad) {
  const Reader from(grad.twist_tangent), turning(kin.rate.turning);
  const Writer to(grad.tangent);
  const double *__restrict torque = grad.twist_torque.data(), *__restrict spin = kin.spin.data(),
               *__restrict inertia = model.free_inertia.data();
  double* __restrict to_spin = grad.spin.data();
  TENDRIL_LOOP
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    V3 g = from.at(i - 1) + from.at(i);
    if constexpr (Gyroscopic) g = g - (inertia[i] * spin[i]) * turning.at(i);
    to.put(i, g);
    to_spin[i] += torque[i - 1] - torque[i];
  }
}
TENDRIL_LANES void gather_springs(const Model& model, const Segment& segment, const Kinematics& kin,
                                  Gradient& grad) {
  gather<false>(model, segment, kin, grad);
}
TENDRIL_LANES void gather_all(const Model& model, const Segment& segment, const Kinematics& kin,
                              Gradient& grad) {
  gather<true>(model, segment, kin, grad);
}

double sum_of(const Column& column, const Segment& segment) {
  double sum = 0.0;
  for (std::size_t i = segment.first; i < segment.end; ++i) sum += column[i];
  return sum;
}

/// What the loops left where no edge is must not reach the next rod's first node.
void clear_ends(const Model& model, Gradient& grad) {
  for (const NodeRange& rod : model.rods) {
    const std::size_t last = rod.first + rod.count - 1;
    grad.twist_tangent.set(last, Vec3::Zero());
    grad.twist_torque[last] = 0.0;
    grad.energy[last] = 0.0;
    grad.heat[last] = 0.0;
  }
}

double resist_stretch(const Model& model, const Segment& segment, const Kinematics& kin, Gradient& grad) {
  double heat = 0.0;
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    const double resistance = model.viscosity[i] * model.stretch[i] * kin.rate.length_rate[i];
    heat += resistance * kin.rate.length_rate[i];
    grad.length[i] += resistance;
  }
  return heat;
}

/// The springs at held frames, the last to be added to the gradient.
Evaluation bend_at_held_nodes(const Model& model, const State& reference, bool viscous, const Kinematics& kin,
                              Gradient& grad, double& energy, double& heat) {
  for (std::size_t k = 0; k < model.bending.held.size(); ++k) {
    const std::size_t node = model.bending.held[k];
    if (past_half_turn(model, reference, node, kin)) return {Evaluation::Outcome::fold_back, node};
    const int child = model.bending.held_child[k];
    const EdgeAngles* after = child < 0 ? nullptr : &grad.child_edges[static_cast<std::size_t>(child)];
    energy += bend_at_held_frame(model, node, viscous && model.viscosity[node] > 0.0, after, kin, grad, heat);
  }
  for (const std::size_t node : model.bending.held_hinges) {
    if (past_half_turn(model, reference, node, kin)) return {Evaluation::Outcome::fold_back, node};
    energy += bend_at_held_hinge(model, node, kin, grad);
  }
  grad.made.from(kin);
  return {};
}

}  // namespace

Evaluation elastic(const Model& model, const State& reference, Inner inner, const Kinematics& kin,
                   Gradient& grad, double& heat) {
  assert(inner.viscous || inner.gyroscopic ? kin.has_rates() : kin.has_positions());
  heat = 0.0;
  for (const Segment& s : model.segments) {
    if (s.twist)
      run(loops_of(s, inner.viscous && s.viscous), model, reference, s, kin, grad);
    else if (const Evaluation at = hinge(model, reference, s, false, kin, grad); !at.ok())
      return at;
  }
  clear_ends(model, grad);
  if (!model.hubs.empty()) give_way_at_hubs(model, inner.viscous, kin, grad);
  for (const Segment& s : model.segments) {
    if (inner.viscous && s.viscous) heat += resist_stretch(model, s, kin, grad) + sum_of(grad.heat, s);
    if (s.twist) (inner.gyroscopic ? gather_all : gather_springs)(model, s, kin, grad);
  }
  double unused = 0.0;
  return bend_at_held_nodes(model, reference, inner.viscous, kin, grad, unused, heat);
}

Evaluation elastic_energy(const Model& model, const State& reference, const Kinematics& kin, Gradient& grad,
                          double& energy) {
  assert(kin.has_positions());
  for (const Segment& s : model.segments) {
    if (s.twist)
      with_energy(model, reference, s.first, s.end, kin, grad);
    else if (const Evaluation at = hinge(model, reference, s, true, kin, grad); !at.ok())
      return at;
  }
  clear_ends(model, grad);
  energy = give_way_at_hubs(model, false, kin, grad);
  for (const Segment& s : model.segments) {
    energy += sum_of(grad.energy, s);
    if (s.twist) gather_springs(model, s, kin, grad);
  }
  double none = 0.0;
  return bend_at_held_nodes(model, reference, false, kin, grad, energy, none);
}

void relax(const Kinematics& kin, Gradient& grad) {
  assert(kin.has_positions());
  grad.made.from(kin);
  for (auto* vectors : {&grad.bend, &grad.before, &grad.after, &grad.tangent, &grad.twist_tangent})
    vectors->set_zero();
  for (auto* numbers : {&grad.length, &grad.spin, &grad.twist_torque}) numbers->set_zero();
}

}  // namespace tendril
