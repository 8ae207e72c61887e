#pragma once

#include <tendril/dynamics/couplings.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "access.h"
#include "dynamics/vector/columns.h"
#include "dynamics/vector/edge_angles.h"
#include "rigid_body.h"

namespace tendril {

class Tiles;

/// A scene on flat arrays. Arrays per edge have an entry per node; that of a rod's last node is not used, so
/// that edge i always joins the nodes i and i + 1.
struct System::Model {
  Model(Scene description, double since);
  Model() = default;  ///< empty: a part of a scene is put in afterwards (tiles.h)

  Scene scene;
  double from = 0.0;            ///< the time from which this holds
  std::vector<Anchor> anchors;  ///< those of the scene that have not let go by then
  std::vector<NodeRange> rods;
  std::vector<std::size_t> order;  ///< of the rods, parents before their children
  std::vector<std::size_t> seed;  ///< per rod, the node that its directors follow where it has no twist state
  std::vector<std::string> left_out;
  std::size_t nodes = 0;
  std::size_t twist_nodes = 0;
  std::vector<RigidBody> bodies;

  // Per node.
  std::vector<Vec3> rest_p;
  std::vector<Frame> rest_frame;
  std::vector<double> mass, inertia, bend_l, bend_m, bend_t;
  std::vector<double> damping;
  std::vector<double> moved_mass;               ///< mass with that of the roots merged into the node
  std::vector<Vec3> offset;                     ///< (0, r a, r b): q - p in the rest node frame
  std::vector<int> twist_index;                 ///< place among the twist states, -1 where left out
  std::vector<char> anchored;                   ///< named by an anchor of the scene
  std::vector<char> held_position, held_frame;  ///< by an anchor, or by riding on a parent
  std::vector<char> begins, ends;               ///< a rod
  Column inverse_mass;                          ///< of what moves with the node; 0 where it is held
  Column inverse_inertia;                       ///< 0 where the frame is held, and without twist
  Column free_inertia;                          ///< likewise
  Column damped_mass, damped_inertia;           ///< times the damping; 0 where held
  std::vector<std::size_t> held_positions;      ///< by node
  /// A node that an anchor holds on a line or a plane; it does not count as held.
  struct Slider {
    std::size_t node, anchor;
    Mat3 free;  ///< projects on what it may do
    /// The part of the pose's velocity that it has to follow.
    Vec3 carried(const AnchorPose& pose) const { return pose.velocity - free * pose.velocity; }
  };
  std::vector<Slider> sliders;
  /// A node with a held frame that turns freely about an axis, by theta and w.
  struct Swivel {
    std::size_t node, anchor;
    Vec3 axis;  ///< unit, in the frame's l, m, t
    Vec3 of(const Frame& frame) const { return axis.x() * frame.x + axis.y() * frame.y + axis.z() * frame.z; }
  };
  std::vector<Swivel> swivels;
  const Swivel* swivel_of(std::size_t node) const {
    const auto at =
        std::find_if(swivels.begin(), swivels.end(), [&](const Swivel& s) { return s.node == node; });
    return at == swivels.end() ? nullptr : &*at;
  }
  bool swivels_in(const NodeRange& rod) const {
    return std::any_of(swivels.begin(), swivels.end(),
                       [&](const Swivel& s) { return s.node - rod.first < rod.count; });
  }
  const Slider* slider_of(std::size_t node) const {
    const auto at =
        std::find_if(sliders.begin(), sliders.end(), [&](const Slider& s) { return s.node == node; });
    return at == sliders.end() ? nullptr : &*at;
  }
  /// Held nodes, but for those that pass what they feel to the node they are attached to.
  std::vector<std::size_t> driven_positions, driven_frames;
  bool driven = false;  ///< there are such, slides or swivels

  /// A child's root: what it is attached to, and its rest frame in its parent's (coordinates of l, m, t).
  struct Attachment {
    std::size_t root, parent;  ///< flat nodes
    Frame rest;
    bool reaction;
  };
  std::vector<int> attachment_index;    ///< per rod, into attachments, -1 for a rod on its own
  std::vector<Attachment> attachments;  ///< parents before their children
  /// A node at which rods are joined, whose half edges bend as those of one rod do. Its tangent halves the
  /// angle between the rod's own two edges; in truth it turns on by omega, across the tangent, until the
  /// moments of all rods there are in balance: omega = give T, T the moment of the children's first springs.
  struct Hub {
    std::size_t node;  ///< that carries the roots
    /// A child's root. Of its first edge against the frame: the turns towards l and m, and the twist.
    struct Child {
      std::size_t root, rod;
      Eigen::Matrix<double, 2, 3> moment;  ///< T by (l, m, twist)
      Eigen::Matrix<double, 3, 2> turn;    ///< (l, m, twist) by omega
    };
    std::vector<Child> children;
    Eigen::Matrix2d give;  ///< omega by T: the inverse of all springs there
  };
  std::vector<Hub> hubs;
  std::size_t hub_children = 0;  ///< of all
  /// Per node: the node that its place and frame move with (itself where it is attached to none), and whether
  /// that one feels it. Then the same for the places and turns of the bodies, which are attached to nothing.
  std::vector<std::size_t> carrier;
  std::vector<char> feels;

  /// Neighbouring rods with the same kind of springs, as one range of nodes [first, end).
  struct Segment {
    std::size_t first, end;
    bool twist;     ///< has the twist state
    bool third;     ///< has springs on the angle to the tangent
    bool straight;  ///< at rest
    bool viscous;   ///< some spring resists

