#include <cmath>
#include <cstdint>
#include <limits>

#include "column_access.h"
#include "elastic.h"

namespace tendril {
namespace {

using Outcome = Evaluation::Outcome;
using Workspace = System::Workspace;
using Model = System::Model;
using lanes::V3;

constexpr double kLargest = std::numeric_limits<double>::max();

/// Components of vectors that stand one after the other, into columns.
TENDRIL_LANES void take_apart(const double* from, std::size_t count, Columns3& to) {
  double* __restrict x = to.x.data();
  double* __restrict y = to.y.data();
  double* __restrict z = to.z.data();
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = from[3 * i];
    y[i] = from[3 * i + 1];
    z[i] = from[3 * i + 2];
  }
}

/// Lengths and directions of edges [first, end); true when one has no direction.
TENDRIL_LANES bool measure(std::size_t first, std::size_t end, Workspace& work) {
  const double* __restrict px = work.p.x.data(), * __restrict py = work.p.y.data(), * __restrict pz = work.p.z.data();
  double* __restrict ex = work.e.x.data(), * __restrict ey = work.e.y.data(), * __restrict ez = work.e.z.data();
  double* __restrict length = work.length.data(), * __restrict inverse = work.inverse_length.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 d{px[i + 1] - px[i], py[i + 1] - py[i], pz[i + 1] - pz[i]};
    const double l = std::sqrt(lanes::dot(d, d));
    const double s = 1.0 / l;
    length[i] = l;
    inverse[i] = s;
    ex[i] = s * d.x;
    ey[i] = s * d.y;
    ez[i] = s * d.z;
    bad |= l > 0.0 && l < 1e300 ? 0 : 1;
  }
  return bad != 0;
}

TENDRIL_LANES void measure_rates(std::size_t first, std::size_t end, Workspace& work) {
  const double* __restrict vx = work.v.x.data(), * __restrict vy = work.v.y.data(), * __restrict vz = work.v.z.data();
  const double* __restrict ex = work.e.x.data(), * __restrict ey = work.e.y.data(), * __restrict ez = work.e.z.data();
  const double* __restrict inverse = work.inverse_length.data();
  double* __restrict length_rate = work.length_rate.data();
  double *__restrict rx = work.e_rate.x.data(), *__restrict ry = work.e_rate.y.data(),
         *__restrict rz = work.e_rate.z.data();
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 d{vx[i + 1] - vx[i], vy[i + 1] - vy[i], vz[i + 1] - vz[i]};
    const V3 e{ex[i], ey[i], ez[i]};
    const double along = lanes::dot(e, d);
    length_rate[i] = along;
    rx[i] = inverse[i] * (d.x - along * e.x);
    ry[i] = inverse[i] * (d.y - along * e.y);
    rz[i] = inverse[i] * (d.z - along * e.z);
  }
}

/// Tangents of nodes [first, end) from their edges (2.7, normalised); true when the edges of one fold back.
TENDRIL_LANES bool bisect(std::size_t first, std::size_t end, Workspace& work) {
  const double* __restrict ex = work.e.x.data(), * __restrict ey = work.e.y.data(), * __restrict ez = work.e.z.data();
  double *__restrict tx = work.frame.z.x.data(), *__restrict ty = work.frame.z.y.data(),
         *__restrict tz = work.frame.z.z.data();
  double* __restrict inverse = work.inverse_bisector.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 s{ex[i - 1] + ex[i], ey[i - 1] + ey[i], ez[i - 1] + ez[i]};
    const double length = std::sqrt(lanes::dot(s, s));
    const double b = 1.0 / length;
    inverse[i] = b;
    tx[i] = b * s.x;
    ty[i] = b * s.y;
    tz[i] = b * s.z;
    bad |= length >= kFoldBack ? 0 : 1;
  }
  return bad != 0;
}

TENDRIL_LANES void bisect_rates(std::size_t first, std::size_t end, Workspace& work) {
  const double *__restrict ex = work.e_rate.x.data(), *__restrict ey = work.e_rate.y.data(),
               *__restrict ez = work.e_rate.z.data();
  const double *__restrict tx = work.frame.z.x.data(), *__restrict ty = work.frame.z.y.data(),
               *__restrict tz = work.frame.z.z.data();
  const double* __restrict inverse = work.inverse_bisector.data();
  double *__restrict rx = work.t_rate.x.data(), *__restrict ry = work.t_rate.y.data(),
         *__restrict rz = work.t_rate.z.data();
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 s{ex[i - 1] + ex[i], ey[i - 1] + ey[i], ez[i - 1] + ez[i]};
    const double along = tx[i] * s.x + ty[i] * s.y + tz[i] * s.z;
    rx[i] = inverse[i] * (s.x - along * tx[i]);
    ry[i] = inverse[i] * (s.y - along * ty[i]);
    rz[i] = inverse[i] * (s.z - along * tz[i]);
  }
}

