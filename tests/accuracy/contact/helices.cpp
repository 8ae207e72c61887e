#include <tendril/contact/rod_rod_contact.h>

#include "accuracy/contact/cases.h"
#include "accuracy/contact/runs.h"
#include "support/numbers.h"
#include "support/rods.h"

/// Rods that lie in helices: within a tube, and about each other.
namespace tendril::contact {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
using tendril::test::kPi;

/// A helix of radius 1 about z: the angle of its tangent with z, and where it is and goes at an arc length.
struct Helix {
  double angle, phase = 0.0;

  Vec3 at(double s) const {
    const double turn = phase + s * std::sin(angle);
    return {std::cos(turn), std::sin(turn), s * std::cos(angle)};
  }
  Frame frame(double s) const {
    const double turn = phase + s * std::sin(angle);
    const Vec3 t(-std::sin(turn) * std::sin(angle), std::cos(turn) * std::sin(angle), std::cos(angle));
    const Vec3 m(std::cos(turn), std::sin(turn), 0);
    return {m.cross(t), m, t};
  }
};

/// What a rod in a tube bears, pressed into a helix of three quarters of a turn: its end's force along the
/// axis, F r^2 / B, and that of the tube a length, N r^3 / B, in its middle half. Its ends hold each other
/// by a torque about the axis, which should be 0.
struct InTube {
  double force, push, torque;
};
InTube in_tube(const Helix& helix, int edges, double longer) {
  const double length = 1.5 * kPi / std::sin(helix.angle), radius = 0.02, range = 4e-3;
  std::vector<Vec3> p, q;
  for (int i = 0; i <= edges; ++i) {
    p.emplace_back(1, 0, (1.0 + longer) * (helix.at(length / edges) - helix.at(0)).norm() * i);
    q.push_back(p.back() + 0.1 * Vec3::UnitX());
  }
  const double inertia = kPi * std::pow(radius, 4) / 4;
  Rod rod = make_rod(p, q, {1.0 / inertia, 1.0 / inertia / 3, 1.0}, circular_section(radius));
  for (double& k : rod.twist) k *= 1e-6;
  Scene scene;
  scene.rods = {rod};
  for (const std::size_t node : {std::size_t{0}, static_cast<std::size_t>(edges)}) {
    Anchor end{.rod = 0, .node = node};
    // Where it rests at first, as a scene asks; the search begins with the helix.
    end.motion = [=](double t) {
      const double s = length * static_cast<double>(node) / edges;
      AnchorPose pose;
      pose.position = t < 1.0 ? p[node] : helix.at(s);
      pose.frame = t < 1.0 ? Frame{-Vec3::UnitY(), Vec3::UnitX(), Vec3::UnitZ()} : helix.frame(s);
      return pose;
    };
    scene.anchors.push_back(end);
  }
  Law law{.stiffness = 1.0, .range = range};
  law.stiffness = std::pow(std::sin(helix.angle), 4) / -potential(law, 0.5 * range).slope;
  const Collider solid{"tube", tube(1.0 + radius + 0.5 * range, kInfinite, kInfinite), {}};
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, p}},
                                               std::vector<Collider>{solid}, law)};
  const System system(scene);
  State start = system.rest_state();
  start.time = 1.0;
  for (int i = 0; i <= edges; ++i) start.y.segment<3>(3 * i) = helix.at(length * i / edges);
  const Equilibrium found = found_from(system, start, {.first_load = 1.0});
  InTube out{found.support[0].z(), 0.0, found.torque[0].z() + helix.at(0).cross(found.support[0]).z()};
  for (const Contact& c : memory_of(found.state).contacts) {
    const double at = static_cast<double>(c.node) + c.fraction + 0.5;
    if (at > 0.25 * edges && at < 0.75 * edges) out.push += c.force.norm() / (0.5 * length);
  }
  const double wide = found.state.y.segment<2>(3 * (edges / 2)).norm();
  out.force *= wide * wide;
  out.push *= wide * wide * wide;
  return out;
}

/// The same of a rod so long that its ends do not hold each other.
InTube free_in_tube(const Helix& helix, int edges) {
  double before = 0.0, longer = 2e-5;
  InTube at_before = in_tube(helix, edges, before), at = in_tube(helix, edges, longer);
  for (int k = 0; k < 6 && std::abs(at.torque) > 1e-8; ++k) {
    const double next = longer - at.torque * (longer - before) / (at.torque - at_before.torque);
    before = longer, at_before = at, longer = next;
    at = in_tube(helix, edges, longer);
  }
  require(std::abs(at.torque) < 1e-8, "a length without torque about the axis");
  return at;
}

