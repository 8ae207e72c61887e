#include <algorithm>
#include <cmath>

#include "pair_model.h"

namespace tendril::contact {
namespace {

Mat3 smallest_rotation(const Vec3& from, const Vec3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

/// An edge as its material sees it: where it points, how it turned since the last accepted state, and how
/// fast it turns.
struct Turning {
  Vec3 tangent;
  Mat3 since;
  Vec3 spin;
};

/// The part of a node's director across a direction; zero where there is none.
Vec3 across(const Vec3& director, const Vec3& tangent) {
  const Vec3 part = director - tangent.dot(director) * tangent;
  return part.squaredNorm() > 0.0 ? Vec3(part.normalized()) : Vec3(Vec3::Zero());
}

/// The smallest rotation that takes the edge's old direction to the new one, and about that as its director
/// has turned besides.
Turning turning(const PairModel& model, const StateView& state, const PairLedger& kept, const LinePoint& at) {
  const LineEdge& edge = model.lines.edges[at.edge];
  const std::size_t node = model.lines.node_of(state, edge);
  const Vec3 way = state.p[node + 1] - state.p[node], rate = state.v[node + 1] - state.v[node];
  const double length = way.norm();
  const Vec3 t = way / length, before = (kept.p[edge.global + 1] - kept.p[edge.global]).normalized();
  Turning result{t, smallest_rotation(before, t), t.cross(rate) / length};
  const double spin = (1.0 - at.fraction) * state.spin[node] + at.fraction * state.spin[node + 1];
  result.spin += spin * t;
  if (kept.m.empty() || state.m.empty()) return result;
  const std::size_t nearer = at.fraction < 0.5 ? 0 : 1;
  const Vec3 carried = result.since * across(kept.m[edge.global + nearer], before);
  const Vec3 now = across(state.m[node + nearer], t);
  if (carried.squaredNorm() == 0.0 || now.squaredNorm() == 0.0) return result;
  const double angle = std::atan2(t.dot(carried.cross(now)), carried.dot(now));
  result.since = Eigen::AngleAxisd(angle, t).toRotationMatrix() * result.since;
  return result;
}

/// What the surfaces of two points do where they meet: they share a point of the world, so that friction
/// there does as much work on both as their surfaces part, and its moments cancel.
struct Surfaces {
  Vec3 slid;   ///< by how much they have come apart since the last accepted state
  Vec3 apart;  ///< what friction pulls with: that and what it pulled with then
  Vec3 rate;   ///< of the first less the second
};

Surfaces surfaces(const PairModel& model, const StateView& state, const PairLedger& kept, const PairTouch& to,
                  const Vec3& velocity) {
  const PointPair& at = to.at;
  const Turning first = turning(model, state, kept, model.lines.points[at.first]);
  const Turning second = turning(model, state, kept, model.lines.points[at.second]);
  const Vec3 before = model.point(kept.p, at.first) - model.point(kept.p, at.second);
  const double whole = at.apart.norm(), share = to.arm / whole;
  const Vec3 arm = share * before, other = (1.0 - share) * before;
  Surfaces result;
  result.slid = at.apart - first.since * arm - second.since * other;
  const PairMeeting* met = find_key(kept.meetings, model.key_of(at));
  result.apart = met ? Vec3(met->apart + result.slid) : result.slid;
  result.rate = velocity - first.spin.cross(share * at.apart) - second.spin.cross((1.0 - share) * at.apart);
  return result;
}

/// Coulomb's law as for solids, see add_friction there.
void add_friction(const Law& law, double k, double most, const Surfaces& between, PairTouch& to) {
  const auto along = [&](const Vec3& y) -> Vec3 { return y - to.normal.dot(y) * to.normal; };
  const Vec3 u = along(between.apart), s = u + law.stick_damping * along(between.rate);
  const double pull = k * s.norm(), far = kTrail * most / k;
  to.slid = between.slid;
  to.sticks = pull <= most;
  to.friction = -(to.sticks ? k : most / s.norm()) * s;
  to.apart = !to.sticks && u.norm() > far ? Vec3(far * u.normalized()) : u;
  to.force += to.friction;
}

Vec3 velocity_of(const PairModel& model, const StateView& state, std::size_t point) {
  const LinePoint& at = model.lines.points[point];
  const std::size_t node = model.lines.node_of(state, model.lines.edges[at.edge]);
  return between(state.v[node], state.v[node + 1], at.fraction);
}

}  // namespace

Mat3 bend_of(const PointPair& at) {
  const double whole = at.apart.norm();
  const Vec3 n = at.apart / whole;
  return (Mat3::Identity() - n * n.transpose()) / whole;
}

PairTouch respond(const PairModel& model, const StateView& state, const PairLedger* kept,
                  const PointPair& at) {
  const double whole = at.apart.norm(), weight = model.weight(at);
  const LinePoint &x = model.lines.points[at.first], &y = model.lines.points[at.second];
  const Vec3 n = at.apart / whole;
  const Vec3 velocity = velocity_of(model, state, at.first) - velocity_of(model, state, at.second);
  const Normal normal = push_of(model.law, weight, at.gap, n, bend_of(at), velocity, Vec3::Zero());
  const double radius = model.lines.rods[model.lines.edges[x.edge].rod].radius;
  const double arm = whole * radius / model.thick(x.edge, y.edge);
  PairTouch result{
      at, n, normal.damped * normal.push * n, Vec3::Zero(), false, Vec3::Zero(), Vec3::Zero(), arm, normal};
  if (model.law.friction > 0.0 && kept)
    add_friction(model.law, weight * stick_of(model.law), model.law.friction * normal.damped * normal.push,
                 surfaces(model, state, *kept, result, velocity), result);
  return result;
}

}  // namespace tendril::contact