/// Where the reference directors are, what turns them, and where the nodes [first, end) stand in it.
struct Carried {
  const double* __restrict tangent;   ///< of the reference, three numbers a node
  const double* __restrict director;  ///< likewise
  const double* __restrict theta;     ///< of the nodes from `first` on
};

/// Directors of nodes with twist: the reference carried to the tangent by the smallest rotation, turned by
/// theta; with rates, also what the carried director turns by itself, ((t_s x t) . t') / (1 + t_s . t). True
/// when a tangent turned too far for that.
template <bool Rates>
TENDRIL_INLINE bool direct(std::size_t first, std::size_t end, const Carried& from, Workspace& work) {
  const lanes::Reader tangent(work.frame.z), rate(work.t_rate);
  const lanes::Writer to(work.frame.y);
  double* __restrict connection = work.connection.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 f{from.tangent[3 * i], from.tangent[3 * i + 1], from.tangent[3 * i + 2]};
    const V3 d{from.director[3 * i], from.director[3 * i + 1], from.director[3 * i + 2]};
    const V3 t = tangent.at(i);
    const double c = 1.0 + lanes::dot(f, t);
    const double s = 1.0 / c;
    const V3 carried = d - (lanes::dot(t, d) * s) * (f + t);
    const V3 beside = lanes::cross(t, carried);
    const lanes::SineCosine turn = lanes::sine_cosine(from.theta[i - first]);
    to.put(i, turn.cosine * carried + turn.sine * beside);
    if constexpr (Rates) connection[i] = s * lanes::dot(lanes::cross(f, t), rate.at(i));
    // Within a step no tangent turns further than 126 degrees: a longer way could take the wrong side.
    bad |= c > kTurnedTooFar ? 0 : 1;
  }
  return bad != 0;
}

TENDRIL_LANES bool direct_places(std::size_t first, std::size_t end, const Carried& from, Workspace& work) {
  return direct<false>(first, end, from, work);
}
TENDRIL_LANES bool direct_all(std::size_t first, std::size_t end, const Carried& from, Workspace& work) {
  return direct<true>(first, end, from, work);
}

TENDRIL_LANES bool finite(const double* values, std::size_t count) {
  std::int64_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) bad |= std::fabs(values[i]) <= kLargest ? 0 : 1;
  return bad == 0;
}

void place_nodes(const Model& model, double t, const Eigen::VectorXd& y, Workspace& work) {
  take_apart(y.data(), model.nodes, work.p);
  take_apart(y.data() + model.v_begin(), model.nodes, work.v);
  for (std::size_t a = 0; a < model.anchors.size(); ++a) {
    const Anchor& anchor = model.anchors[a];
    const std::size_t i = model.rods[anchor.rod].first + anchor.node;
    work.pose[a] = anchor.motion
                       ? anchor.motion(t)
                       : AnchorPose{model.rest_p[i], model.rest_frame[i], Vec3::Zero(), Vec3::Zero()};
    if (!anchor.holds_position) continue;
    work.p.set(i, work.pose[a].position);
    work.v.set(i, work.pose[a].velocity);
  }
  for (const System::Model::Ride& ride : model.rides) {
    work.p.set(ride.root, work.p[ride.parent]);
    work.v.set(ride.root, work.v[ride.parent]);
  }
}

/// The root of a child rod takes its frame from the node it rides on, which is known by then.
void take_ride(const System::Model::Ride& ride, bool rates, Workspace& work) {
  const std::size_t i = ride.root;
  const Frame f = work.frame[ride.parent];
  const auto outside = [&](const Vec3& v) { return Vec3(v.x() * f.x + v.y() * f.y + v.z() * f.z); };
  const Frame frame{outside(ride.rest.x), outside(ride.rest.y), outside(ride.rest.z)};
  work.frame.set(i, frame);
  work.inverse_bisector[i] = 0.0;
  work.connection[i] = 0.0;
  if (!rates) return;
  const Vec3 turning = f.z.cross(work.t_rate[ride.parent]) + work.spin[ride.parent] * f.z;
  work.t_rate.set(i, turning.cross(frame.z));
  work.spin[i] = turning.dot(frame.z);
}

