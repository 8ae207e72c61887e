#include <cmath>
#include <cstdint>

#include "column_access.h"
#include "spring_loops.h"

namespace tendril {
namespace {

using Workspace = System::Workspace;
using Model = System::Model;
using Segment = System::Model::Segment;
using lanes::Reader;
using lanes::V3;
using lanes::Writer;

/// What a loop over springs does beside the gradient, and whether it takes every angle for a small one.
struct Wanted {
  bool viscous, third, energy, near;
};

template <bool Near>
TENDRIL_INLINE lanes::Deviation deviation(double x, double y, double z) {
  if constexpr (Near) return {x * lanes::asin_ratio(x * x), lanes::inverse_cosine(x * x)};
  return lanes::deviation(x, std::sqrt(y * y + z * z));
}

/// The springs of one node between its two edges.
struct Node {
  double k_l, k_m, k_t, rest_l, rest_m, rest_t;
};

/// k angle / (sin angle cos angle) for the third angle, less its rest.
template <Wanted W>
TENDRIL_INLINE double third(const Node& s, double across2, double z, double& energy) {
  if constexpr (W.near) return s.k_t * lanes::asin_slope(across2);
  const double sine = std::sqrt(across2);
  const double strain = lanes::angle(sine, z) - s.rest_t;
  if constexpr (W.energy) energy += s.k_t * strain * strain;
  // At angle 0 the limit for a rest of 0, nothing at the tip of a rest cone.
  const double tip = s.rest_t == 0.0 ? s.k_t : 0.0;
  const bool away = sine > 1e-12 && z > 0.0;
  return away ? s.k_t * strain / (away ? sine * z : 1.0) : tip;
}

/// With d half the difference of the unit edges b and a at a free node, x = d.l and y = d.m are the sines of
/// the deviations of b, those of a with the other sign, and d.t = 0: both edges' springs are
///   E = k_l (asin x - r_l)^2 + k_m (asin y - r_m)^2 + k_t (asin |d| - r_t)^2,
/// and as d.t = 0, a tangent that turns with its director does not change x and y: dx = l.dd + y ds, dy =
/// m.dd - x ds. The gradient by b is half that by d, that by a its opposite. False where an angle was not
/// near and was taken for it.
template <Wanted W>
TENDRIL_INLINE bool bend_nodes(const Model& model, std::size_t from, std::size_t end, Workspace& work) {
  const Reader e(work.e), e_rate(work.e_rate), m(work.frame.y), t(work.frame.z);
  const Writer to(work.g_bend);
  double *__restrict to_spin = work.g_spin.data(), *__restrict to_energy = work.energy.data(),
         *__restrict to_heat = work.heat.data();
  const double* __restrict spin = work.spin.data(), * __restrict viscosity = model.viscosity.data();
  const Model::Bending::View k = model.bending.view();
  std::int64_t far = 0;
  TENDRIL_LOOP
  for (std::size_t i = from; i < end; ++i) {
    const Node s{k.k_l[i], k.k_m[i], k.k_t[i], k.rest_l[i], k.rest_m[i], k.rest_t[i]};
    const V3 mi = m.at(i);
    const V3 ti = t.at(i);
    const V3 li = lanes::cross(mi, ti);
    const V3 a = e.at(i - 1);
    const V3 b = e.at(i);
    const V3 d = 0.5 * (b - a);
    const double x = lanes::dot(d, li);
    const double y = lanes::dot(d, mi);
    const double across2 = x * x + y * y;
    const double z = W.near ? 1.0 : 0.5 * lanes::dot(a + b, ti);
    const lanes::Deviation l = deviation<W.near>(x, y, z);
    const lanes::Deviation n = deviation<W.near>(y, x, z);
    const double strain_l = l.angle - s.rest_l;
    const double strain_m = n.angle - s.rest_m;
    double fl = s.k_l * strain_l;
    double fm = s.k_m * strain_m;
    double energy = W.energy ? fl * strain_l + fm * strain_m : 0.0;
    if constexpr (W.viscous) {
      const V3 d_rate = 0.5 * (e_rate.at(i) - e_rate.at(i - 1));
      const double l_rate = (lanes::dot(d_rate, li) + spin[i] * y) * l.inverse_cosine;
      const double m_rate = (lanes::dot(d_rate, mi) - spin[i] * x) * n.inverse_cosine;
      to_heat[i] = 2.0 * viscosity[i] * (s.k_l * l_rate * l_rate + s.k_m * m_rate * m_rate);
      fl += viscosity[i] * s.k_l * l_rate;
      fm += viscosity[i] * s.k_m * m_rate;
    }
    double gl = fl * l.inverse_cosine;
    double gm = fm * n.inverse_cosine;
    to_spin[i] = 2.0 * (gl * y - gm * x);
    if constexpr (W.third) {
      const double g = third<W>(s, across2, z, energy);
      gl += g * x;
      gm += g * y;
    }
    to.put(i, gl * li + gm * mi);
    if constexpr (W.energy) to_energy[i] = energy;
    const bool near = across2 <= lanes::kNearSquare && s.rest_t == 0.0;
    far |= near || s.k_l + s.k_m + s.k_t == 0.0 ? 0 : 1;
  }
  return !W.near || far == 0;
}

TENDRIL_LANES bool bend_near(const Model& model, const State&, std::size_t first, std::size_t end,
                             Workspace& work) {
  return bend_nodes<Wanted{false, false, false, true}>(model, first, end, work);
}
TENDRIL_LANES bool bend_far(const Model& model, const State&, std::size_t first, std::size_t end,
                            Workspace& work) {
  return bend_nodes<Wanted{false, false, false, false}>(model, first, end, work);
}
TENDRIL_LANES bool bend_thrice_near(const Model& model, const State&, std::size_t first, std::size_t end,
                                    Workspace& work) {
  return bend_nodes<Wanted{false, true, false, true}>(model, first, end, work);
}
TENDRIL_LANES bool bend_thrice_far(const Model& model, const State&, std::size_t first, std::size_t end,
                                   Workspace& work) {
  return bend_nodes<Wanted{false, true, false, false}>(model, first, end, work);
}
TENDRIL_LANES bool bend_viscously_near(const Model& model, const State&, std::size_t first, std::size_t end,
                                       Workspace& work) {
  return bend_nodes<Wanted{true, true, false, true}>(model, first, end, work);
}
TENDRIL_LANES bool bend_viscously_far(const Model& model, const State&, std::size_t first, std::size_t end,
                                      Workspace& work) {
  return bend_nodes<Wanted{true, true, false, false}>(model, first, end, work);
}
TENDRIL_LANES bool bend_with_energy(const Model& model, const State&, std::size_t first, std::size_t end,
                                    Workspace& work) {
  return bend_nodes<Wanted{false, true, true, false}>(model, first, end, work);
}
constexpr Loops kPlainly{bend_near, bend_far}, kThrice{bend_thrice_near, bend_thrice_far},
    kViscously{bend_viscously_near, bend_viscously_far};

/// Twist springs of the edges of a segment, into twist_tangent and twist_torque.
template <Wanted W>
TENDRIL_INLINE bool twist_edges(const Model& model, const State& from, std::size_t first, std::size_t end,
                                Workspace& work) {
  const Reader m(work.frame.y), t(work.frame.z), t_rate(work.t_rate);
  const Writer tangent(work.twist_tangent);
  double* __restrict torques = work.twist_torque.data();
  double* __restrict energy = work.energy.data();
  double* __restrict heat = work.heat.data();
  const double* __restrict spin = work.spin.data();
  const double* __restrict reference = from.twist.data();
  const double *__restrict stiffness = model.twist.data(), *__restrict rest = model.rest_twist.data(),
               *__restrict viscosity = model.viscosity.data();
  std::int64_t far = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 ta = t.at(i);
    const V3 tb = t.at(i + 1);
    const V3 ma = m.at(i);
    const V3 mb = m.at(i + 1);
    const double s = 1.0 / (1.0 + lanes::dot(ta, tb));
    const V3 carried = ma - (lanes::dot(tb, ma) * s) * (ta + tb);
    const double sine = lanes::dot(lanes::cross(carried, mb), tb);
    const double cosine = lanes::dot(carried, mb);
    const double raw = W.near ? sine * lanes::asin_ratio(sine * sine) : lanes::angle(sine, cosine);
    const double tau = reference[i] + lanes::less_turns(raw - reference[i]);
    const double strain = tau - rest[i];
    double torque = stiffness[i] * strain;
    if constexpr (W.energy) energy[i] = 0.5 * torque * strain;
    // d tau = s_b - s_a + c.(dt_a + dt_b): what the smallest rotation between the tangents turns by itself.
    const V3 c = s * lanes::cross(ta, tb);
    if constexpr (W.viscous) {
      const double rate = spin[i + 1] - spin[i] + lanes::dot(c, t_rate.at(i) + t_rate.at(i + 1));
      const double resistance = viscosity[i] * stiffness[i] * rate;
      heat[i] = resistance * rate;
      torque += resistance;
    }
    torques[i] = torque;
    tangent.put(i, torque * c);
    far |= (sine * sine <= lanes::kNearSquare && cosine > 0.0) || stiffness[i] == 0.0 ? 0 : 1;
  }
  return !W.near || far == 0;
}

TENDRIL_LANES bool twist_near(const Model& model, const State& reference, std::size_t first, std::size_t end,
                              Workspace& work) {
  return twist_edges<Wanted{false, false, false, true}>(model, reference, first, end, work);
}
TENDRIL_LANES bool twist_far(const Model& model, const State& reference, std::size_t first, std::size_t end,
                             Workspace& work) {
  return twist_edges<Wanted{false, false, false, false}>(model, reference, first, end, work);
}
TENDRIL_LANES bool twist_viscously_near(const Model& model, const State& reference, std::size_t first,
                                        std::size_t end, Workspace& work) {
  return twist_edges<Wanted{true, false, false, true}>(model, reference, first, end, work);
}
TENDRIL_LANES bool twist_viscously_far(const Model& model, const State& reference, std::size_t first,
                                       std::size_t end, Workspace& work) {
  return twist_edges<Wanted{true, false, false, false}>(model, reference, first, end, work);
}
TENDRIL_LANES bool twist_with_energy(const Model& model, const State& reference, std::size_t first,
                                     std::size_t end, Workspace& work) {
  return twist_edges<Wanted{false, false, true, false}>(model, reference, first, end, work);
}
constexpr Loops kTwist{twist_near, twist_far}, kTwistViscously{twist_viscously_near, twist_viscously_far};

/// What the twist springs give the nodes.
TENDRIL_LANES void gather_twist(const Segment& segment, Workspace& work) {
  const Reader from(work.twist_tangent);
  const Writer to(work.g_tangent);
  const double* __restrict torque = work.twist_torque.data();
  double* __restrict spin = work.g_spin.data();
  TENDRIL_LOOP
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    to.put(i, from.at(i - 1) + from.at(i));
    spin[i] += torque[i - 1] - torque[i];
  }
}

