#include "jacobian.h"

#include <algorithm>
#include <cmath>

#include "edge_stiffness.h"
#include "elastic.h"

namespace tendril {
namespace {

constexpr std::size_t kColours = 7;  // nodes this far apart share no force

bool needs_differences(const System::Model& model) {
  if (model.twist_nodes > 0) return true;
  for (const auto& force : model.scene.forces)
    if (force->depends_on_state()) return true;
  return false;
}

bool depends_on_time(const System::Model& model) {
  for (const Anchor& anchor : model.scene.anchors)
    if (anchor.motion) return true;
  for (const auto& force : model.scene.forces)
    if (force->depends_on_time()) return true;
  return false;
}

/// Place among the coordinates of each of n positions and m angles, -1 where held.
std::vector<Eigen::Index> slots(const System::Model& model, const ChainCoordinates& c) {
  std::vector<Eigen::Index> slot(3 * model.nodes + model.twist_nodes, -1);
  for (Eigen::Index k = 0; k < c.size(); ++k) {
    const Eigen::Index place = c.x[static_cast<std::size_t>(k)];
    const Eigen::Index angle = place - model.theta_begin();
    slot[static_cast<std::size_t>(angle < 0 ? place : model.v_begin() + angle)] = k;
  }
  return slot;
}

/// Adds scale * block / mass to the rows of an edge's variables.
void add(const EdgeStiffness& block, const std::array<Eigen::Index, 14>& places,
         const std::vector<Eigen::Index>& slot, const ChainCoordinates& c, double scale, BandMatrix& to) {
  std::array<Eigen::Index, 14> at{};
  for (std::size_t k = 0; k < 14; ++k) at[k] = places[k] < 0 ? -1 : slot[static_cast<std::size_t>(places[k])];
  for (std::size_t row = 0; row < 14; ++row) {
    if (at[row] < 0) continue;
    const double share = scale / c.mass[static_cast<std::size_t>(at[row])];
    for (std::size_t column = 0; column < 14; ++column)
      if (at[column] >= 0 && to.inside(at[row], at[column]))
        to.at(at[row], at[column]) +=
            share * block(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
  }
}

/// Tangent of node i by p_{i-1}, p_i, p_{i+1}.
Eigen::Matrix<double, 3, 9> tangent_by_positions(const NodeRange& rod, std::size_t i,
                                                 const System::Workspace& work) {
  const auto projector = [](const Vec3& n) { return Mat3(Mat3::Identity() - n * n.transpose()); };
  Eigen::Matrix<double, 3, 9> q = Eigen::Matrix<double, 3, 9>::Zero();
  for (std::size_t side = 0; side < 2; ++side) {
    if (side == 0 ? i == rod.first : i + 1 == rod.first + rod.count) continue;
    const std::size_t edge = i + side - 1;
    const Mat3 by_edge =
        projector(work.frame[i].z) * projector(work.e[edge]) / (work.bisector[i] * work.length[edge]);
    q.block<3, 3>(0, static_cast<Eigen::Index>(3 * side)) -= by_edge;
    q.block<3, 3>(0, static_cast<Eigen::Index>(3 * side + 3)) += by_edge;
  }
  return q;
}

/// The Hessian is that of E(p, theta), whose directors are carried along; the forces are its gradient with
/// directors that do not spin. At the reference the two agree, but not their derivatives: what is between
/// them is -1/2 dE/ds (t x dt).(dt'), antisymmetric.
void add_carrying(const System::Model& model, const NodeRange& rod, const std::vector<Eigen::Index>& slot,
                  const ChainCoordinates& c, const System::Workspace& work, BandMatrix& to) {
  for (std::size_t i = rod.first; i < rod.first + rod.count; ++i) {
    if (!model.has_twist(i) || model.holds_frame(i)) continue;
    const Eigen::Matrix<double, 3, 9> q = tangent_by_positions(rod, i, work);
    const Vec3& t = work.frame[i].z;
    Mat3 cross;
    cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
    const Eigen::Matrix<double, 9, 9> block = -0.5 * work.g_spin[i] * q.transpose() * cross * q;
    const auto slot_of = [&](Eigen::Index k) -> Eigen::Index {
      const Eigen::Index place = 3 * (static_cast<Eigen::Index>(i) - 1) + k;
      const bool there = place >= 0 && place < model.v_begin();
      return there ? slot[static_cast<std::size_t>(place)] : -1;
    };
    for (Eigen::Index row = 0; row < 9; ++row)
      for (Eigen::Index column = 0; column < 9; ++column) {
        if (block(row, column) == 0.0 || slot_of(row) < 0 || slot_of(column) < 0) continue;
        to.at(slot_of(row), slot_of(column)) +=
            block(row, column) / c.mass[static_cast<std::size_t>(slot_of(row))];
      }
  }
}

void add_springs(const System::Model& model, const ChainCoordinates& c, const State& state,
                 System::Workspace& work, ChainJacobian& jacobian) {
  const std::vector<Eigen::Index> slot = slots(model, c);
  for (const NodeRange& rod : model.rods) {
    add_carrying(model, rod, slot, c, work, jacobian.a_by_x);
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      const auto places = edge_places(model, rod, i);
      add(edge_stiffness(model, rod, i, state, work), places, slot, c, -1.0, jacobian.a_by_x);
      if (model.viscosity[i] > 0.0)
        add(edge_resistance(model, rod, i, work), places, slot, c, -model.viscosity[i], jacobian.a_by_u);
    }
  }
}

/// One group of columns: a kind of coordinate (0 to 2 an axis of p, 3 theta; then the same of the rates) at
/// the nodes of one colour, moved together.
class Differences {
 public:
  Differences(const System::Model& model, const ChainCoordinates& c, const State& state,
              System::Workspace& work)
      : model_(model), c_(c), state_(state), work_(work) {
    for (const Rod& rod : model.scene.rods) {
      for (std::size_t i = 0; i + 1 < rod.p.size(); ++i)
        length_ = std::max(length_, (rod.p[i + 1] - rod.p[i]).norm());
    }
    const auto n = static_cast<Eigen::Index>(model.nodes);
    speed_ = std::max(state.y.segment(3 * n, 3 * n).cwiseAbs().maxCoeff(), length_);
  }

