#include "rig/sections.h"

#include "rig/refine.h"

#include <tendril/base/error.h>
#include <tendril/bind/binding.h>
#include <tendril/bind/inspect.h>
#include <tendril/curve/fit.h>
#include <tendril/curve/frame_jump.h>
#include <tendril/curve/frames.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril::runner {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kPlanes = 4;               ///< an edge
constexpr double kLeastWay = 1.0 / 3.0;  ///< of the way round, for a section that counts
constexpr double kWholeWay = 0.95;       ///< from here on nothing is missing
constexpr double kClear = 1.1;           ///< semi-axes from a curve from where on a limb has left its body
constexpr double kFlat = 1.05;           ///< ratio of semi-axes from which directions count

/// Integrals over a section about the axis: of 1, u, v, u^2, u v, v^2; and the way round, in radians.
struct Moments {
  double area = 0.0, u = 0.0, v = 0.0, uu = 0.0, uv = 0.0, vv = 0.0, way = 0.0;

  /// The triangle from the axis to a piece of the section's edge, signed by the piece's direction: the
  /// integral of a product of coordinates over a triangle is area / 12 times the sum over pairs of corners,
  /// equal ones twice, and one corner is the origin.
  void add(const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    const double twice = p.x() * q.y() - p.y() * q.x();
    area += twice / 2;
    u += twice / 6 * (p.x() + q.x());
    v += twice / 6 * (p.y() + q.y());
    uu += twice / 12 * (p.x() * p.x() + p.x() * q.x() + q.x() * q.x());
    vv += twice / 12 * (p.y() * p.y() + p.y() * q.y() + q.y() * q.y());
    uv += twice / 24 * (2 * p.x() * p.y() + p.x() * q.y() + q.x() * p.y() + 2 * q.x() * q.y());
    way += std::atan2(twice, p.dot(q));
  }

  void add(const Moments& m, double factor) {
    area += factor * m.area, u += factor * m.u, v += factor * m.v;
    uu += factor * m.uu, uv += factor * m.uv, vv += factor * m.vv;
  }
};

/// An axis with the curve through it, and where its nodes are on the curve.
struct Axis {
  CurvePair pair;
  std::vector<double> parameters;

  explicit Axis(const RigCurve& curve) : Axis(curve, fit_of(curve)) {}

  /// 2.5 is halfway from node 2 to 3.
  double node_at(double t) const {
    const auto after = std::upper_bound(parameters.begin() + 1, parameters.end() - 1, t);
    const auto k = static_cast<std::size_t>(after - parameters.begin());
    const double part = (t - parameters[k - 1]) / (parameters[k] - parameters[k - 1]);
    return static_cast<double>(k - 1) + std::clamp(part, 0.0, 1.0);
  }

  /// Its ends are nearer to each other than an edge is long, and it goes a long way round.
  bool is_ring() const {
    const Points at = pair.primary().control_points();
    const double edge = (at[1] - at[0]).norm() + (at[at.size() - 1] - at[at.size() - 2]).norm();
    return at.size() > 4 && (at.front() - at.back()).norm() < edge;
  }

 private:
  Axis(const RigCurve& curve, const Interpolator& fit)
      : pair(fit.knots(), fit.solve(curve.points), fit.solve(curve.orientation)),
        parameters(fit.parameters()) {}
  static Interpolator fit_of(const RigCurve& curve) {
    const int degree = static_cast<int>(std::min<std::size_t>(3, curve.points.size() - 1));
    return Interpolator(degree, curve.points, Parametrisation::centripetal);
  }
};

double mean_edge(const std::vector<Vec3>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length / static_cast<double>(points.size() - 1);
}

/// The mesh in the axial spaces of the axes.
class Cutter {
 public:
  Cutter(const bind::PolygonMesh& mesh, const std::vector<Axis>& axes, int threads)
      : binding_(pairs_of(axes), mesh, {.mode = bind::BindMode::nearest, .threads = threads}) {
    for (const Axis& axis : axes) {
      moments_.emplace_back(kPlanes * (axis.parameters.size() - 1));
      rings_.push_back(axis.is_ring());
    }
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      node_.push_back(axes[binding_.pair_of(i)].node_at(binding_.records()[i].t));
    for (std::size_t f = 0; f < mesh.face_count(); ++f) cut(mesh.face(f));
  }