/// Two rods that lie about each other: what each bears at an end, in all along the axis and about it, and the
/// moment about its tangent; and how they press on each other a length. Over B and powers of half their
/// distance.
struct Ply {
  double force, torque, twist, push;
  double radius;  ///< of their lines' helix, in their middle
  double bent;    ///< its angle there, less that between its first and second quarter
};
/// What one may choose of two rods whose ends lie on a helix.
struct Winding {
  double longer;   ///< by which share they are at rest than between their ends
  double turn;     ///< of the one end's frame against the other's, carried along
  double thicker;  ///< than what touches on a helix of radius 1
  double tilt;     ///< of the ends' tangents against the helix, towards z
};

/// The angle with z of a rod's line at a node, on a circular cylinder about z.
double angle_at(const Eigen::VectorXd& y, int node) {
  const Vec3 a = y.segment<3>(3 * (node - 1)), b = y.segment<3>(3 * (node + 1));
  const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.head<2>().dot(b.head<2>()));
  return std::atan2(0.5 * (a.head<2>().norm() + b.head<2>().norm()) * turn, b.z() - a.z());
}

Ply wound_ply(const Helix& helix, int edges, const Winding& winding) {
  // What is felt shrinks with the height of an arc over its edge: forces across it are not quite radial.
  const double length = 0.3 * kPi / std::sin(helix.angle), range = 0.5 / (edges * edges);
  // Edges touch with their middles.
  const double radius = std::cos(0.15 * kPi / edges) - 0.25 * range + winding.thicker;
  const double c = std::cos(helix.angle), s = std::sin(helix.angle);
  const double push = std::pow(s, 4) / std::cos(2 * helix.angle);
  Scene scene;
  std::vector<ContactRod> rods;
  std::array<Helix, 2> helices{helix, {helix.angle, kPi}};
  for (std::size_t r = 0; r < 2; ++r) {
    std::vector<Vec3> p, q;
    for (int i = 0; i <= edges; ++i) {
      p.push_back(helices[r].at(0) + (1.0 + winding.longer) *
                                         (helix.at(length / edges) - helix.at(0)).norm() * i * Vec3::UnitZ());
      q.push_back(p.back() + 0.1 * helices[r].at(0));
    }
    const double inertia = kPi / 4;
    Rod rod = make_rod(p, q, {1.0 / inertia, 1.0 / inertia / 3, 1.0}, circular_section(1.0));
    for (double& k : rod.stretch) k *= 1e4;
    for (double& k : rod.twist) k *= 100.0;
    scene.rods.push_back(rod);
    rods.push_back({r, radius, p});
    for (const std::size_t node : {std::size_t{0}, static_cast<std::size_t>(edges)}) {
      Anchor end{.rod = r, .node = node};
      end.motion = [=, at = helices[r]](double t) {
        const double way = length * static_cast<double>(node) / edges;
        AnchorPose pose;
        pose.position = t < 1.0 ? p[node] : at.at(way);
        pose.frame = at.frame(way);
        pose.frame.z = rotate_about(pose.frame.y, winding.tilt, pose.frame.z);
        // Radial directors turn against those that are carried along by the torsion, s c.
        const double by = -way * s * c + (node > 0 ? winding.turn : 0.0);
        pose.frame.y = rotate_about(pose.frame.z, by, pose.frame.y);
        if (t < 1.0) pose.frame.z = Vec3::UnitZ(), pose.frame.y = at.at(0);
        pose.frame.x = pose.frame.y.cross(pose.frame.z);
        return pose;
      };
      scene.anchors.push_back(end);
    }
  }
  Law law{.stiffness = 1.0, .range = range};
  law.stiffness = push / -potential(law, 0.5 * range).slope;
  scene.forces = {std::make_shared<RodRodContact>(rods, std::vector<RodJoint>{}, law)};
  const System system(scene);
  State start = system.rest_state();
  start.time = 1.0;
  const auto nodes = static_cast<Eigen::Index>(edges) + 1;
  for (Eigen::Index r = 0; r < 2; ++r)
    for (Eigen::Index i = 0; i < nodes; ++i)
      start.y.segment<3>(3 * (r * nodes + i)) =
          helices[static_cast<std::size_t>(r)].at(length * static_cast<double>(i) / edges);
  // Directors carried from where they rest turn against those that are carried along, by the area between.
  for (Eigen::Index i = 0; i < 2 * nodes; ++i)
    start.y[12 * nodes + i] = (1.0 - c) * s * length * static_cast<double>(i % nodes) / edges;
  const Equilibrium found = found_from(system, start, {.first_load = 1.0});
  const Vec3 tangent = helix.frame(0).z;
  Ply out{found.support[0].z(),
          found.torque[0].z() + helix.at(0).cross(found.support[0]).z(),
          found.torque[0].dot(tangent),
          0.0,
          found.state.y.segment<2>(3 * (edges / 2)).norm(),
          angle_at(found.state.y, edges / 2) - angle_at(found.state.y, edges / 4)};
  const auto& memory = dynamic_cast<const RodRodMemory&>(*found.state.memory.at(0));
  for (const RodTouch& touch : memory.touches) {
    const double at = static_cast<double>(touch.node[0]) + touch.fraction[0];
    if (at >= 0.375 * edges && at < 0.625 * edges)
      out.push += std::hypot(touch.force.x(), touch.force.y()) / (0.25 * length);
  }
  return out;
}

