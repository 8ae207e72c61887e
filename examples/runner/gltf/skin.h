#pragma once

#include "film/film.h"

#include <array>
#include <cstdint>

namespace tendril::runner {

/// A joint of a skin: it moves as the frame of a curve-pair at t does.
struct SkinJoint {
  std::uint32_t pair;  ///< of the binding; kStill for the joint of what stays
  double t;            ///< parameter

  static constexpr std::uint32_t kStill = 0xFFFFFFFF;
};

/// How a joint has moved: x goes to `to` + rotation (x - `from`).
struct JointMotion {
  Mat3 rotation = Mat3::Identity();
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();

  Vec3 operator()(const Vec3& x) const { return to + rotation * (x - from); }
};

/// The joints that move a vertex, with weights that sum to 1; those of weight 0 are joint 0.
struct Influences {
  std::array<std::uint16_t, 4> joint{};
  std::array<double, 4> weight{};

  void add(std::size_t joint, double weight);
};

struct SkinOptions {
  double tolerance = 1e-3;       ///< largest distance from the exact points, over the mesh's size
  std::size_t max_joints = 512;  ///< raised to two a curve-pair and one more, which a skin needs
};

/// A linear blend skin that follows a film.
struct Skin {
  std::vector<SkinJoint> joints;       ///< along each curve-pair in turn, its ends included
  std::vector<Influences> influences;  ///< one a vertex
  double error = 0.0;   ///< largest distance from the exact points at any moment, over the mesh's size
  bool reached = true;  ///< whether it is within the tolerance
};

/// Joints are placed from the start of each curve-pair to its end, each as far from the one before as the
/// tolerance allows at what is bound between them. A vertex bound to one place has the two joints beside
/// it, with weights linear in t; one bound to several, the up to four joints beside its places that follow
/// it best, by least squares over the moments. Joints are added where that is not enough, as long as it
/// helps. Moments are looked at one by one as they turn out to be the worst, so memory does not grow with
/// their number.
/// \param film  with a mesh and at least one moment
Skin fit_skin(const Film& film, const SkinOptions& options);

/// How a joint has moved at a moment, since rest.
/// \param rest, posed  of the film, in the order of the binding
JointMotion motion_of(const SkinJoint& joint, std::span<const CurvePair> rest,
                      std::span<const CurvePair> posed);

}  // namespace tendril::runner