  bool start() {
    ++evaluations;
    return rates(model_, state_, state_.time, state_.y, false, base_, work_).ok();
  }

  bool column_group(std::size_t colour, std::size_t kind, ChainJacobian& jacobian) {
    const bool rate = kind >= 4;
    const bool angle = kind % 4 == 3;
    const double step = 1e-7 * (angle ? (rate ? speed_ / length_ : 1.0) : (rate ? speed_ : length_));
    Eigen::VectorXd y = state_.y;
    moved_.assign(model_.nodes, -1);
    bool any = false;
    for (const NodeRange& rod : model_.rods)
      for (std::size_t i = colour; i < rod.count; i += kColours) {
        const Eigen::Index k = coordinate(rod.first + i, kind % 4);
        if (k < 0) continue;
        any = true;
        y[(rate ? c_.u : c_.x)[static_cast<std::size_t>(k)]] += step;
        const std::size_t low = i > 3 ? i - 3 : 0;
        for (std::size_t j = low; j <= std::min(i + 3, rod.count - 1); ++j) moved_[rod.first + j] = k;
      }
    if (!any) return true;
    ++evaluations;
    if (!rates(model_, state_, state_.time, y, false, dy_, work_).ok()) return false;
    for (Eigen::Index row = 0; row < c_.size(); ++row) {
      const auto r = static_cast<std::size_t>(row);
      const Eigen::Index column = moved_[c_.node[r]];
      if (column < 0) continue;
      (rate ? jacobian.a_by_u : jacobian.a_by_x).at(row, column) += (dy_[c_.u[r]] - base_[c_.u[r]]) / step;
      if (!rate && jacobian.connected)
        jacobian.c_by_x.at(row, column) += (dy_[c_.x[r]] - base_[c_.x[r]]) / step;
    }
    return true;
  }

