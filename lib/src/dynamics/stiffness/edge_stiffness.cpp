#include "edge_stiffness.h"

#include <cmath>

#include "dynamics/vector/lanes.h"
#include "spring_stiffness.h"
#include "springs.h"

namespace tendril {
namespace {

/// (1 - a a^T) m (1 - b b^T)
Mat3 project(const Vec3& a, const Mat3& m, const Vec3& b) {
  const Mat3 left = m - a * (a.transpose() * m);
  return left - (left * b) * b.transpose();
}

/// Second derivative of g.n by d, n = d / |d|.
Mat3 curvature_of_unit(const Vec3& n, double inverse_length, const Vec3& g) {
  const Vec3 across = g - g.dot(n) * n;
  return -(inverse_length * inverse_length) *
         (g.dot(n) * projector(n) + n * across.transpose() + across * n.transpose());
}

/// The edges around edge i that its springs see, in the order of their nodes: i - 1, i, i + 1; at a child's
/// root the two of the node it is attached to, then i, i + 1.
struct Neighbourhood {
  Neighbourhood(const Model& model, const NodeRange& rod, std::size_t i)
      : frame_of{i == rod.first ? model.carrier[i] : i, i + 1},
        attached(frame_of[0] != i),
        own(attached ? 2 : 1),
        edge{frame_of[0] - 1, attached ? frame_of[0] : i, attached ? i : i + 1, i + 1},
        there{model.has_before(frame_of[0]), !attached || model.has_after(frame_of[0]),
              attached || model.has_after(i + 1), attached && model.has_after(i + 1)} {}

  /// Places of the two edges whose sum gives the tangent at a side.
  std::size_t before(std::size_t side) const { return side == 0 ? 0 : own; }
  std::size_t after(std::size_t side) const { return side == 0 ? 1 : own + 1; }
  /// Slots of the nodes that edge place x joins.
  std::size_t from(std::size_t x) const { return attached && x == 2 ? 1 : x; }
  std::size_t to(std::size_t x) const { return x + 1; }