  /// Per axis and plane; plane j is at node (j + 1/2) / kPlanes.
  std::vector<std::vector<Moments>> moments() && { return std::move(moments_); }
  std::uint32_t axis_of(std::size_t point) const { return binding_.pair_of(point); }
  double node_of(std::size_t point) const { return node_[point]; }

 private:
  static std::vector<CurvePair> pairs_of(const std::vector<Axis>& axes) {
    std::vector<CurvePair> out;
    for (const Axis& axis : axes) out.push_back(axis.pair);
    return out;
  }

  static double plane(std::size_t j) { return (static_cast<double>(j) + 0.5) / kPlanes; }

  Eigen::Vector2d across(std::size_t point) const {
    return {binding_.records()[point].u, binding_.records()[point].v};
  }

  void cut(std::span<const std::uint32_t> face) {
    const std::uint32_t axis = axis_of(face[0]);
    if (axis_of(face[1]) != axis || axis_of(face[2]) != axis) return;
    const auto [low, high] = std::minmax({node_[face[0]], node_[face[1]], node_[face[2]]});
    std::vector<Moments>& planes = moments_[axis];
    // Across the seam of a ring a small triangle goes from one end of the axis to the other, not along it.
    if (rings_[axis] && (high - low) * kPlanes > 0.5 * static_cast<double>(planes.size())) return;
    auto j = static_cast<std::size_t>(std::max(0.0, std::ceil(low * kPlanes - 0.5)));
    for (; j < planes.size() && plane(j) < high; ++j) cut(face, plane(j), planes[j]);
  }

  /// The piece of a triangle's inside that a plane meets, from where the way round the triangle rises through
  /// the plane to where it falls: the same way round for all triangles that look outward.
  void cut(std::span<const std::uint32_t> face, double at, Moments& moments) const {
    Eigen::Vector2d rise, fall;
    bool has_rise = false, has_fall = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % 3];
      if ((node_[a] <= at) == (node_[b] <= at)) continue;
      const double part = (at - node_[a]) / (node_[b] - node_[a]);
      const Eigen::Vector2d p = (1.0 - part) * across(a) + part * across(b);
      (node_[a] <= at ? rise : fall) = p;
      (node_[a] <= at ? has_rise : has_fall) = true;
    }
    if (has_rise && has_fall) moments.add(fall, rise);
  }

  bind::Binding binding_;
  std::vector<double> node_;
  std::vector<std::vector<Moments>> moments_;
  std::vector<bool> rings_;
};

/// Of a node: the mean of the planes within half an edge that show enough of a section; area 0 for none.
Moments at_node(const std::vector<Moments>& planes, std::size_t node) {
  const std::size_t half = kPlanes / 2;
  const std::size_t begin = kPlanes * node > half ? kPlanes * node - half : 0;
  Moments sum;
  double seen = 0.0;
  for (std::size_t j = begin; j < std::min(planes.size(), kPlanes * node + half); ++j) {
    const double part = planes[j].way / (2 * kPi);
    if (!(part > kLeastWay) || !(planes[j].area > 0.0)) continue;
    sum.add(planes[j], part < kWholeWay ? 1.0 / part : 1.0);
    seen += 1.0;
  }
  if (seen == 0.0) return {};
  Moments mean;
  mean.add(sum, 1.0 / seen);
  // About the centroid. A long way off, the axis is not where the section bends about.
  mean.uu -= mean.u * mean.u / mean.area;
  mean.uv -= mean.u * mean.v / mean.area;
  mean.vv -= mean.v * mean.v / mean.area;
  // Pieces that are missing or doubled can leave what no section has.
  if (!(mean.uu > 0.0) || !(mean.uu * mean.vv > mean.uv * mean.uv)) return {};
  return mean;
}

