#pragma once

#include "dynamics/rhs/workspace.h"
#include "dynamics/vector/pack.h"

namespace tendril::lanes {

/// Derivatives of the bending and twist springs of an edge, or of each of a pack of edges, by what they see:
/// the unit edge e, and tangent t and angle theta at its two nodes, in the expansion t_s + d, theta about the
/// present frames, d across t_s. Blocks (row by column); what is symmetric is kept once.
template <class T>
struct Springs {
  // Slopes: by e, by t of either node (along t, too), and by theta of the first.
  Triple<T> g_e{}, g_t[2]{};
  T g_theta{};

  Matrix<T> ee{}, et[2]{};     ///< e by t of either node
  Matrix<T> tt[2]{}, t0_t1{};  ///< t by the same t; t of the first node by t of the second
  Triple<T> e_theta[2]{};      ///< e by theta of either node
  Triple<T> t_theta[2][2]{};   ///< t by theta
  T theta[2]{}, theta0_theta1{};
};

/// Axes of a node frame.
template <class T>
struct Axes {
  Triple<T> l, m, t;
};
template <class T>
TENDRIL_INLINE Axes<T> axes_at(const Kinematics& kin, std::size_t i) {
  const Triple<T> m = load<T>(kin.frame.y, i);
  const Triple<T> t = load<T>(kin.frame.z, i);
  return {cross(m, t), m, t};
}

/// The direction (x, y, z) = (e.l, e.m, e.t) against a frame, as EdgeAngles has it.
template <class T>
struct Direction {
  T x, y, z;
  T ratio, rise;
  T rise_by_square;  ///< of the rise, by w = x^2 + y^2, as far as it depends on w: -(z + 3/2 rise) / w
};

/// That of one edge, however far it turns.
Direction<double> any_direction(double x, double y, double z);

TENDRIL_INLINE bool all_near(double w, double z) {
  return w <= kNearSquare && z > 0.0;
}
TENDRIL_INLINE bool all_near(const Pack& w, const Pack& z) {
  bool near = true;
  for (std::size_t k = 0; k < kLanes<Pack>; ++k) near &= all_near(w[k], z[k]);
  return near;
}

template <class T>
TENDRIL_INLINE void fill_near(const T& w, Direction<T>& d) {
  const ArcOf<T> arc = near_arc(w);
  d.ratio = arc.ratio;
  d.rise = arc.rise - (arc.ratio + arc.rise * w);
  d.rise_by_square = horner(w, 0.8, 2.0 / 7, 1.0 / 6, 5.0 / 44, 35.0 / 416, 0.065625, 0.05307904411764706,
                            0.044099506578947366, 0.03740583147321429, 0.032255753226902176);
}

template <class T>
TENDRIL_INLINE Direction<T> direction(const Triple<T>& e, const Axes<T>& f) {
  Direction<T> d{dot(e, f.l), dot(e, f.m), dot(e, f.t), {}, {}, {}};
  const T w = d.x * d.x + d.y * d.y;
  if (all_near(w, d.z)) {
    fill_near<T>(w, d);
    return d;
  }
  for (std::size_t k = 0; k < kLanes<T>; ++k) {
    const Direction<double> one = any_direction(lane(d.x, k), lane(d.y, k), lane(d.z, k));
    set_lane(d.ratio, k, one.ratio);
    set_lane(d.rise, k, one.rise);
    set_lane(d.rise_by_square, k, one.rise_by_square);
  }
  return d;
}

/// Slope and curvature of W(x, y, z).
template <class T>
struct Expansion {
  T x{}, y{}, z{};
  T xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};

/// Of the two deviations, l = r x and m = r y with r = phi / sin(phi) of phi = atan2(sqrt(x^2 + y^2), z),
/// pulled with f_l and f_m by springs k_l and k_m.
template <class T>
TENDRIL_INLINE Expansion<T> deviations(const Direction<T>& d, const T& kl, const T& km, const T& fl,
                                       const T& fm) {
  const T xx = d.x * d.x;
  const T yy = d.y * d.y;
  // Slopes by x, y and z.
  const T lx = d.ratio + d.rise * xx;
  const T my = d.ratio + d.rise * yy;
  const T mixed = d.rise * d.x * d.y;
  const T by_w = 2.0 * d.rise_by_square;
  const T both = fl * d.x + fm * d.y;
  const T lxy = d.y * (d.rise + by_w * xx);  // also m by x twice
  const T mxy = d.x * (d.rise + by_w * yy);  // also l by y twice
  Expansion<T> w;
  w.x = fl * lx + fm * mixed;
  w.y = fl * mixed + fm * my;
  w.z = -both;
  w.xx = kl * lx * lx + km * mixed * mixed + fl * d.x * (3.0 * d.rise + by_w * xx) + fm * lxy;
  w.yy = kl * mixed * mixed + km * my * my + fl * mxy + fm * d.y * (3.0 * d.rise + by_w * yy);
  w.xy = mixed * (kl * lx + km * my) + fl * lxy + fm * mxy;
  w.xz = -d.x * (kl * lx) - d.y * (km * mixed) + 2.0 * d.x * both - fl;
  w.yz = -d.x * (kl * mixed) - d.y * (km * my) + 2.0 * d.y * both - fm;
  w.zz = kl * xx + km * yy + 2.0 * d.z * both;
  return w;
}

/// Slope and curvature of 1/2 K (angle - rest)^2 by the cosine z of the angle.
struct ByCosine {
  double slope, curvature;
};
inline ByCosine by_cosine(double stiffness, double angle, double rest, double sine, double z) {
  if (sine > 1e-4) {
    const double g = stiffness * (angle - rest) / sine;
    return {-g, (stiffness - g * z) / (sine * sine)};
  }
  // angle / sine = 1 + angle^2 / 6 + ..., so the curvature tends to K / 3 (1 + 2 angle^2 / 5). The tip of a
  // rest cone has none.
  if (rest != 0.0) return {0.0, 0.0};
  return {-stiffness * (1.0 + angle * angle / 6), stiffness / 3 * (1.0 + 0.4 * angle * angle)};
}

/// Adds the third springs, of the angle to the tangent.
template <class T>
TENDRIL_INLINE void add_third(const T& stiffness, const T& rest, const Direction<T>& d, Expansion<T>& w) {
  for (std::size_t k = 0; k < kLanes<T>; ++k) {
    if (!(lane(stiffness, k) > 0.0)) continue;
    const double sine = std::sqrt(lane(d.x, k) * lane(d.x, k) + lane(d.y, k) * lane(d.y, k));
    const double angle = sine > 0.0 ? lane(d.ratio, k) * sine : 0.0;
    const ByCosine by = by_cosine(lane(stiffness, k), angle, lane(rest, k), sine, lane(d.z, k));
    set_lane(w.z, k, lane(w.z, k) + by.slope);
    set_lane(w.zz, k, lane(w.zz, k) + by.curvature);
  }
}

/// Adds W of the components of e in the frame f at node `side`: J W'' J^T and what the components' own second
/// derivatives add. By e alone they have none. The frame carried by the smallest rotation to t = t_s + d,
/// then turned by theta, is to second order, with a = d.l and b = d.m,
///
///   l -> l - a t + theta m - a d / 2 - theta^2 l / 2 - theta b t
///   m -> m - b t - theta l - b d / 2 - theta^2 m / 2 + theta a t
template <class T>
TENDRIL_INLINE void add_bending(const Axes<T>& f, const Direction<T>& d, const Expansion<T>& w,
                                std::size_t side, Springs<T>& s) {
  const T &x = d.x, &y = d.y, &z = d.z;
  s.g_e = s.g_e + w.x * f.l + w.y * f.m + w.z * f.t;
  // The edge is x l + y m + z t.
  const Triple<T> across = x * f.l + y * f.m;
  s.g_t[side] = s.g_t[side] + w.z * (across + z * f.t) - z * (w.x * f.l + w.y * f.m);
  if (side == 0) s.g_theta = s.g_theta + y * w.x - x * w.y;

  s.ee = s.ee + outer(w.xx * f.l + w.xy * f.m + w.xz * f.t, f.l) +
         outer(w.xy * f.l + w.yy * f.m + w.yz * f.t, f.m) + outer(w.xz * f.l + w.yz * f.m + w.zz * f.t, f.t);
  // W'' times the derivatives of x, y, z by a and by b.
  const T ax = x * w.xz - z * w.xx, ay = x * w.yz - z * w.xy, az = x * w.zz - z * w.xz;
  const T bx = y * w.xz - z * w.xy, by = y * w.yz - z * w.yy, bz = y * w.zz - z * w.yz;
  s.et[side] = s.et[side] + outer((ax + w.z) * f.l + ay * f.m + (az - w.x) * f.t, f.l) +
               outer(bx * f.l + (by + w.z) * f.m + (bz - w.y) * f.t, f.m);
  const T aa = x * az - z * ax - w.x * x;
  const T bb = y * bz - z * by - w.y * y;
  const T ab = y * az - z * ay - 0.5 * (w.x * y + w.y * x);
  s.tt[side] = s.tt[side] + outer(aa * f.l + ab * f.m, f.l) + outer(ab * f.l + bb * f.m, f.m);
  // And by theta.
  const T qx = y * w.xx - x * w.xy, qy = y * w.xy - x * w.yy, qz = y * w.xz - x * w.yz;
  s.e_theta[side] = s.e_theta[side] + (qx - w.y) * f.l + (qy + w.x) * f.m + qz * f.t;
  s.t_theta[side][side] =
      s.t_theta[side][side] + (x * qz - z * (qx - w.y)) * f.l + (y * qz - z * (qy + w.x)) * f.m;
  s.theta[side] = s.theta[side] + y * (qx - w.y) - x * (qy + w.x);
}

/// The twist spring at the torque given. tau = theta_b - theta_a + a function of the tangents, whose gradient
/// away from the reference is c + (t_s x t) / (1 + t_s.t) at a and c minus the like at b,
/// c = (t_a x t_b) / (1 + t_a.t_b).
template <class T>
TENDRIL_INLINE void add_twist(const Triple<T>& ta, const Triple<T>& tb, const T& stiffness, const T& torque,
                              Springs<T>& s) {
  const T cosine = dot(ta, tb);
  const T inverse = 1.0 / (1.0 + cosine);
  const Triple<T> c = inverse * cross(ta, tb);
  const Triple<T> kc = stiffness * c;
  const T slope = inverse * torque;
  for (auto& g : s.g_t) g = g + torque * c;
  s.g_theta = s.g_theta - torque;
  // K c c^T, and the symmetric part of the derivative of c by the tangent, across it.
  const Triple<T> half = 0.5 * stiffness * c;
  s.tt[0] = s.tt[0] + outer_both(c, half - (0.5 * slope) * (tb - cosine * ta));
  s.tt[1] = s.tt[1] + outer_both(c, half - (0.5 * slope) * (ta - cosine * tb));
  s.t0_t1 = s.t0_t1 + slope * cross_matrix(ta) + outer(c, kc - slope * (ta + tb));
  for (auto& by : s.t_theta) {
    by[0] = by[0] - kc;
    by[1] = by[1] + kc;
  }
  s.theta[0] = s.theta[0] + stiffness;
  s.theta[1] = s.theta[1] + stiffness;
  s.theta0_theta1 = s.theta0_theta1 - stiffness;
}

/// Rates of the deviations l and m, as deviation_rates has them.
template <class T>
struct Rates {
  T l, m;
};
template <class T>
TENDRIL_INLINE Rates<T> rates_of(const Kinematics& kin, std::size_t i, std::size_t node, const Axes<T>& f,
                                 const Direction<T>& d) {
  const Triple<T> e_rate = load<T>(kin.rate.e_rate, i);
  const Triple<T> t_rate = cross(load<T>(kin.rate.turning, node), f.t);
  const T spin = load<T>(kin.spin.data() + node);
  // The frame's m' = -(m.t') t - w l, l' = -(l.t') t + w m.
  const T along_l = dot(f.l, t_rate);
  const T along_m = dot(f.m, t_rate);
  const T x = dot(e_rate, f.l) - along_l * d.z + spin * d.y;
  const T y = dot(e_rate, f.m) - along_m * d.z - spin * d.x;
  const T z = dot(e_rate, f.t) + d.x * along_l + d.y * along_m;
  const T rising = d.rise * (d.x * x + d.y * y) - z;
  return {d.ratio * x + rising * d.x, d.ratio * y + rising * d.y};
}

TENDRIL_INLINE bool any_positive(double a) {
  return a > 0.0;
}
TENDRIL_INLINE bool any_positive(const Pack& a) {
  bool any = false;
  for (std::size_t k = 0; k < kLanes<Pack>; ++k) any |= a[k] > 0.0;
  return any;
}

/// Bending of edge i, or of the pack that begins with it, at its node `side`.
template <class T>
TENDRIL_INLINE void add_bending_at(const Model& model, std::size_t i, std::size_t side, bool viscous,
                                   const Kinematics& kin, const Gradient& grad, Springs<T>& s) {
  const std::size_t node = i + side;
  const std::size_t end = 2 * i + side;
  const Axes<T> f = axes_at<T>(kin, node);
  const Direction<T> d = direction(load<T>(kin.e, i), f);
  const T kl = load<T>(&model.bend_l[node]);
  const T km = load<T>(&model.bend_m[node]);
  const T kt = load<T>(&model.bend_t[node]);
  T fl = kl * (d.ratio * d.x - load_apart<T>(&model.rest_l[end]));
  T fm = km * (d.ratio * d.y - load_apart<T>(&model.rest_m[end]));
  if (viscous) {
    const Rates<T> rate = rates_of(kin, i, node, f, d);
    const T viscosity = load<T>(&model.viscosity[i]);
    fl = fl + viscosity * kl * rate.l;
    fm = fm + viscosity * km * rate.m;
  }
  if (side == 0) {  // what a hub gives way
    const Triple<T> way = load<T>(grad.given, node);
    fl = fl - (kl + kt) * way.x;
    fm = fm - (km + kt) * way.y;
  }
  Expansion<T> w = deviations<T>(d, kl, km, fl, fm);
  if (any_positive(kt)) add_third<T>(kt, load_apart<T>(&model.rest_t[end]), d, w);
  add_bending<T>(f, d, w, side, s);
}

/// Second derivatives of the energy of edge i, or of the pack that begins with it; needs its kinematics and
/// gradient.
/// \param viscous  each slope is that of strain + beta strain', as the forces are, which needs the rates, and
///                 a gradient with its viscous part
template <class T>
TENDRIL_INLINE Springs<T> springs_of(const Model& model, std::size_t i, bool viscous, const Kinematics& kin,
                                     const Gradient& grad) {
  Springs<T> s;
  add_bending_at<T>(model, i, 0, viscous, kin, grad, s);
  add_bending_at<T>(model, i, 1, viscous, kin, grad, s);
  add_twist<T>(load<T>(kin.frame.z, i), load<T>(kin.frame.z, i + 1), load<T>(&model.twist[i]),
               load<T>(grad.twist_torque.data() + i), s);
  return s;
}

/// sum k grad q grad q^T over the two deviations at either end and the twist.
template <class T>
TENDRIL_INLINE Springs<T> resistance_of(const Model& model, std::size_t i, const Kinematics& kin) {
  Springs<T> s;
  const T none{};
  for (const std::size_t side : {0, 1}) {
    const std::size_t node = i + side;
    const Axes<T> f = axes_at<T>(kin, node);
    const Direction<T> d = direction(load<T>(kin.e, i), f);
    add_bending<T>(f, d,
                   deviations<T>(d, load<T>(&model.bend_l[node]), load<T>(&model.bend_m[node]), none, none),
                   side, s);
  }
  add_twist<T>(load<T>(kin.frame.z, i), load<T>(kin.frame.z, i + 1), load<T>(&model.twist[i]), none, s);
  return s;
}

}  // namespace tendril::lanes