  std::array<std::size_t, 2> frame_of;  ///< node whose tangent and angle count
  bool attached;
  std::size_t own;  ///< place of edge i
  std::array<std::size_t, 4> edge;
  std::array<bool, 4> there;
};

/// Second derivatives by the unit edges of a neighbourhood and the two angles; blocks x <= y.
struct ByEdges {
  Mat3 k[4][4];
  Vec3 angle[4][2];
};

/// Tangents as the normalised sums of their edges: t = T (e_before + e_after), T = (1 - t t^T) / |sum|.
ByEdges by_edges(const Neighbourhood& n, const Kinematics& kin, const SpringStiffness& s) {
  Mat3 share[2];
  for (std::size_t side = 0; side < 2; ++side)
    share[side] = kin.inverse_bisector[n.frame_of[side]] * projector(kin.frame.z[n.frame_of[side]]);
  const Mat3 et[2] = {s.et[0] * share[0], s.et[1] * share[1]};
  const Mat3 tt[2] = {share[0] * s.tt[0] * share[0], share[1] * s.tt[1] * share[1]};
  const Mat3 t0_t1 = share[0] * s.t0_t1 * share[1];
  const auto in = [&](std::size_t side, std::size_t x) { return x == n.before(side) || x == n.after(side); };

  ByEdges b;
  for (std::size_t x = 0; x < 4; ++x) {
    for (std::size_t y = x; y < 4; ++y) {
      Mat3& k = b.k[x][y];
      k.setZero();
      if (x == n.own && y == n.own) k += s.ee;
      for (std::size_t side = 0; side < 2; ++side) {
        if (x == n.own && in(side, y)) k += et[side];
        if (y == n.own && in(side, x)) k += et[side].transpose();
        if (in(side, x) && in(side, y)) k += tt[side];
      }
      if (in(0, x) && in(1, y)) k += t0_t1;
      if (in(1, x) && in(0, y)) k += t0_t1.transpose();
    }
    for (std::size_t angle = 0; angle < 2; ++angle) {
      Vec3& g = b.angle[x][angle];
      g.setZero();
      if (x == n.own) g += s.e_theta[angle];
      for (std::size_t side = 0; side < 2; ++side)
        if (in(side, x)) g += share[side] * s.t_theta[side][angle];
    }
  }
  return b;
}

/// Curvature of the tangents t(e). What the edge's own springs give along a tangent counts with this edge;
/// what all springs at the node give across it counts once, with the edge that begins there, at the last node
/// with the last edge. (Across a free tangent the bending of its two edges cancels.)
void add_tangent_curvature(const Model& model, const Neighbourhood& n, const Kinematics& kin,
                           const Gradient& grad, const SpringStiffness& s, ByEdges& b) {
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t node = n.frame_of[side];
    if (model.holds_frame(node) || (side == 0 && n.attached)) continue;
    const Vec3 t = kin.frame.z[node];
    Vec3 g = s.g_t[side].dot(t) * t;
    if (side == 0 || !model.has_after(node)) g += grad.tangent[node];
    const Mat3 c = curvature_of_unit(t, kin.inverse_bisector[node], g);
    for (const std::size_t x : {n.before(side), n.after(side)})
      for (const std::size_t y : {n.before(side), n.after(side)})
        if (x <= y) b.k[x][y] += c;
  }
}

/// Gradient by the unit edge i: of its springs, and through its tangents.
Vec3 gradient_by_edge(std::size_t i, const Kinematics& kin, const Gradient& grad, const SpringStiffness& s) {
  return s.g_e + kin.inverse_bisector[i] * grad.tangent[i] +
         kin.inverse_bisector[i + 1] * grad.tangent[i + 1];
}

/// Where the positions and angles of a neighbourhood stand, and whether their rows act.
void place(const Model& model, const Neighbourhood& n, std::size_t i, EdgeStiffness& to) {
  to.node.fill(EdgeStiffness::kNone);
  const auto set = [&](std::size_t slot, std::size_t node, bool there, bool through_joint) {
    if (!there) return;
    to.node[slot] = model.carrier[node];
    to.node_feels[slot] = model.feels[node] != 0 && through_joint;
  };
  const std::size_t first = n.frame_of[0];
  const bool through = !n.attached || model.feels[i] != 0;
  set(0, first - 1, model.has_before(first), through);
  set(1, first, true, through);
  std::size_t slot = 2;
  if (n.attached) set(slot++, first + 1, model.has_after(first), through);
  set(slot++, i + 1, true, true);
  set(slot, i + 2, model.has_after(i + 1), true);
  to.angle = n.frame_of;
  to.angle_feels = {through, true};
}

/// Adds k by the vectors along the edges x <= y, each the difference of two nodes.
void put(const Neighbourhood& n, std::size_t x, std::size_t y, const Mat3& k, EdgeStiffness& to) {
  const std::size_t ends[2][2] = {{n.from(x), n.to(x)}, {n.from(y), n.to(y)}};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      const std::size_t a = ends[0][i];
      const std::size_t b = ends[1][j];
      const double sign = i == j ? 1.0 : -1.0;
      // A pair of nodes stands once; a node's own block gets both halves of what two edges give it.
      if (a <= b)
        to.k[a][b] += sign * k;
      else if (x != y)
        to.k[b][a] += sign * k.transpose();
      if (a == b && x != y) to.k[a][a] += sign * k.transpose();
    }
}