RigSection ellipse(const Moments& m, double turn) {
  const double c = std::cos(turn), s = std::sin(turn);
  const double ll = c * c * m.uu + 2 * c * s * m.uv + s * s * m.vv;
  const double mm = s * s * m.uu - 2 * c * s * m.uv + c * c * m.vv;
  // An ellipse's are A a^2 / 4 and A b^2 / 4; then scaled to the area.
  const double ratio = std::sqrt(std::sqrt(ll / mm));
  const double mean = std::sqrt(m.area / kPi);
  return {mean * ratio, mean / ratio, true};
}

/// The one angle, at most 45 degrees, that makes the sum of the off-diagonal moments vanish; each node's
/// count relative to its area, so that a thick part does not decide alone.
double principal_turn(const std::vector<Moments>& nodes) {
  double difference = 0.0, mixed = 0.0, sum = 0.0;
  for (const Moments& m : nodes) {
    if (!(m.area > 0.0)) continue;
    difference += (m.uu - m.vv) / (m.area * m.area);
    mixed += 2.0 * m.uv / (m.area * m.area);
    sum += (m.uu + m.vv) / (m.area * m.area);
  }
  const double uneven = std::hypot(difference, mixed);
  const double least = (kFlat * kFlat - 1.0) / (kFlat * kFlat + 1.0);
  if (!(uneven > least * sum)) return 0.0;
  const double turn = 0.5 * std::atan2(mixed, difference);
  if (turn > kPi / 4) return turn - kPi / 2;
  return turn < -kPi / 4 ? turn + kPi / 2 : turn;
}

void turn_about(RigCurve& curve, double turn) {
  if (turn == 0.0) return;
  const PolygonTangents tangents = polygon_tangents(curve.points);
  for (std::size_t i = 0; i < curve.points.size(); ++i)
    curve.orientation[i] =
        curve.points[i] + rotate_about(tangents.t[i], turn, Vec3(curve.orientation[i] - curve.points[i]));
}

/// Whether a point is inside the section of a curve at its nearest node, or close to it. The neighbours'
/// sections count too: where a limb leaves, its body shows less of itself.
bool is_within(const RigCurve& curve, const std::vector<RigSection>& sections, const Vec3& point) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < curve.points.size(); ++i)
    if ((curve.points[i] - point).norm() < (curve.points[nearest] - point).norm()) nearest = i;
  double a = 0.0, b = 0.0;
  for (std::size_t i = nearest - std::min<std::size_t>(nearest, 2); i < sections.size() && i <= nearest + 2;
       ++i)
    a = std::max(a, sections[i].a), b = std::max(b, sections[i].b);
  const Frame frame = node_frames(curve.points, curve.orientation).frame[nearest];
  const Vec3 off = point - curve.points[nearest];
  return std::hypot(off.dot(frame.x) / a, off.dot(frame.y) / b) < kClear;
}

/// Down to where it leaves its parent's body, a limb has the skin of both, and is as stiff as that body: its
/// sections there go from the parent's at the joint, as a circle no wider than either way across it, to its
/// own first one.
void blend_root(std::vector<RigSection>& sections, const RigCurve& curve, const RigCurve& parent,
                const std::vector<RigSection>& around) {
  std::size_t out = 0;
  while (out + 1 < sections.size() && (is_within(parent, around, curve.points[out]) || !sections[out].seen))
    ++out;
  const RigSection& joint = around[curve.joint->node];
  const double radius = std::min(joint.a, joint.b);
  const RigSection first = sections[out];
  for (std::size_t i = 0; i < out; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(out);
    sections[i] = {(1.0 - part) * std::max(radius, first.a) + part * first.a,
                   (1.0 - part) * std::max(radius, first.b) + part * first.b, false};
  }
}

