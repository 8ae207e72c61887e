#pragma once

#include <tendril/dynamics/system.h>

#include <vector>

namespace tendril {

/// A scene on flat arrays. Arrays per edge have an entry per node; that of a rod's last node is not used, so
/// that edge i always joins the nodes i and i + 1.
struct System::Model {
  explicit Model(Scene description);

  Scene scene;
  std::vector<NodeRange> rods;
  std::vector<std::size_t> order;  ///< of the rods, parents before their children
  std::vector<std::string> left_out;
  std::size_t nodes = 0;
  std::size_t twist_nodes = 0;

  // Per node.
  std::vector<Vec3> rest_p;
  std::vector<Frame> rest_frame;
  std::vector<double> mass, inertia, bend_l, bend_m, bend_t, damping;
  std::vector<double> moved_mass;               ///< mass with that of the roots merged into the node
  std::vector<Vec3> offset;                     ///< (0, r a, r b): q - p in the rest node frame
  std::vector<int> twist_index;                 ///< place among the twist states, -1 where left out
  std::vector<int> anchor_index;                ///< into scene.anchors, -1 where there is none
  std::vector<char> held_position, held_frame;  ///< by an anchor, or by riding on a parent

  /// A child's root: where it rides, and its rest frame in its parent's (coordinates of l, m, t).
  struct Ride {
    std::size_t parent;  ///< flat node
    Frame rest;
    bool reaction;
  };
  std::vector<int> ride_index;  ///< per rod, into rides, -1 for a rod on its own
  std::vector<Ride> rides;

  // Per edge, and per edge and end (2 i at node i, 2 i + 1 at node i + 1).
  std::vector<double> stretch, twist, width, viscosity, rest_length, rest_twist;
  std::vector<double> rest_l, rest_m, rest_t;

  bool has_twist(std::size_t node) const { return twist_index[node] >= 0; }
  bool holds_position(std::size_t node) const { return held_position[node] != 0; }
  bool holds_frame(std::size_t node) const { return held_frame[node] != 0; }
  const Ride* ride_of(std::size_t rod) const {
    return ride_index[rod] < 0 ? nullptr : &rides[static_cast<std::size_t>(ride_index[rod])];
  }

  // Where the parts of y begin.
  Eigen::Index v_begin() const { return 3 * static_cast<Eigen::Index>(nodes); }
  Eigen::Index theta_begin() const { return 6 * static_cast<Eigen::Index>(nodes); }
  Eigen::Index spin_begin() const { return theta_begin() + static_cast<Eigen::Index>(twist_nodes); }
  Eigen::Index work_index() const { return spin_begin() + static_cast<Eigen::Index>(twist_nodes); }
  Eigen::Index size() const { return work_index() + 1; }

 private:
  void flatten(const Rod& rod);
  void flatten_rest_angles(const NodeRange& range);
  void place_anchors();
  void place_joints();
  void sort_rods();
  void choose_twist();
  std::string twist_source(std::size_t rod) const;
};

/// Angles of a unit edge against a node frame, as the bending springs see them.
struct EdgeAngles {
  double x, y, z;  ///< e.l, e.m, e.t
  double cl, cm,
      st;  ///< cosines of the two deviations, sine of the angle to t; from components, never from 1 - x^2
  double l, m, t;  ///< asin(x), asin(y), angle to t
};
EdgeAngles edge_angles(const Vec3& e, const Frame& frame);

/// Signed angle about `after.z` from before.y, carried to after.z by the smallest rotation, to after.y; in
/// (-pi, pi].
double twist_angle(const Frame& before, const Frame& after);

}  // namespace tendril