/// From unit edges to nodes, e = d / |d|.
void to_nodes(const Neighbourhood& n, const Kinematics& kin, const ByEdges& b, const SpringStiffness& s,
              EdgeStiffness& to) {
  for (std::size_t a = 0; a < 5; ++a) {
    for (std::size_t c = a; c < 5; ++c) to.k[a][c].setZero();
    for (Vec3& g : to.by_angle[a]) g.setZero();
  }
  for (std::size_t x = 0; x < 4; ++x) {
    if (!n.there[x]) continue;
    const Vec3 ex = kin.e[n.edge[x]];
    const double sx = kin.inverse_length[n.edge[x]];
    for (std::size_t y = x; y < 4; ++y)
      if (n.there[y])
        put(n, x, y, (sx * kin.inverse_length[n.edge[y]]) * project(ex, b.k[x][y], kin.e[n.edge[y]]), to);
    for (std::size_t angle = 0; angle < 2; ++angle) {
      const Vec3 g = sx * (b.angle[x][angle] - ex.dot(b.angle[x][angle]) * ex);
      to.by_angle[n.from(x)][angle] -= g;
      to.by_angle[n.to(x)][angle] += g;
    }
  }
  for (std::size_t angle = 0; angle < 2; ++angle) {
    to.angles[angle][angle] = s.theta[angle];
    to.angles[angle][1 - angle] = s.theta0_theta1;
  }
}

}  // namespace

void edge_stiffness(const Model& model, const NodeRange& rod, std::size_t i, const Kinematics& kin,
                    const Gradient& grad, bool viscous, EdgeStiffness& to) {
  const Neighbourhood n(model, rod, i);
  SpringStiffness springs = spring_stiffness(model, i, kin, grad, viscous);
  const Vec3 g_edge = gradient_by_edge(i, kin, grad, springs);
  by_frames(model, n.frame_of, i, kin, springs);
  ByEdges edges = by_edges(n, kin, springs);
  add_tangent_curvature(model, n, kin, grad, springs, edges);
  to_nodes(n, kin, edges, springs, to);
  put(n, n.own, n.own,
      curvature_of_unit(kin.e[i], kin.inverse_length[i], g_edge) + stretch_stiffness(model, i, kin), to);
  place(model, n, i, to);
}

void edge_resistance(const Model& model, const NodeRange& rod, std::size_t i, const Kinematics& kin,
                     EdgeStiffness& to) {
  const Neighbourhood n(model, rod, i);
  SpringStiffness springs = spring_resistance(model, i, kin);
  by_frames(model, n.frame_of, i, kin, springs);
  to_nodes(n, kin, by_edges(n, kin, springs), springs, to);
  put(n, n.own, n.own, model.stretch[i] * kin.e[i] * kin.e[i].transpose(), to);
  place(model, n, i, to);
}

namespace {

/// Gradient of one thing that a spring sees, by the unit edge, and by tangent and angle of either node.
struct Slope {
  Vec3 e = Vec3::Zero();
  Vec3 t[2] = {Vec3::Zero(), Vec3::Zero()};
  double theta[2] = {0.0, 0.0};
};

std::array<Slope, EdgeSlopes::kSprings> slopes_of(std::size_t i, const Kinematics& kin) {
  std::array<Slope, EdgeSlopes::kSprings> all;
  for (std::size_t side = 0; side < 2; ++side) {
    const Frame f = kin.frame[i + side];
    const EdgeAngles a = edge_angles(kin.e[i], f);
    const Vec3 e = kin.e[i];
    const auto set = [&](Slope& to, double by_x, double by_y, double by_z) {
      const Vec3 across = by_x * f.x + by_y * f.y;
      to.e = across + by_z * f.z;
      to.t[side] = by_z * e - a.z * across;
      to.theta[side] = by_x * a.y - by_y * a.x;
    };
    const double mixed = a.rise * a.x * a.y;
    set(all[2 * side], a.ratio + a.rise * a.x * a.x, mixed, -a.x);
    set(all[2 * side + 1], mixed, a.ratio + a.rise * a.y * a.y, -a.y);
  }
  const Vec3 ta = kin.frame.z[i];
  const Vec3 tb = kin.frame.z[i + 1];
  all[4].t[0] = all[4].t[1] = ta.cross(tb) / (1.0 + ta.dot(tb));
  all[4].theta[0] = -1.0;
  all[4].theta[1] = 1.0;
  return all;
}

/// By the frame the first node is fixed to: phi = t x d + theta t turns t_0 by phi x t_0, theta_0 by phi .
/// t_0.
void by_parent_frame(const Vec3& t, const Vec3& t0, Slope& s) {
  const Vec3 turn = t0.cross(s.t[0]) + s.theta[0] * t0;
  s.t[0] = turn.cross(t);
  s.theta[0] = turn.dot(t);
}

/// Away from the reference the carried director spins by -((t_s x t) . dt) / (1 + t_s . t). It counts twice:
/// the gradient is by (p, theta), and theta' has the connection term, whose change with t is the same again.
Vec3 carried_spin(const Vec3& from, const Vec3& t) {
  return 2.0 / (1.0 + from.dot(t)) * from.cross(t);
}

}  // namespace

