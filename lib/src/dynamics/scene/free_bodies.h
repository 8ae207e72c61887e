#pragma once

#include <vector>

#include "model.h"

namespace tendril {

/// Rods joined so that each feels the other, or a rod on its own.
struct Tree {
  std::vector<std::size_t> nodes;  ///< ascending
  bool free;                       ///< nothing holds it in place
};
std::vector<Tree> trees_of(const Model& model);

/// Bodies that nothing holds in place. Springs cancel in the sum of a body's
/// equations of motion, so an implicit step's linear equations give the body's way exactly, by masses alone:
/// sum_k w_k U_k = sum_k b_k with w_k the diagonal of mass and damping. Elimination loses that where springs
/// are so stiff, or steps so long, that their blocks' rounding outweighs the masses; here it is put back.
///
/// Numbers are laid out four a pivot, of which the first three are a place.
class FreeBodies {
 public:
  /// \param node  of every pivot; those beyond the nodes are rigid bodies, and not looked at
  FreeBodies(const Model& model, const std::vector<std::size_t>& node);

  bool empty() const { return bodies_.empty(); }
  /// Sums the right-hand sides, before they take part in the solution.
  void keep(const double* b);
  /// Moves every body so that its sum is right.
  /// \param weight  w of a pivot's number
  template <class Weight>
  void restore(const Weight& weight, double* u) const {
    for (const Sum& body : bodies_) {
      double by = 0.0;
      Vec3 sum = Vec3::Zero();
      for (const std::size_t k : body.pivots) {
        by += weight(4 * k);
        for (std::size_t c = 0; c < 3; ++c) sum[static_cast<Eigen::Index>(c)] += weight(4 * k) * u[4 * k + c];
      }
      const Vec3 step = (body.sum - sum) / by;
      for (const std::size_t k : body.pivots)
        for (std::size_t c = 0; c < 3; ++c) u[4 * k + c] += step[static_cast<Eigen::Index>(c)];
    }
  }

 private:
  struct Sum {
    std::vector<std::size_t> pivots;
    Vec3 sum = Vec3::Zero();
  };
  std::vector<Sum> bodies_;
};

/// Whether there is any.
bool has_free_body(const Model& model);

}  // namespace tendril