double sum_of(const Column& column, const Segment& segment) {
  double sum = 0.0;
  for (std::size_t i = segment.first; i < segment.end; ++i) sum += column[i];
  return sum;
}

/// What the last loops left where no edge is must not reach the next rod's first node.
void clear_ends(const Model& model, Workspace& work) {
  for (const NodeRange& rod : model.rods) {
    const std::size_t last = rod.first + rod.count - 1;
    work.twist_tangent.set(last, Vec3::Zero());
    work.twist_torque[last] = 0.0;
    work.energy[last] = 0.0;
    work.heat[last] = 0.0;
  }
}

TENDRIL_LANES void stretch_edges(const Model& model, Workspace& work) {
  const double *__restrict length = work.length.data(), *__restrict rest = model.rest_length.data(),
               *__restrict stiffness = model.stretch.data();
  double* __restrict g = work.g_length.data();
  TENDRIL_LOOP
  for (std::size_t i = 0; i < model.nodes; ++i) g[i] = stiffness[i] * (length[i] - rest[i]);
}

double resist_stretch(const Model& model, const Segment& segment, Workspace& work) {
  double heat = 0.0;
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    const double resistance = model.viscosity[i] * model.stretch[i] * work.length_rate[i];
    heat += resistance * work.length_rate[i];
    work.g_length[i] += resistance;
  }
  return heat;
}

}  // namespace