void edge_slopes(const Model& model, const NodeRange& rod, std::size_t i, const State& reference,
                 const Kinematics& kin, EdgeSlopes& to) {
  const Neighbourhood n(model, rod, i);
  std::array<Slope, EdgeSlopes::kSprings> all = slopes_of(i, kin);
  Vec3 spin[2];
  for (std::size_t side = 0; side < 2; ++side)
    spin[side] = carried_spin(reference.tangent[n.frame_of[side]], kin.frame.z[n.frame_of[side]]);
  for (std::size_t q = 0; q < EdgeSlopes::kSprings; ++q) {
    Slope& s = all[q];
    if (n.attached) by_parent_frame(kin.frame.z[n.frame_of[0]], kin.frame.z[i], s);
    Vec3 share[2];
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 t = kin.frame.z[n.frame_of[side]];
      const Vec3 g = s.t[side] - s.theta[side] * spin[side];
      share[side] = kin.inverse_bisector[n.frame_of[side]] * (g - t.dot(g) * t);
      to.angle[q][side] = s.theta[side];
      if (const Model::Swivel* swivel = model.swivel_of(n.frame_of[side])) {
        const Vec3 axis = swivel->of(kin.frame[n.frame_of[side]]);
        to.angle[q][side] = s.t[side].dot(axis.cross(t)) + s.theta[side] * axis.dot(t);
      }
    }
    for (Vec3& g : to.node[q]) g.setZero();
    for (std::size_t x = 0; x < 4; ++x) {
      if (!n.there[x]) continue;
      Vec3 g = x == n.own ? s.e : Vec3::Zero();
      for (std::size_t side = 0; side < 2; ++side)
        if (x == n.before(side) || x == n.after(side)) g += share[side];
      const Vec3 e = kin.e[n.edge[x]];
      const Vec3 along = kin.inverse_length[n.edge[x]] * (g - e.dot(g) * e);
      to.node[q][n.from(x)] -= along;
      to.node[q][n.to(x)] += along;
    }
  }
}

void hub_slopes(const Model& model, const Model::Hub::Child& child, const State& reference,
                const Kinematics& kin, HubSlopes& to) {
  const NodeRange& rod = model.rods[child.rod];
  EdgeSlopes slopes;
  edge_slopes(model, rod, child.root, reference, kin, slopes);
  place(model, Neighbourhood(model, rod, child.root), child.root, to.place);
  constexpr std::size_t kSpring[] = {0, 1, 4};  // towards l and m at the first node, and the twist
  for (std::size_t row = 0; row < 2; ++row) {
    for (Vec3& g : to.node[row]) g.setZero();
    to.angle[row][0] = to.angle[row][1] = 0.0;
    for (std::size_t q = 0; q < 3; ++q) {
      const double k = child.moment(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(q));
      for (std::size_t a = 0; a < 5; ++a) to.node[row][a] += k * slopes.node[kSpring[q]][a];
      for (std::size_t a = 0; a < 2; ++a) to.angle[row][a] += k * slopes.angle[kSpring[q]][a];
    }
  }
}

