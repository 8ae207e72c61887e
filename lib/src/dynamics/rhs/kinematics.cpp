#include "kinematics.h"

#include <cmath>
#include <cstdint>

#include "dynamics/body/bodies.h"
#include "dynamics/vector/column_access.h"
#include "dynamics/vector/finite.h"

namespace tendril {
namespace {

using Outcome = Evaluation::Outcome;
using lanes::Reader;
using lanes::V3;
using lanes::Writer;

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

/// Lengths and directions of edges [first, end), and their rates; true when one has no direction.
template <bool Rates>
TENDRIL_INLINE bool measure(std::size_t first, std::size_t end, Kinematics& kin) {
  const Reader p(kin.p), v(kin.v);
  const Writer to(kin.e), rate(kin.rate.e_rate);
  double *__restrict length = kin.length.data(), *__restrict inverse = kin.inverse_length.data(),
         *__restrict length_rate = kin.rate.length_rate.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 d = p.at(i + 1) - p.at(i);
    const double l = std::sqrt(lanes::dot(d, d));
    const double s = 1.0 / l;
    const V3 e = s * d;
    length[i] = l;
    inverse[i] = s;
    to.put(i, e);
    bad |= l > 0.0 && l < 1e300 ? 0 : 1;
    if constexpr (Rates) {
      const V3 apart = v.at(i + 1) - v.at(i);
      const double along = lanes::dot(e, apart);
      length_rate[i] = along;
      rate.put(i, s * (apart - along * e));
    }
  }
  return bad != 0;
}
TENDRIL_LANES bool measure_positions(std::size_t first, std::size_t end, Kinematics& kin) {
  return measure<false>(first, end, kin);
}
TENDRIL_LANES bool measure_all(std::size_t first, std::size_t end, Kinematics& kin) {
  return measure<true>(first, end, kin);
}

/// Where the reference directors are, what turns them, and where the nodes [first, end) stand in it.
struct Carried {
  const double* __restrict tangent;   ///< of the reference, three numbers a node
  const double* __restrict director;  ///< likewise
  const double* __restrict theta;     ///< of the nodes from `first` on
};

/// Tangents of nodes [first, end) from their edges (2.7, normalised), with rates; true when the edges of one
/// fold back. Directors of nodes with twist: the reference carried to the tangent by the smallest rotation,
/// turned by theta; with rates, also what the carried director turns by itself,
/// ((t_s x t) . t') / (1 + t_s . t) = t_s . (t x t') / (1 + t_s . t). True, too, when a tangent turned too
/// far for that.
template <bool Rates, bool Twist, bool Near>
TENDRIL_INLINE bool direct(std::size_t first, std::size_t end, const Carried& from, Kinematics& kin) {
  const Reader e(kin.e), e_rate(kin.rate.e_rate);
  const Writer to_t(kin.frame.z), to_turning(kin.rate.turning), to_m(kin.frame.y);
  double* __restrict inverse = kin.inverse_bisector.data(), * __restrict connection =
                                                                kin.rate.connection.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 sum = e.at(i - 1) + e.at(i);
    const double length = std::sqrt(lanes::dot(sum, sum));
    const double b = 1.0 / length;
    const V3 t = b * sum;
    V3 turning{};
    const bool folded = !(length >= kFoldBack);
    inverse[i] = folded ? 0.0 : b;
    to_t.put(i, t);
    if constexpr (Rates) {
      turning = lanes::cross(t, b * (e_rate.at(i - 1) + e_rate.at(i)));
      to_turning.put(i, turning);
    }
    bad |= folded ? 1 : 0;
    if constexpr (!Twist) continue;
    const V3 f{from.tangent[3 * i], from.tangent[3 * i + 1], from.tangent[3 * i + 2]};
    const V3 d{from.director[3 * i], from.director[3 * i + 1], from.director[3 * i + 2]};
    const double c = 1.0 + lanes::dot(f, t);
    const double s = 1.0 / c;
    const V3 carried = d - (lanes::dot(t, d) * s) * (f + t);
    const V3 beside = lanes::cross(t, carried);
    const double theta = from.theta[i - first];
    const lanes::SineCosine turn = Near ? lanes::near_sine_cosine(theta) : lanes::sine_cosine(theta);
    to_m.put(i, turn.cosine * carried + turn.sine * beside);
    if constexpr (Rates) connection[i] = s * lanes::dot(f, turning);
    // Within a step no tangent turns further than 126 degrees: a longer way could take the wrong side.
    bad |= c > kTurnedTooFar ? 0 : 1;
  }
  return bad != 0;
}

