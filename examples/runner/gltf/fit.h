#pragma once

#include "gltf/skin.h"

namespace tendril::runner {

/// Places joints and weighs them at some moments of a film. See fit_skin.
class SkinFit {
 public:
  SkinFit(const Film& film, std::span<const std::size_t> moments);

  /// Its error is left to the caller; `reached` says whether it is within the tolerance at these moments.
  /// \param tolerance   [length]
  /// \param max_joints  at least two a curve-pair and one more
  Skin skin(double tolerance, std::size_t max_joints) const;

 private:
  using Motions = std::vector<JointMotion>;  ///< of a joint, one a moment
  /// Joints in order, and where those of each curve-pair begin.
  struct Rig {
    std::vector<SkinJoint> joints;
    std::vector<std::size_t> begin;
    std::vector<Motions> motions;
  };

  Motions motions(const SkinJoint& joint) const;
  bool serves(const SkinJoint& from, const Motions& a, double to, double tolerance) const;
  double farthest(const SkinJoint& from, double tolerance) const;
  std::vector<SkinJoint> place(double tolerance, std::size_t max_joints) const;
  std::vector<SkinJoint> place_within(double& tolerance, std::size_t max_joints) const;
  Rig rig(std::vector<SkinJoint> joints) const;
  static Influences beside(const Rig& rig, std::uint32_t pair, double t);
  std::vector<std::uint16_t> near(const Rig& rig, std::size_t blended) const;
  Influences best_four(const Rig& rig, std::size_t blended, double tolerance) const;
  double error_of(const Rig& rig, std::size_t point, const Influences& influences) const;
  std::vector<Influences> weigh(const Rig& rig, double tolerance) const;
  std::vector<SkinJoint> added(const Rig& rig, const std::vector<double>& errors, double tolerance,
                               std::size_t room) const;

  const Film& film_;
  std::vector<std::vector<CurvePair>> posed_;      ///< per moment
  std::vector<Vec3> exact_;                        ///< per point, all moments of it
  std::vector<std::vector<std::uint32_t>> alone_;  ///< per curve-pair, points bound to it alone, t ascending
  std::vector<std::uint32_t> blended_;             ///< points bound to several places
  std::vector<std::vector<bind::Share>> shares_;   ///< of these
};

}  // namespace tendril::runner
