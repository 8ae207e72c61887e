#pragma once

#include <algorithm>
#include <vector>

#include "dynamics/linear/block_matrix.h"
#include "dynamics/rhs/rates.h"

namespace tendril {

/// Per node, those that share a row with it, itself first: all that a pattern has.
inline std::vector<std::vector<std::size_t>> neighbours_in(const BlockPattern& pattern) {
  std::vector<std::vector<std::size_t>> all(pattern.size());
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    all[pattern.node(k)].push_back(pattern.node(k));
    for (std::size_t e = pattern.begin(k); e < pattern.begin(k + 1); ++e) {
      all[pattern.node(k)].push_back(pattern.node(pattern.later(e)));
      all[pattern.node(pattern.later(e))].push_back(pattern.node(k));
    }
  }
  return all;
}

/// Derivatives of the external forces that do not give their own, by differences: groups of columns, a kind
/// of coordinate (an axis of p, an axis of v, the angle theta, the spin w) at the nodes of one colour, are
/// moved together, and with them an axis of the places, turns and motions of bodies. Nodes of one colour
/// share no row.
template <int B>
class Differences {
 public:
  /// \param neighbours  per node, those whose loads it moves, itself first; empty where it moves none
  Differences(const Model& model, std::vector<std::vector<std::size_t>> neighbours)
      : model_(model), kinds_(model.twist_nodes > 0 ? 8 : 6), neighbours_(std::move(neighbours)) {
    colour();
    for (std::size_t i = 0; i < model.nodes; ++i) length_ = std::max(length_, model.rest_length[i]);
    if (model.nodes == 0)
      for (const RigidBody& body : model.bodies) length_ = std::max(length_, body.size);
  }

  /// Adds to the two matrices.
  Evaluation add(const State& state, std::span<const Undifferentiated> forces, System::Workspace& work,
                 BlockMatrix<B>& by_x, BlockMatrix<B>& by_u) {
    const auto loads = [&](const Eigen::VectorXd& y, Eigen::VectorXd& out) {
      return undifferentiated_loads(model_, state, y, forces, out, work);
    };
    cost_ = 1;
    if (const Evaluation e = loads(state.y, base_); !e.ok()) return e;
    double speed = length_;
    for (std::size_t i = 0; i < model_.index_count(); ++i)
      if (!is_turn(i))
        speed = std::max(speed, state.y.segment<3>(model_.rate_offset_of(i)).cwiseAbs().maxCoeff());
    const auto step_of = [&](std::size_t i, std::size_t kind) {
      if (is_turn(i)) return 1e-7 * (kind < 3 ? 1.0 : speed / length_);
      return 1e-7 * (kind < 3 ? length_ : kind < 6 ? speed : kind == kAngle ? 1.0 : speed / length_);
    };
    for (const auto& nodes : coloured_)
      for (std::size_t kind = 0; kind < kinds_; ++kind) {
        moved_ = state.y;
        bool any = false;
        for (const std::size_t i : nodes) {
          const Eigen::Index place = offset_of(i, kind);
          any = any || place >= 0;
          if (place >= 0) moved_[place] += step_of(i, kind);
        }
        if (!any) continue;
        ++cost_;
        if (const Evaluation e = loads(moved_, dy_); !e.ok()) return e;
        dy_ -= base_;
        for (const std::size_t i : nodes)
          if (offset_of(i, kind) >= 0)
            take(i, kind, step_of(i, kind), kind < 3 || kind == kAngle ? by_x : by_u);
      }
    return {};
  }
  /// Evaluations that the last add() took.
  long cost() const { return cost_; }

 private:
  /// Greedily, in the order of the nodes: the least colour that no node two couplings away has.
  void colour() {
    std::vector<std::size_t> colours(model_.index_count(), kNone);
    std::vector<std::size_t> taken_by;
    for (std::size_t i = 0; i < model_.index_count(); ++i) {
      if (neighbours_[i].empty()) continue;
      taken_by.resize(std::max(taken_by.size(), coloured_.size()), kNone);
      for (const std::size_t j : neighbours_[i])
        for (const std::size_t k : neighbours_[j])
          if (colours[k] != kNone) taken_by[colours[k]] = i;
      std::size_t c = 0;
      while (c < coloured_.size() && taken_by[c] == i) ++c;
      if (c == coloured_.size()) coloured_.emplace_back();
      coloured_[c].push_back(i);
      colours[i] = c;
    }
  }

  /// Whether the numbers of an index are those of a body's turn.
  bool is_turn(std::size_t i) const { return i >= model_.nodes && (i - model_.nodes) % 2 == 1; }

  Eigen::Index offset_of(std::size_t i, std::size_t kind) const {
    const auto axis = static_cast<Eigen::Index>(kind % 3);
    if (kind < 6)
      return model_.moves(i) ? axis + (kind < 3 ? model_.offset_of(i) : model_.rate_offset_of(i)) : -1;
    if (i >= model_.nodes || !(model_.inverse_inertia[i] > 0.0)) return -1;
    return (kind == kAngle ? model_.theta_begin() : model_.spin_begin()) + model_.twist_index[i];
  }

  void take(std::size_t i, std::size_t kind, double step, BlockMatrix<B>& to) {
    const std::size_t column = kind < 6 ? kind % 3 : B - 1;
    for (const std::size_t row : neighbours_[i]) {
      auto* block = to.find(row, i);
      if (model_.moves(row))
        for (std::size_t r = 0; r < 3; ++r)
          block->column[column][r] += dy_[model_.rate_offset_of(row) + static_cast<Eigen::Index>(r)] / step;
      if (B == 4 && row < model_.nodes && model_.inverse_inertia[row] > 0.0)
        block->column[column][B - 1] += dy_[model_.spin_begin() + model_.twist_index[row]] / step;
    }
  }

  static constexpr std::size_t kAngle = 6;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  const Model& model_;
  std::size_t kinds_;
  double length_ = 0.0;
  std::vector<std::vector<std::size_t>> neighbours_;  ///< per node, itself first
  std::vector<std::vector<std::size_t>> coloured_;    ///< nodes of each colour
  Eigen::VectorXd base_, dy_, moved_;
  long cost_ = 0;
};

}  // namespace tendril