  long evaluations = 0;

 private:
  Eigen::Index coordinate(std::size_t node, std::size_t kind) const {
    for (Eigen::Index k = c_.first[node]; k < c_.first[node + 1]; ++k) {
      const Eigen::Index place = c_.x[static_cast<std::size_t>(k)];
      const bool angle = place >= model_.theta_begin();
      if (angle ? kind == 3 : place == 3 * static_cast<Eigen::Index>(node) + static_cast<Eigen::Index>(kind))
        return k;
    }
    return -1;
  }

  const System::Model& model_;
  const ChainCoordinates& c_;
  const State& state_;
  System::Workspace& work_;
  Eigen::VectorXd base_, dy_;
  std::vector<Eigen::Index> moved_;  ///< per node, the moved coordinate it may feel, or -1
  double length_ = 0.0, speed_ = 0.0;
};

}  // namespace

ChainCoordinates::ChainCoordinates(const System::Model& model) {
  for (std::size_t i = 0; i < model.nodes; ++i) {
    first.push_back(static_cast<Eigen::Index>(x.size()));
    const auto at = 3 * static_cast<Eigen::Index>(i);
    for (int axis = 0; axis < 3 && !model.holds_position(i); ++axis) {
      x.push_back(at + axis);
      u.push_back(model.v_begin() + at + axis);
      mass.push_back(model.moved_mass[i]);
      node.push_back(i);
    }
    if (!model.has_twist(i) || model.holds_frame(i)) continue;
    x.push_back(model.theta_begin() + model.twist_index[i]);
    u.push_back(model.spin_begin() + model.twist_index[i]);
    mass.push_back(model.inertia[i]);
    node.push_back(i);
  }
  first.push_back(static_cast<Eigen::Index>(x.size()));
  // Without twist a node feels its second neighbour (a hinge), with twist its third.
  half = model.twist_nodes > 0 ? 4 * 3 + 3 : 3 * 2 + 2;
}

ChainJacobian::ChainJacobian(const ChainCoordinates& c, bool twist)
    : a_by_x(c.size(), c.half),
      a_by_u(c.size(), c.half),
      c_by_x(twist ? c.size() : 0, twist ? c.half : 0),
      connected(twist) {}

long differentiate(const System& system, const ChainCoordinates& coordinates, const State& state,
                   const Eigen::VectorXd& rate, System::Workspace& work, ChainJacobian& jacobian) {
  const System::Model& model = system.model();
  for (BandMatrix* m : {&jacobian.a_by_x, &jacobian.a_by_u, &jacobian.c_by_x}) m->set_zero();
  double energy = 0.0;
  Eigen::VectorXd gradient;
  if (!system.elastic_gradient(state, state.time, state.y, energy, gradient, work).ok()) return -1;
  add_springs(model, coordinates, state, work, jacobian);

  long evaluations = 1;
  if (needs_differences(model)) {
    Differences differences(model, coordinates, state, work);
    if (!differences.start()) return -1;
    for (std::size_t colour = 0; colour < kColours; ++colour)
      for (std::size_t kind = 0; kind < 8; ++kind)
        if (!differences.column_group(colour, kind, jacobian)) return -1;
    evaluations += differences.evaluations;
  } else {
    for (Eigen::Index k = 0; k < coordinates.size(); ++k)
      jacobian.a_by_u.at(k, k) -= model.damping[coordinates.node[static_cast<std::size_t>(k)]];
  }
  jacobian.by_time.resize(0);
  if (depends_on_time(model)) {
    const double step = 1e-7 * std::max(1e-3, std::abs(state.time));
    if (!system.derivative(state, state.time + step, state.y, jacobian.by_time, work).ok()) return -1;
    jacobian.by_time = (jacobian.by_time - rate) / step;
    ++evaluations;
  }
  return evaluations;
}

}  // namespace tendril