TENDRIL_LANES bool direct_positions(std::size_t first, std::size_t end, const Carried& from,
                                    Kinematics& kin) {
  return direct<false, true, false>(first, end, from, kin);
}
TENDRIL_LANES bool direct_far(std::size_t first, std::size_t end, const Carried& from, Kinematics& kin) {
  return direct<true, true, false>(first, end, from, kin);
}
TENDRIL_LANES bool direct_near(std::size_t first, std::size_t end, const Carried& from, Kinematics& kin) {
  return direct<true, true, true>(first, end, from, kin);
}
TENDRIL_LANES bool bisect_positions(std::size_t first, std::size_t end, const Carried& from,
                                    Kinematics& kin) {
  return direct<false, false, false>(first, end, from, kin);
}
TENDRIL_LANES bool bisect_all(std::size_t first, std::size_t end, const Carried& from, Kinematics& kin) {
  return direct<true, false, false>(first, end, from, kin);
}

/// Whether all are at most kNearTurn.
TENDRIL_LANES bool turned_little(const double* theta, std::size_t count) {
  std::int64_t far = 0;
  for (std::size_t i = 0; i < count; ++i) far |= std::fabs(theta[i]) <= lanes::kNearTurn ? 0 : 1;
  return far == 0;
}

bool direct_all(std::size_t first, std::size_t end, const Carried& from, Kinematics& kin) {
  return (turned_little(from.theta, end - first) ? direct_near : direct_far)(first, end, from, kin);
}

void set_nodes(const Model& model, double t, const Eigen::VectorXd& y, Kinematics& kin) {
  take_apart(y.data(), model.nodes, kin.p);
  take_apart(y.data() + model.v_begin(), model.nodes, kin.v);
  for (std::size_t a = 0; a < model.anchors.size(); ++a) {
    const Anchor& anchor = model.anchors[a];
    const std::size_t i = model.rods[anchor.rod].first + anchor.node;
    kin.pose[a] = anchor.motion
                      ? anchor.motion(t)
                      : AnchorPose{model.rest_p[i], model.rest_frame[i], Vec3::Zero(), Vec3::Zero()};
    if (!model.holds_position(i)) continue;
    kin.p.set(i, kin.pose[a].position);
    kin.v.set(i, kin.pose[a].velocity);
  }
  for (const Model::Slider& slider : model.sliders) {
    const AnchorPose& pose = kin.pose[slider.anchor];
    kin.p.set(slider.node, pose.position + slider.free * (Vec3(kin.p[slider.node]) - pose.position));
    kin.v.set(slider.node, slider.free * Vec3(kin.v[slider.node]) + slider.carried(pose));
  }
  for (const Model::Attachment& attached : model.attachments) {
    kin.p.set(attached.root, kin.p[attached.parent]);
    kin.v.set(attached.root, kin.v[attached.parent]);
  }
}

