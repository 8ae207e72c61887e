#pragma once

#include <Eigen/SparseCore>

#include <tendril/dynamics/system.h>

#include <string>

namespace tendril {

/// A node's three of the positions y.
inline Vec3 at(const Eigen::VectorXd& y, std::size_t node) {
  return y.segment<3>(3 * static_cast<Eigen::Index>(node));
}

/// The free coordinates of a system at rest, node by node (p, then the turn about the tangent), children
/// before their parents and each rod from its tip to its root: elimination in this order makes no fill on
/// chains and trees.
class StaticCoordinates {
 public:
  explicit StaticCoordinates(const System& system);

  Eigen::Index size() const { return static_cast<Eigen::Index>(node_.size()); }
  std::size_t node(Eigen::Index k) const { return node_[static_cast<std::size_t>(k)]; }
  /// 0 to 2 for a position, along the node's own axes where it slides, else the world's; 3 for the turn.
  int axis(Eigen::Index k) const { return axis_[static_cast<std::size_t>(k)]; }
  /// Place in the gradient of System::elastic_gradient, and back (-1 where held).
  Eigen::Index in_gradient(Eigen::Index k) const { return in_gradient_[static_cast<std::size_t>(k)]; }
  Eigen::Index row_of(Eigen::Index in_gradient) const {
    return row_of_[static_cast<std::size_t>(in_gradient)];
  }
  Eigen::Index row(std::size_t node, int axis) const {
    return row_[4 * node + static_cast<std::size_t>(axis)];
  }

  /// The unit vectors, as columns, along which the positions of a sliding node count, the free ones first;
  /// null for other nodes.
  const Mat3* axes(std::size_t node) const {
    return slide_[node] < 0 ? nullptr : &slides_[static_cast<std::size_t>(slide_[node])].axes;
  }
  /// A vector at a node along one of the axes of its positions.
  double along(std::size_t node, int axis, const Vec3& v) const {
    const Mat3* own = axes(node);
    return own ? own->col(axis).dot(v) : v[axis];
  }
  /// An entry of a vector in the order of System::elastic_gradient.
  double in(const Eigen::VectorXd& gradient, Eigen::Index k) const {
    return axis(k) == 3 || !axes(node(k)) ? gradient[in_gradient(k)]
                                          : along(node(k), axis(k), at(gradient, node(k)));
  }
  /// A Hessian in that order, the positions of sliding nodes along their own axes.
  bool any_slides() const { return !slides_.empty(); }
  void turn_to_axes(Eigen::SparseMatrix<double>& hessian) const;
  /// The part of a vector at a node in which its position is held.
  Vec3 held(std::size_t node, const Vec3& v) const;

  bool holds_position(std::size_t node) const { return held_position_[node] != 0; }
  bool holds_frame(std::size_t node) const { return held_frame_[node] != 0; }
  const std::vector<std::size_t>& children_first() const { return rods_; }
  /// Per rod: the parent's node its root is attached to, or -1.
  std::ptrdiff_t parent_node(std::size_t rod) const { return parent_node_[rod]; }
  bool reacts(std::size_t rod) const { return reacts_[rod] != 0; }

  double length() const { return length_; }  ///< of the longest rod at rest
  double energy_scale() const { return energy_scale_; }
  const Eigen::VectorXd& weight() const { return weight_; }  ///< D of Stability

  /// Moves by x and on to `time`: edges are turned and stretched, not sheared, and what does not close
  /// between two held nodes is closed by small turns of the edges between them, not by strain. Frames are not
  /// renewed.
  void displace(State& state, const Eigen::VectorXd& x, double time) const;

  /// How much of what one step may do x does: turn an edge by half a radian, stretch it by 0.3 of its length,
  /// turn a node by one radian against the next.
  double reach(const State& state, const Eigen::VectorXd& x, double time) const;

  /// Largest position over the length, or angle.
  double norm(const Eigen::VectorXd& x) const;

  /// Puts velocities and spins to 0.
  void stop(State& state) const;

  /// "rod 1 node 3"
  std::string name_of(std::size_t node) const;

 private:
  void hold();
  void sort_rods();
  void number();
  void measure();
  Eigen::VectorXd moves(const State& state, const Eigen::VectorXd& x, double time) const;
  double turn_of(std::size_t node, const Eigen::VectorXd& x) const;
  void thread(State& state, const NodeRange& rod, const Eigen::VectorXd& move) const;
  Vec3 shared(const State& state, std::size_t from, std::size_t to, const Vec3& miss, double soft) const;
  void turn_to_close(State& state, std::size_t from, std::size_t to, const Vec3& miss, double turn) const;
  void close(State& state, std::size_t from, std::size_t to, const Vec3& target, double turn) const;

  const System& system_;
  std::vector<std::size_t> node_;
  std::vector<int> axis_;
  std::vector<Eigen::Index> in_gradient_, row_of_, row_;
  std::vector<Eigen::Index> turn_in_y_;  ///< per node, or -1
  std::vector<char> held_position_, held_frame_, reacts_;
  std::vector<const Anchor*> anchor_;  ///< per node that one moves, or null
  struct Slide {
    Mat3 axes;
    int free;  ///< how many of them
  };
  std::vector<int> slide_;  ///< per node, into the slides, or -1
  std::vector<Slide> slides_;
  std::vector<std::size_t> rods_;
  std::vector<std::ptrdiff_t> parent_node_;
  double length_ = 0.0, energy_scale_ = 0.0;
  Eigen::VectorXd weight_;
};

}  // namespace tendril