Evaluation elastic(const Model& model, const State& reference, bool viscous, Workspace& work, double& heat) {
  heat = 0.0;
  stretch_edges(model, work);
  for (const Segment& s : model.segments) {
    const bool resists = viscous && s.viscous;
    if (resists) heat += resist_stretch(model, s, work);
    if (!s.twist) {
      if (const Evaluation at = hinge(model, reference, s, false, work); !at.ok()) return at;
      continue;
    }
    run(resists ? kViscously : s.third ? kThrice : kPlainly, model, reference, s, work);
    if (resists) heat += sum_of(work.heat, s);
    run(resists ? kTwistViscously : kTwist, model, reference, s, work);
    clear_ends(model, work);
    if (resists) heat += sum_of(work.heat, s);
    gather_twist(s, work);
  }
  for (const std::size_t node : model.bending.held)
    pull_on_held(model, node, viscous && model.viscosity[node] > 0.0, work, heat);
  for (const std::size_t node : model.bending.held_hinges) bend_held(model, node, work);
  return {};
}

Evaluation elastic_energy(const Model& model, const State& reference, Workspace& work, double& energy) {
  stretch_edges(model, work);
  energy = 0.0;
  for (std::size_t i = 0; i < model.nodes; ++i)
    energy += 0.5 * work.g_length[i] * (work.length[i] - model.rest_length[i]);
  for (const Segment& s : model.segments) {
    if (s.twist) {
      bend_with_energy(model, reference, s.first, s.end, work);
      energy += sum_of(work.energy, s);
      twist_with_energy(model, reference, s.first, s.end, work);
      clear_ends(model, work);
      gather_twist(s, work);
    } else if (const Evaluation at = hinge(model, reference, s, true, work); !at.ok()) {
      return at;
    }
    energy += sum_of(work.energy, s);
  }
  double none = 0.0;
  for (const std::size_t node : model.bending.held) energy += pull_on_held(model, node, false, work, none);
  for (const std::size_t node : model.bending.held_hinges) energy += bend_held(model, node, work);
  return {};
}

void relax(Workspace& work) {
  for (auto* vectors : {&work.g_bend, &work.g_before, &work.g_after, &work.g_tangent}) vectors->set_zero();
  for (auto* numbers : {&work.g_length, &work.g_spin}) numbers->set_zero();
}

}  // namespace tendril