/// The root of a child rod takes its frame from the node it is attached to, which is known by then.
TENDRIL_INLINE void take_attachment(const Model::Attachment& attached, bool rates, Kinematics& kin) {
  const std::size_t i = attached.root, at = attached.parent;
  const V3 m = Reader(kin.frame.y).at(at), t = Reader(kin.frame.z).at(at), l = lanes::cross(m, t);
  const Vec3 &y = attached.rest.y, &z = attached.rest.z;
  const V3 tangent = z.x() * l + z.y() * m + z.z() * t;
  Writer(kin.frame.y).put(i, y.x() * l + y.y() * m + y.z() * t);
  Writer(kin.frame.z).put(i, tangent);
  kin.inverse_bisector[i] = 0.0;
  kin.rate.connection[i] = 0.0;
  if (!rates) return;
  const V3 turning = Reader(kin.rate.turning).at(at) + kin.spin[at] * t;
  const double spin = lanes::dot(turning, tangent);
  kin.spin[i] = spin;
  Writer(kin.rate.turning).put(i, turning - spin * tangent);
}
TENDRIL_LANES void take_attachments(const Model& model, bool rates, Kinematics& kin) {
  for (const Model::Attachment& attached : model.attachments) take_attachment(attached, rates, kin);
}

void take_held_frames(const Model& model, Kinematics& kin) {
  for (std::size_t a = 0; a < model.anchors.size(); ++a) {
    const Anchor& anchor = model.anchors[a];
    if (!anchor.holds_frame) continue;
    const std::size_t i = model.rods[anchor.rod].first + anchor.node;
    const AnchorPose& pose = kin.pose[a];
    kin.frame.set(i, pose.frame);
    kin.spin[i] = pose.angular_velocity.dot(pose.frame.z);
    kin.rate.turning.set(i, pose.angular_velocity - kin.spin[i] * pose.frame.z);
    kin.inverse_bisector[i] = 0.0;
    kin.rate.connection[i] = 0.0;
  }
}

/// The reference frame, carried with its axis to the pose's by the smallest rotation and turned about it by
/// theta, as a director is about a tangent. False when the axis turned too far for that.
bool take_swivel(const Model& model, const State& reference, const Eigen::VectorXd& y,
                 const Model::Swivel& swivel, double w, Kinematics& kin) {
  const std::size_t i = swivel.node;
  const AnchorPose& pose = kin.pose[swivel.anchor];
  // Orthonormal again: rounding would grow from step to step.
  const Vec3 z = reference.tangent[i].normalized();
  const Vec3 y_axis = (reference.director[i] - reference.director[i].dot(z) * z).normalized();
  const Frame from{y_axis.cross(z), y_axis, z};
  const Vec3 before = swivel.of(from), axis = swivel.of(pose.frame).normalized();
  const double k = 1.0 + before.dot(axis);
  if (!(k > kTurnedTooFar)) return false;
  const double theta = y[model.theta_begin() + model.twist_index[i]];
  const auto turned = [&](const Vec3& v) {
    return rotate_about(axis, theta, rotate_smallest(before, axis, v));
  };
  const Frame frame{turned(from.x), turned(from.y), turned(from.z)};
  const Vec3 across = pose.angular_velocity - axis.dot(pose.angular_velocity) * axis;
  const Vec3 turning = across + w * axis;
  kin.frame.set(i, frame);
  kin.spin[i] = turning.dot(frame.z);
  kin.rate.turning.set(i, turning - kin.spin[i] * frame.z);
  kin.inverse_bisector[i] = 0.0;
  kin.rate.connection[i] = w + before.dot(across) / k - kin.spin[i];  // theta' = w + ...
  return true;
}

void clear_ends(const Model& model, Kinematics& kin) {
  for (const NodeRange& rod : model.rods) {
    const std::size_t last = rod.first + rod.count - 1;
    kin.e.set(last, Vec3::Zero());
    kin.rate.e_rate.set(last, Vec3::Zero());
    kin.length[last] = kin.inverse_length[last] = kin.rate.length_rate[last] = 0.0;
  }
}