    bool operator==(const Segment&) const = default;
  };
  std::vector<Segment> segments;

  /// The bending springs once more, as loops over nodes read them. At a free node with two edges a and b the
  /// tangent halves the angle between them: in its frame b deviates by as much as a does, the other way.
  /// Springs and rest angles are those of b; where there are not two edges, or the frame is held, all are 0.
  struct Bending {
    Column k_l, k_m, k_t, rest_l, rest_m, rest_t;
    Column hinge;                          ///< of a rod without twist
    std::vector<std::size_t> held_hinges;  ///< nodes with a held frame of rods without twist
    std::vector<std::size_t> held;         ///< nodes with a held frame of rods with twist
    std::vector<int> held_child;           ///< of these, the place among the hubs' children, or -1
  };
  Bending bending;

  Vec3 gravity = Vec3::Zero();  ///< of all forces that are one acceleration of every mass
  /// The others, in the scene's order.
  struct Acting {
    const Force* force;
    std::size_t index;  ///< in the scene
    bool has_energy;
    bool refuses;
    Couplings couplings;

    bool by_differences() const { return couplings.any() && !couplings.derivatives(); }
    bool varies() const { return static_cast<bool>(couplings.local()); }
  };
  std::vector<Acting> acting;
  bool loaded = false;          ///< there are such
  bool acts_on_frames = false;  ///< some of them does
  bool damped = false;          ///< some rod has mass damping

  std::shared_ptr<const Tiles>
      tiles;  ///< of a large scene whose steps may be taken a part at a time; or null

  // Per edge, and per edge and end (2 i at node i, 2 i + 1 at node i + 1).
  std::vector<double> stretch, twist, width, viscosity, rest_length, rest_twist;
  std::vector<double> rest_l, rest_m, rest_t;

  bool has_twist(std::size_t node) const { return twist_index[node] >= 0; }
  bool holds_position(std::size_t node) const { return held_position[node] != 0; }
  bool holds_frame(std::size_t node) const { return held_frame[node] != 0; }
  /// Whether its angle and spin are free.
  bool turns(std::size_t node) const {
    return has_twist(node) && (!holds_frame(node) || swivel_of(node) != nullptr);
  }
  bool has_before(std::size_t node) const { return begins[node] == 0; }
  bool has_after(std::size_t node) const { return ends[node] == 0; }
  const Attachment* attachment_of(std::size_t rod) const {
    return attachment_index[rod] < 0 ? nullptr
                                     : &attachments[static_cast<std::size_t>(attachment_index[rod])];
  }

  /// Flat indices of nodes, and of the places and turns of bodies.
  std::size_t index_count() const { return nodes + 2 * bodies.size(); }

  /// Where the three numbers of a flat index stand in y, and their rates.
  Eigen::Index offset_of(std::size_t index) const {
    if (index < nodes) return 3 * static_cast<Eigen::Index>(index);
    const auto k = static_cast<Eigen::Index>(index - nodes);
    return x_begin() + (k % 2) * bodies_span() + 3 * (k / 2);
  }
  Eigen::Index rate_offset_of(std::size_t index) const {
    return offset_of(index) + (index < nodes ? v_begin() : 2 * bodies_span());
  }
  bool moves(std::size_t index) const { return index >= nodes || !holds_position(index); }

  /// Per node, the number of its rod.
  std::vector<std::size_t> rods_of_nodes() const;

  // Where the parts of y begin.
  Eigen::Index v_begin() const { return 3 * static_cast<Eigen::Index>(nodes); }
  Eigen::Index theta_begin() const { return 6 * static_cast<Eigen::Index>(nodes); }
  Eigen::Index spin_begin() const { return theta_begin() + static_cast<Eigen::Index>(twist_nodes); }
  Eigen::Index x_begin() const { return spin_begin() + static_cast<Eigen::Index>(twist_nodes); }
  Eigen::Index bodies_span() const { return 3 * static_cast<Eigen::Index>(bodies.size()); }
  Eigen::Index work_index() const { return x_begin() + 4 * bodies_span(); }
  Eigen::Index size() const { return work_index() + 1; }

 private:
  void flatten(const Rod& rod);
  void flatten_rest_angles(const NodeRange& range);
  void add_anchors();
  void add_joints();
  void sort_rods();
  void choose_twist();
  void choose_forces();
  Couplings couplings_of(std::size_t force) const;
  void lay_out_springs();
  void lay_out_bending(std::size_t node);
  void add_hubs();
  Hub empty_hub(std::size_t node) const;
  std::string twist_source(std::size_t rod) const;
};

/// What a force remembers at a state, for its view.
inline const ForceMemory* memory_of(const Model::Acting& acting, const State& state) {
  return acting.index < state.memory.size() ? state.memory[acting.index].get() : nullptr;
}

/// The name of a flat index in what is refused: "rod 0 node 3", "body 1".
std::string name_of_index(const Model& model, std::size_t index);

/// The name of a force of the scene in what is refused.
std::string name_of_force(std::size_t index);

/// The angles of a unit edge against a node frame.
EdgeAngles edge_angles(const Vec3& e, const Frame& frame);

/// Signed angle about `after.z` from before.y, carried to after.z by the smallest rotation, to after.y; in
/// (-pi, pi].
double twist_angle(const Frame& before, const Frame& after);

}  // namespace tendril