/// Nodes that show nothing get what lies between their neighbours that do.
void fill(std::vector<RigSection>& sections, const RigCurve& curve) {
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < sections.size(); ++i)
    if (sections[i].seen) seen.push_back(i);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].seen) continue;
    if (seen.empty()) {
      if (curve.radius.empty())
        throw InvalidInput("curve '" + curve.name + "'", "no section of the mesh can be seen about it",
                           "an axis inside a limb of the mesh, or its radius at each point");
      sections[i] = {curve.radius[i], curve.radius[i], false};
      continue;
    }
    const auto after = std::upper_bound(seen.begin(), seen.end(), i);
    const std::size_t high = after == seen.end() ? seen.back() : *after;
    const std::size_t low = after == seen.begin() ? seen.front() : *(after - 1);
    const double part = high == low ? 0.0 : static_cast<double>(i - low) / static_cast<double>(high - low);
    sections[i] = {(1.0 - part) * sections[low].a + part * sections[high].a,
                   (1.0 - part) * sections[low].b + part * sections[high].b, false};
  }
}

double volume_of(const bind::PolygonMesh& mesh) {
  double six = 0.0;
  const Vec3 from = mesh.points.front();  // near the mesh, so that nothing large cancels
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const Vec3 a = mesh.points[face[0]] - from, b = mesh.points[face[1]] - from,
               c = mesh.points[face[2]] - from;
    six += a.dot(b.cross(c));
  }
  return std::abs(six) / 6.0;
}

void collect_skin(const bind::PolygonMesh& mesh, const Cutter& cutter, const std::vector<RigCurve>& curves,
                  Body& body) {
  body.first_skin.resize(curves.size());
  body.last_skin.resize(curves.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const std::uint32_t axis = cutter.axis_of(i);
    const auto last = static_cast<double>(curves[axis].points.size() - 1);
    if (cutter.node_of(i) <= 1.5) body.first_skin[axis].push_back(mesh.points[i]);
    if (cutter.node_of(i) >= last - 1.5) body.last_skin[axis].push_back(mesh.points[i]);
  }
}

/// Which way round is positive is one choice for the whole mesh, which may be inside out.
void make_positive(std::vector<std::vector<Moments>>& moments) {
  double area = 0.0;
  for (const auto& planes : moments)
    for (const Moments& m : planes) area += m.area;
  if (area >= 0.0) return;
  for (auto& planes : moments) {
    for (Moments& m : planes) {
      Moments turned;
      turned.add(m, -1.0);
      turned.way = -m.way;
      m = turned;
    }
  }
}

}  // namespace

Body measure_body(const bind::PolygonMesh& mesh, std::vector<RigCurve>& curves, int threads) {
  std::vector<Axis> axes;
  double edge = std::numeric_limits<double>::infinity();
  for (const RigCurve& curve : curves) {
    axes.emplace_back(curve);
    if (const auto jump = find_frame_jump(axes.back().pair, axes.back().parameters))
      throw InvalidInput("mesh", "the axis '" + curve.name + "': " + describe(*jump, "nodes"),
                         "axes that carry on along themselves; --axis takes them mended by hand");
    edge = std::min(edge, mean_edge(curve.points));
  }
  const bind::PolygonMesh fine = split_long_edges(mesh, edge);
  Body body;
  if (bind::inspect(mesh).is_closed()) body.volume = volume_of(fine);
  Cutter cutter(fine, axes, threads);
  collect_skin(fine, cutter, curves, body);
  std::vector<std::vector<Moments>> moments = std::move(cutter).moments();
  make_positive(moments);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    std::vector<Moments> nodes;
    for (std::size_t i = 0; i < curves[k].points.size(); ++i) nodes.push_back(at_node(moments[k], i));
    const double turn = principal_turn(nodes);
    turn_about(curves[k], turn);
    std::vector<RigSection>& sections = body.sections.emplace_back();
    for (const Moments& m : nodes)
      sections.push_back(m.area > 0.0 ? ellipse(m, turn) : RigSection{0, 0, false});
    fill(sections, curves[k]);
    if (const auto& joint = curves[k].joint)
      blend_root(sections, curves[k], curves[joint->parent], body.sections[joint->parent]);
  }
  return body;
}

}  // namespace tendril::runner
