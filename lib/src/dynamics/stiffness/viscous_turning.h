#pragma once

#include <algorithm>
#include <vector>

#include "dynamics/rhs/kinematics.h"
#include "stiffness_elements.h"
#include "viscous_pack.h"

namespace tendril {

/// The derivative of the viscous forces by the coordinates at fixed velocities, as far as it is not that of
/// the slopes (edge_stiffness counts those): a spring resists with -k beta q' grad q, and q' = grad q . x'
/// changes as the rod turns. Left out, implicit steps of stiff viscous rods are drawn off the solution:
/// hundreds of times as many are needed. How fast grad q turns is taken by a central difference along the
/// motion.
class ViscousTurning {
 public:
  explicit ViscousTurning(const Model& model) : model_(model) {
    for (auto& slopes : slopes_) slopes.resize(model.nodes);
  }

  /// Adds it to a sink, minus sign included.
  /// \param rate  y' at the state
  /// \param kin   its kinematics with all rates, and so again after it
  /// \return  why the equations fail at the state or beside it
  template <class Sink>
  Evaluation add(const State& state, const Eigen::VectorXd& rate, Kinematics& kin, Sink& sink) {
    assert(kin.has_rates() && kin.has_frames());
    const double step = turning_step(kin);
    for (const std::size_t side : {0, 1})
      if (const Evaluation e = take(state, rate, side == 0 ? -step : step, kin, side); !e.ok()) return e;
    if (const Evaluation e = kinematics(model_, state, state.time, state.y, Motion::all, kin); !e.ok())
      return e;
    const auto one = [&](const NodeRange& rod, std::size_t i) {
      EdgeSlopes& rates = slopes_[1][i];
      differentiate(slopes_[0][i], 2 * step, rates);
      edge_slopes(model_, rod, i, state, kin, slopes_[0][i]);
      turned_resistance(model_, rod, i, slopes_[0][i], rates, turned_);
      visit(turned_, -model_.viscosity[i], sink);
      const Mat3 pull = turned_pull(model_, i, kin);
      for (const std::size_t row : {i, i + 1})
        for (const std::size_t column : {i, i + 1})
          if (model_.feels[row])
            sink.block(model_.carrier[row], model_.carrier[column], row == column ? Mat3(-pull) : pull);
    };
    for_edges(one, [&](std::size_t i, std::size_t skip, std::size_t k) {
      edge_slopes(i, state, kin, here_);
      turned_resistance(model_, i, kin, here_, packs_[0][k], packs_[1][k], 2 * step, pack_);
      visit(model_, pack_, i, skip, sink);
    });
    return {};
  }

 private:
  /// Calls one(rod, i) and pack(i, skip, k) for what resists, see for_packs; k counts packs.
  template <class One, class InPack>
  void for_edges(const One& one, const InPack& pack) const {
    std::size_t k = 0;
    for (const NodeRange& rod : model_.rods) {
      if (!(model_.viscosity[rod.first] > 0.0)) continue;
      for_packs(
          model_, rod, [&](std::size_t i) { one(rod, i); },
          [&](std::size_t i, std::size_t skip) { pack(i, skip, k++); });
    }
  }

  /// Slopes a little earlier or later.
  Evaluation take(const State& state, const Eigen::VectorXd& rate, double h, Kinematics& kin,
                  std::size_t side) {
    const Eigen::Index n3 = model_.v_begin();
    const auto m = static_cast<Eigen::Index>(model_.twist_nodes);
    moved_ = state.y;
    moved_.head(n3) += h * rate.head(n3);
    moved_.segment(model_.theta_begin(), m) += h * rate.segment(model_.theta_begin(), m);
    const Evaluation at = kinematics(model_, state, state.time + h, moved_, Motion::positions, kin);
    if (!at.ok()) return at;
    for_edges([&](const NodeRange& rod,
                  std::size_t i) { edge_slopes(model_, rod, i, state, kin, slopes_[side][i]); },
              [&](std::size_t i, std::size_t, std::size_t k) {
                if (k == packs_[side].size()) packs_[side].emplace_back();
                edge_slopes(i, state, kin, packs_[side][k]);
              });
    return at;
  }

  /// (later - before) / time, into later.
  static void differentiate(const EdgeSlopes& before, double time, EdgeSlopes& later) {
    for (std::size_t q = 0; q < EdgeSlopes::kSprings; ++q) {
      for (std::size_t a = 0; a < 5; ++a) later.node[q][a] = (later.node[q][a] - before.node[q][a]) / time;
      for (std::size_t a = 0; a < 2; ++a) later.angle[q][a] = (later.angle[q][a] - before.angle[q][a]) / time;
    }
  }

  /// In which nothing turns by more than 1e-5. The bound matters where next to nothing turns.
  double turning_step(const Kinematics& kin) const {
    double fastest = 1e-2;
    for (std::size_t i = 0; i < model_.nodes; ++i)
      fastest = std::max({fastest, Vec3(kin.rate.e_rate[i]).norm(), Vec3(kin.rate.turning[i]).norm(),
                          std::abs(kin.spin[i])});
    return 1e-5 / fastest;
  }

  const Model& model_;
  Eigen::VectorXd moved_;
  std::vector<EdgeSlopes> slopes_[2];  ///< by the first node of the edge
  TurnedResistance turned_;
  std::vector<SlopePack> packs_[2];
  SlopePack here_;
  EdgePack pack_;
};

}  // namespace tendril