/// The same where no end bears a force along the axis or a torque about it, and all lies on one helix. For
/// that the ends' frames lean a little: their first edges, chords of the helix, would else be bent.
Ply balanced_ply(const Helix& helix, int edges) {
  const Eigen::Vector4d unit(1e-5, 1e-3, 1e-5, 1e-3);
  const auto ply = [&](const Eigen::Vector4d& x) {
    const Eigen::Vector4d at = x.cwiseProduct(unit);
    return wound_ply(helix, edges, {at[0], at[1], at[2], at[3]});
  };
  const auto off = [](const Ply& at) {
    return Eigen::Vector4d(at.force, at.torque, at.radius - 1.0, at.bent);
  };
  Eigen::Vector4d x(-0.3, -12.25, -0.3, 0.0);
  Ply at = ply(x);
  Eigen::Matrix4d by;
  for (Eigen::Index i = 0; i < 4; ++i) by.col(i) = off(ply(x + Eigen::Matrix4d::Identity().col(i))) - off(at);
  const Eigen::PartialPivLU<Eigen::Matrix4d> solver(by);
  for (int k = 0; k < 12 && off(at).norm() > 1e-6; ++k) {
    x -= solver.solve(off(at));
    at = ply(x);
  }
  require(off(at).norm() < 1e-6, "a ply that nothing pulls or turns");
  return at;
}

}  // namespace

Case helix_in_a_tube() {
  Case out{"K7", "Helix in a frictionless tube",
           "clearance r, angle theta: F r^2 / B = 2 sin^2(theta) cos(theta), N r^3 / B = sin^4(theta); 20 "
           "degrees, three quarters of a turn"};
  const Helix helix{20 * kPi / 180};
  Quantity force{"F r^2 / B", 0.219846, "relative"}, push{"N r^3 / B", 0.0136838, "relative"};
  for (const int edges : {16, 32, 64}) {
    const InTube found = free_in_tube(helix, edges);
    force.rows.push_back(relative(edges, found.force, force.reference));
    push.rows.push_back(relative(edges, found.push, push.reference));
  }
  force.limits = push.limits = {{64, 1e-3}};
  force.order = push.order = Order{2.0, 0.2, 32};
  out.quantities = {force, push};
  return out;
}

Case two_ply() {
  Case out{"K8", "Balanced two-ply",
           "p r^3 / B = sin^4(theta) / cos(2 theta), M3 r / B = 2 sin^3(theta) cos(theta) / cos(2 theta); 30 "
           "degrees"};
  const Helix helix{30 * kPi / 180};
  Quantity push{"p r^3 / B", 0.125, "relative"}, twist{"M3 r / B", 0.433013, "relative"};
  for (const int edges : {32, 64, 128}) {
    const Ply found = balanced_ply(helix, edges);
    push.rows.push_back(relative(edges, found.push, push.reference));
    twist.rows.push_back(relative(edges, found.twist, twist.reference));
  }
  push.limits = twist.limits = {{64, 1e-4}};
  push.order = twist.order = Order{2.2, 0.4, 64};
  out.quantities = {push, twist};
  return out;
}

}  // namespace tendril::contact