Evaluation find_bad_edge(const Model& model, const Kinematics& kin) {
  for (const NodeRange& rod : model.rods)
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      if (!std::isfinite(kin.length[i])) return {Outcome::not_finite, i};
      if (!(kin.length[i] > 0.0)) return {Outcome::zero_edge, i};
    }
  return {};
}

Evaluation find_bad_tangent(const Model& model, const State& reference, const Model::Segment& segment,
                            const Kinematics& kin) {
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    if (model.holds_frame(i)) continue;
    if (kin.inverse_bisector[i] == 0.0) return {Outcome::fold_back, i};
    if (segment.twist && !(1.0 + reference.tangent[i].dot(kin.frame.z[i]) > kTurnedTooFar))
      return {Outcome::turned_too_far, i};
  }
  return {};
}

const double* numbers(const std::vector<Vec3>& v) {
  return v.empty() ? nullptr : v.front().data();
}

void take_spins(const Model& model, const Model::Segment& s, const Eigen::VectorXd& y, Kinematics& kin) {
  const double* spin = y.data() + model.spin_begin() + model.twist_index[s.first];
  std::copy(spin, spin + (s.end - s.first), &kin.spin[s.first]);
}

void take_swivel_spins(const Model& model, const Eigen::VectorXd& y, Kinematics& kin) {
  for (std::size_t k = 0; k < model.swivels.size(); ++k)
    kin.swivel_spin[k] = y[model.spin_begin() + model.twist_index[model.swivels[k].node]];
}

Evaluation take_frames(const Model& model, const State& reference, const Eigen::VectorXd& y, Motion what,
                       Kinematics& kin) {
  for (const Model::Segment& s : model.segments) {
    if (!s.twist && what == Motion::springs) continue;
    const bool positions = what == Motion::positions;
    Carried from{};
    if (s.twist) {
      const Eigen::Index k = model.twist_index[s.first];
      from = {numbers(reference.tangent), numbers(reference.director), y.data() + model.theta_begin() + k};
      take_spins(model, s, y, kin);
    }
    const auto fill =
        s.twist ? (positions ? direct_positions : direct_all) : (positions ? bisect_positions : bisect_all);
    const bool bad = fill(s.first, s.end, from, kin);
    if (!bad) continue;
    if (const Evaluation at = find_bad_tangent(model, reference, s, kin); !at.ok()) return at;
  }
  take_held_frames(model, kin);
  take_swivel_spins(model, y, kin);
  for (std::size_t k = 0; k < model.swivels.size(); ++k)
    if (!take_swivel(model, reference, y, model.swivels[k], kin.swivel_spin[k], kin))
      return {Outcome::turned_too_far, model.swivels[k].node};
  take_attachments(model, what != Motion::positions, kin);
  return {};
}

}  // namespace

void take_velocities(const Model& model, const Eigen::VectorXd& y, Kinematics& kin) {
  ++kin.number;
  kin.whole = false;
  take_apart(y.data() + model.v_begin(), model.nodes, kin.v);
  for (const Model::Segment& s : model.segments)
    if (s.twist) take_spins(model, s, y, kin);
  take_swivel_spins(model, y, kin);
}

Evaluation kinematics(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                      Motion what, Kinematics& kin) {
  ++kin.number;
  kin.whole = false;
  if ((what != Motion::springs || model.loaded) && !all_finite(y)) return {Outcome::not_finite, 0};
  set_nodes(model, t, y, kin);
  const bool bad = (what == Motion::positions ? measure_positions : measure_all)(0, model.nodes, kin);
  clear_ends(model, kin);
  if (bad)
    if (const Evaluation at = find_bad_edge(model, kin); !at.ok()) return at;
  if (const Evaluation at = take_frames(model, reference, y, what, kin); !at.ok()) return at;
  if (!model.bodies.empty())
    if (const Evaluation at = place_bodies(model, reference, y, kin.bodies); !at.ok()) return at;
  kin.whole = true;
  kin.filled = what;
  return {};
}

}  // namespace tendril
