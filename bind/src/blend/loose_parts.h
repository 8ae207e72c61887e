#pragma once

#include <tendril/bind/bind_options.h>

#include <functional>

#include "branches.h"

namespace tendril::bind {

/// Connected parts of a body that sit beside the axes and enclose no stretch of them, as an iris or a
/// button does: they follow the limb they sit in or on whole, from one place of its axis.
///
/// A part is loose where it is not the only one and its points are nearer to its centre (the mean of its
/// faces, by area) than any curve is. Points at the same place count as joined. It follows the curve whose
/// distance from the centre, times the least factor at its points, is the least.
class LooseParts {
 public:
  /// The factor of Ways at a point of the body, for a curve.
  using FactorOf = std::function<double(std::uint32_t point, std::uint32_t pair)>;

  LooseParts() = default;
  LooseParts(const PolygonMesh& body, std::span<const CurveProjector> projectors, const FactorOf& factor_of);

  /// What all of a face's part are bound to; null where it is not loose, and for faces beyond the body's.
  const Candidate* held(std::uint32_t face) const {
    const bool loose = face < part_of_.size() && held_[part_of_[face]].has_value();
    return loose ? &*held_[part_of_[face]] : nullptr;
  }
  /// By their first points.
  const std::vector<LoosePart>& list() const { return list_; }

 private:
  void enlist(const std::vector<std::uint32_t>& part_of_point);

  std::vector<std::uint32_t> part_of_;          ///< of each face
  std::vector<std::optional<Candidate>> held_;  ///< by part
  std::vector<LoosePart> list_;
};

}  // namespace tendril::bind
