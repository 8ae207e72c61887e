#pragma once

#include <vector>

#include "dynamics/linear/block_matrix.h"
#include "dynamics/scene/model.h"
#include "dynamics/stiffness/spring_stiffness.h"

namespace tendril {

/// What free bodies are in the linear equations of an implicit step, each with a pivot for its place and one
/// for its turn: the inertia tensor, which turns with the body, and the gyroscopic torque. About a state that
/// is its own reference
///
///     phi' = omega + 1/2 omega x phi,   I(phi) omega' = T - omega x I(phi) omega,
///     dI v = phi x (I v) - I (phi x v).
template <int B>
class BodyBlocks {
 public:
  /// \param model, pattern  kept by reference
  BodyBlocks(const Model& model, const BlockPattern& pattern) : model_(model), pattern_(pattern) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      One one{model.nodes + 2 * b + 1, model.offset_of(model.nodes + 2 * b + 1), {}};
      const std::size_t own = pattern.pivot(one.turn);
      one.rows.push_back(one.turn);
      for (std::size_t e = pattern.begin(own); e < pattern.begin(own + 1); ++e)
        one.rows.push_back(pattern.node(pattern.later(e)));
      for (const std::size_t e : pattern.earlier(own)) one.rows.push_back(pattern.node(pattern.low(e)));
      bodies_.push_back(std::move(one));
    }
  }

  /// Adds the derivatives of what turns the bodies beside their loads.
  /// \param at    the bodies
  /// \param rate  y' there
  void add(const std::vector<BodyView>& at, const Eigen::VectorXd& rate, BlockMatrix<B>& by_x,
           BlockMatrix<B>& by_u) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      One& one = bodies_[b];
      const RigidBody& body = model_.bodies[b];
      one.inertia = body.inertia_at(at[b].rotation);
      one.half_spin = 0.5 * cross_matrix(at[b].spin);
      if (body.isotropic) continue;
      const Vec3 spun = rate.segment<3>(model_.rate_offset_of(one.turn));
      const Mat3 spin = cross_matrix(at[b].spin);
      const Mat3 turned = one.inertia * spin - cross_matrix(one.inertia * at[b].spin);
      const Mat3 resisted = one.inertia * cross_matrix(spun) - cross_matrix(one.inertia * spun);
      by_x.find(one.turn, one.turn)->add(-spin * turned - resisted);
      by_u.find(one.turn, one.turn)->add(cross_matrix(one.inertia * at[b].spin) - spin * one.inertia);
    }
  }

  /// Adds s^2 I - s I C + F_u C, where C derives phi' by phi.
  void add_inertia(double s, const BlockMatrix<B>& by_u, BlockMatrix<B>& matrix) const {
    for (const One& one : bodies_) {
      matrix.find(one.turn, one.turn)->add(s * one.inertia * (s * Mat3::Identity() - one.half_spin));
      for (const std::size_t row : one.rows)
        multiply(*by_u.find(row, one.turn), one.half_spin, *matrix.find(row, one.turn));
    }
  }

  /// Their turns' right-hand sides, I (r_u + s r_x).
  void put_right(double s, const Eigen::VectorXd& r, double* b) const {
    for (const One& one : bodies_)
      Eigen::Map<Vec3>(b + 4 * pattern_.pivot(one.turn)) =
          one.inertia * (r.segment<3>(model_.rate_offset_of(one.turn)) + s * r.segment<3>(one.place));
  }

  /// Takes C U_x off the rates of the turns.
  void take_turning(const double* u, Eigen::VectorXd& result) const {
    for (const One& one : bodies_)
      result.segment<3>(model_.rate_offset_of(one.turn)) -=
          one.half_spin * Eigen::Map<const Vec3>(u + 4 * pattern_.pivot(one.turn));
  }

 private:
  using Block = typename BlockMatrix<B>::Block;
  struct One {
    std::size_t turn;               ///< flat index
    Eigen::Index place;             ///< of phi in y
    std::vector<std::size_t> rows;  ///< that its turn couples with, itself first
    Mat3 inertia = Mat3::Zero(), half_spin = Mat3::Zero();
  };

  /// to += from c, in the three columns.
  static void multiply(const Block& from, const Mat3& c, Block& to) {
    for (std::size_t column = 0; column < 3; ++column)
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t r = 0; r < 4; ++r)
          to.column[column][r] +=
              from.column[k][r] * c(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(column));
  }

  const Model& model_;
  const BlockPattern& pattern_;
  std::vector<One> bodies_;
};

}  // namespace tendril