void turned_resistance(const Model& model, const NodeRange& rod, std::size_t i, const EdgeSlopes& slopes,
                       const EdgeSlopes& rates, TurnedResistance& to) {
  const double stiffness[] = {model.bend_l[i], model.bend_m[i], model.bend_l[i + 1], model.bend_m[i + 1],
                              model.twist[i]};
  const Neighbourhood n(model, rod, i);
  place(model, n, i, to.place);
  const bool attached = n.attached;
  for (std::size_t a = 0; a < 5; ++a) {
    for (Mat3& k : to.k[a]) k.setZero();
    for (std::size_t b = 0; b < 2; ++b) to.by_angle[a][b] = to.of_angle[b][a] = Vec3::Zero();
  }
  for (auto& row : to.angles) row[0] = row[1] = 0.0;
  for (std::size_t q = 0; q < EdgeSlopes::kSprings; ++q) {
    // A deviation sees the edges of its own side and the edge between.
    const std::size_t first = q == 2 || q == 3 ? 1 : 0;
    const std::size_t end = q < 2 && !attached ? 3 : 5;
    for (std::size_t a = first; a < end; ++a) {
      const Vec3 g = stiffness[q] * slopes.node[q][a];
      for (std::size_t b = first; b < end; ++b) to.k[a][b] += g * rates.node[q][b].transpose();
      for (std::size_t b = 0; b < 2; ++b) to.by_angle[a][b] += rates.angle[q][b] * g;
    }
    for (std::size_t a = 0; a < 2; ++a) {
      const double g = stiffness[q] * slopes.angle[q][a];
      for (std::size_t b = first; b < end; ++b) to.of_angle[a][b] += g * rates.node[q][b];
      for (std::size_t b = 0; b < 2; ++b) to.angles[a][b] += g * rates.angle[q][b];
    }
  }
}

Mat3 stretch_stiffness(const Model& model, std::size_t i, const Kinematics& kin) {
  const Vec3 e = kin.e[i];
  const double tension = model.stretch[i] * (1.0 - model.rest_length[i] * kin.inverse_length[i]);
  return (model.stretch[i] - tension) * e * e.transpose() + tension * Mat3::Identity();
}

Mat3 turned_pull(const Model& model, std::size_t i, const Kinematics& kin) {
  const Vec3 e = kin.e[i];
  const Vec3 v = Vec3(kin.v[i + 1]) - Vec3(kin.v[i]);
  const double along = e.dot(v);
  const double k = model.viscosity[i] * model.stretch[i] * kin.inverse_length[i];
  return k * (e * (v - 2 * along * e).transpose() + along * Mat3::Identity());
}

namespace {

using lanes::ByCosine;

/// Of 1/2 K angle^2, by sine and cosine of the angle.
ByCosine by_cosine(double stiffness, double sine, double z) {
  const bool near = z > 0.0 && sine * sine <= lanes::kWideSquare;
  const double angle = near ? sine * lanes::wide_asin_ratio(sine * sine) : std::atan2(sine, z);
  return lanes::by_cosine(stiffness, angle, 0.0, sine, z);
}

/// Of e(d).t by d, for a spring on the cosine between them.
Mat3 by_edge(const ByCosine& w, const Vec3& e, const Vec3& t, double z, double inverse_length) {
  const Vec3 u = inverse_length * (t - z * e);
  const Mat3 bent = inverse_length * inverse_length * z * (Mat3::Identity() - e * e.transpose()) +
                    inverse_length * (e * u.transpose() + u * e.transpose());
  return w.curvature * u * u.transpose() - w.slope * bent;
}

}  // namespace

Mat3 held_hinge_stiffness(const Model& model, std::size_t node, std::size_t i, const Kinematics& kin) {
  const Vec3 e = kin.e[i];
  const Vec3 t = kin.frame.z[node];
  const double z = e.dot(t);
  const ByCosine w = by_cosine(model.bend_l[node] + model.bend_t[node], e.cross(t).norm(), z);
  return by_edge(w, e, t, z, kin.inverse_length[i]);
}

}  // namespace tendril
