#pragma once

#include <tendril/contact/surface_self_contact.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "contact/response.h"
#include "self_mesh.h"

namespace tendril::contact {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A vertex and a face, or two edges, that may come near each other.
struct SelfPair {
  std::uint32_t first, second;
};
/// Of every pair of a list: its distance less that where response begins, or less.
struct PairSlacks {
  std::vector<double> faces, edges;
};

/// The pairs of two patches.
struct SelfGroup {
  std::uint32_t p, q;                 ///< patches
  std::size_t faces, edges, members;  ///< ends in SelfList's arrays; each group begins where the last ended
  double slack;                       ///< least distance less that where response begins, when searched
};

/// Where the curves are, and how spans of them may be bounded from there.
struct SelfPose {
  std::vector<CurvePair> pairs;
  std::vector<SpanShape> shapes;
  std::vector<Placement> going;
};

/// Pairs that may come near each other while what each span holds moves by no more than its margin.
struct SelfList {
  SelfPose pose;               ///< when searched; empty in a list for one state alone
  std::vector<double> margin;  ///< per span
  std::vector<SelfGroup> groups;
  std::vector<SelfPair> faces, edges;  ///< of vertices of the mesh and its faces; of its edges
  PairSlacks slack;                    ///< when searched
  std::vector<std::uint32_t> members;  ///< of a group's pairs, indices of `used`
  std::vector<std::uint32_t> used;     ///< vertices of the mesh that any pair has, ascending
};

/// Masses of a surface's rods and their orientation masses less them, rod by rod.
struct SelfNodes {
  std::vector<Vec3> p, arm;
};

struct SelfModel {
  SelfModel(ContactSurface surface, const Law& law, Meets which);

  ContactSurface surface;
  Law law;
  Meets which;
  SelfMesh mesh;
  std::vector<SpanGain> gains;  ///< per span

  bool barrier() const { return law.kind == Law::Kind::barrier; }
  const RodPoints& points() const { return *surface.points; }
  double thick() const { return 2.0 * surface.skin; }
  double meets() const { return thick() + law.range; }

  SelfPose pose(std::vector<CurvePair> pairs) const;
  /// How far what each span holds moved at most.
  std::vector<double> motions(const SelfPose& before, std::span<const CurvePair> now) const;
  SelfNodes nodes(const StateView& state) const;
  /// The same as motions(), coarser and without curves: 0.1 us a rod.
  std::vector<double> coarse_motions(const SelfPose& before, const SelfNodes& then,
                                     const StateView& now) const;
  double measured(std::size_t span, std::span<const CurvePair> before, std::span<const CurvePair> now) const;
  /// Of a patch: a blended vertex moves as a mean of the points it is made of.
  double of_patch(std::uint32_t patch, std::span<const double> motions) const;
  /// Pairs nearer than where response begins and both margins. `at` are all vertices.
  std::shared_ptr<const SelfList> search(SelfPose pose, std::span<const Vec3> at,
                                         std::vector<double> margin) const;
  std::vector<Vec3> place(std::span<const CurvePair> pairs) const;
  /// Two places of one part that rest this near each other are left out.
  double left_out(double first_side, double second_side) const {
    return std::max(1.5 * meets(), first_side + second_side);
  }
};

}  // namespace tendril::contact