void take_held_frames(const Model& model, Workspace& work) {
  for (std::size_t a = 0; a < model.anchors.size(); ++a) {
    const Anchor& anchor = model.anchors[a];
    if (!anchor.holds_frame) continue;
    const std::size_t i = model.rods[anchor.rod].first + anchor.node;
    const AnchorPose& pose = work.pose[a];
    work.frame.set(i, pose.frame);
    work.t_rate.set(i, pose.angular_velocity.cross(pose.frame.z));
    work.spin[i] = pose.angular_velocity.dot(pose.frame.z);
    work.inverse_bisector[i] = 0.0;
    work.connection[i] = 0.0;
  }
}

void clear_ends(const Model& model, Workspace& work) {
  for (const NodeRange& rod : model.rods) {
    const std::size_t last = rod.first + rod.count - 1;
    work.e.set(last, Vec3::Zero());
    work.e_rate.set(last, Vec3::Zero());
    work.length[last] = work.inverse_length[last] = work.length_rate[last] = 0.0;
  }
}

Evaluation find_bad_edge(const Model& model, const Workspace& work) {
  for (const NodeRange& rod : model.rods)
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      if (!std::isfinite(work.length[i])) return {Outcome::not_finite, i};
      if (!(work.length[i] > 0.0)) return {Outcome::zero_edge, i};
    }
  return {};
}

Evaluation find_bad_tangent(const Model& model, const State& reference, const System::Model::Segment& segment,
                            const Workspace& work) {
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    if (model.holds_frame(i)) continue;
    if (!(1.0 / work.inverse_bisector[i] >= kFoldBack)) return {Outcome::fold_back, i};
    if (segment.twist && !(1.0 + reference.tangent[i].dot(work.frame.z[i]) > kTurnedTooFar))
      return {Outcome::turned_too_far, i};
  }
  return {};
}

const double* numbers(const std::vector<Vec3>& v) {
  return v.empty() ? nullptr : v.front().data();
}

Evaluation take_frames(const Model& model, const State& reference, const Eigen::VectorXd& y, Motion what,
                       Workspace& work) {
  for (const System::Model::Segment& s : model.segments) {
    if (!s.twist && what == Motion::springs) continue;
    bool bad = bisect(s.first, s.end, work);
    if (what != Motion::places) bisect_rates(s.first, s.end, work);
    if (s.twist) {
      const Eigen::Index k = model.twist_index[s.first];
      const Carried from{numbers(reference.tangent), numbers(reference.director),
                         y.data() + model.theta_begin() + k};
      bad |= (what == Motion::places ? direct_places : direct_all)(s.first, s.end, from, work);
      const double* spin = y.data() + model.spin_begin() + k;
      std::copy(spin, spin + (s.end - s.first), &work.spin[s.first]);
    }
    if (!bad) continue;
    if (const Evaluation at = find_bad_tangent(model, reference, s, work); !at.ok()) return at;
  }
  take_held_frames(model, work);
  for (const System::Model::Ride& ride : model.rides) take_ride(ride, what != Motion::places, work);
  return {};
}

}  // namespace

bool all_finite(const Eigen::VectorXd& values) {
  return finite(values.data(), static_cast<std::size_t>(values.size()));
}

System::Workspace::Workspace(const Model& model) : pose(model.anchors.size()), frame(model.nodes) {
  const std::size_t n = model.nodes;
  for (auto* vectors : {&p, &v, &e, &e_rate, &t_rate, &g_before, &g_after, &g_bisector, &g_tangent,
                        &twist_tangent, &edge_force, &force})
    *vectors = Columns3(n);
  for (auto* numbers : {&length, &inverse_length, &length_rate, &inverse_bisector, &spin, &connection,
                        &g_spin, &g_length, &twist_torque, &energy, &heat})
    *numbers = Column(n);
  if (!model.loaded) return;
  for (auto* vectors : {&seen_p, &seen_v, &seen_t, &seen_m, &load, &torque}) vectors->assign(n, Vec3::Zero());
  seen_spin.assign(n, 0.0);
}

Evaluation kinematics(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                      Motion what, Workspace& work) {
  if (what != Motion::springs && !all_finite(y)) return {Outcome::not_finite, 0};
  place_nodes(model, t, y, work);
  const bool bad = measure(0, model.nodes, work);
  if (what != Motion::places) measure_rates(0, model.nodes, work);
  clear_ends(model, work);
  if (bad)
    if (const Evaluation at = find_bad_edge(model, work); !at.ok()) return at;
  return take_frames(model, reference, y, what, work);
}

}  // namespace tendril
