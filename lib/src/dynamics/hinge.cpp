#include <cmath>
#include <cstdint>

#include "column_access.h"
#include "spring_loops.h"

namespace tendril {
namespace {

using Workspace = System::Workspace;
using Model = System::Model;
using Segment = System::Model::Segment;
using lanes::Reader;
using lanes::V3;
using lanes::Writer;

/// Without a twist state bending is isotropic and straight at rest, and a tangent halves the angle phi
/// between its edges: both its springs together are 1/4 K phi^2, on the edges alone. False when two edges
/// fold back (or are not near and were taken for it).
template <bool Energy, bool Near>
TENDRIL_INLINE bool hinge_nodes(const Model& model, std::size_t first, std::size_t end, Workspace& work) {
  const Reader e(work.e);
  const Writer before(work.g_before), after(work.g_after);
  double* __restrict energy = work.energy.data();
  const double* __restrict stiffness = model.bending.hinge.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 a = e.at(i - 1);
    const V3 b = e.at(i);
    const V3 c = lanes::cross(a, b);
    const double sine2 = lanes::dot(c, c);
    const double cosine = lanes::dot(a, b);
    double ratio;
    bool good;
    if constexpr (Near) {
      ratio = lanes::wide_asin_ratio(sine2);
      good = sine2 <= lanes::kWideSquare && cosine > 0.0;
    } else {
      const V3 sum = a + b;
      const double sine = std::sqrt(sine2);
      const double phi = lanes::angle(sine, cosine);
      ratio = sine > 1e-12 ? phi / (sine > 1e-12 ? sine : 1.0) : 1.0;
      good = lanes::dot(sum, sum) >= kFoldBack * kFoldBack;
      if constexpr (Energy) energy[i] = 0.25 * stiffness[i] * phi * phi;
    }
    const double g = -0.5 * stiffness[i] * ratio;
    before.put(i, g * b);
    after.put(i, g * a);
    bad |= good || stiffness[i] == 0.0 ? 0 : 1;
  }
  return bad == 0;
}

TENDRIL_LANES bool hinge_near(const Model& model, const State&, std::size_t first, std::size_t end,
                              Workspace& work) {
  return hinge_nodes<false, true>(model, first, end, work);
}
TENDRIL_LANES bool hinge_far(const Model& model, const State&, std::size_t first, std::size_t end,
                             Workspace& work) {
  return hinge_nodes<false, false>(model, first, end, work);
}
TENDRIL_LANES bool hinge_with_energy(const Model& model, const State&, std::size_t first, std::size_t end,
                                     Workspace& work) {
  return hinge_nodes<true, false>(model, first, end, work);
}

bool never(const Model&, const State&, std::size_t, std::size_t, Workspace&) {
  return false;
}

}  // namespace

double bend_held(const Model& model, std::size_t node, Workspace& work) {
  const Vec3 t = work.frame.z[node];
  const double stiffness = model.bend_l[node] + model.bend_t[node];
  Vec3 g_tangent = Vec3::Zero();
  double energy = 0.0;
  const auto spring = [&](const Vec3& e) {
    const double sine = e.cross(t).norm();
    const double angle = std::atan2(sine, e.dot(t));
    const double g = sine > 1e-12 ? stiffness * angle / sine : stiffness;
    g_tangent -= g * e;
    energy += 0.5 * stiffness * angle * angle;
    return Vec3(-g * t);
  };
  if (model.has_before(node)) work.g_before.set(node, spring(work.e[node - 1]));
  if (model.has_after(node)) work.g_after.set(node, spring(work.e[node]));
  work.g_tangent.set(node, g_tangent);
  return energy;
}

Evaluation hinge(const Model& model, const State& reference, const Segment& segment, bool energy,
                 Workspace& work) {
  // No springs act on these tangents, but torques may.
  for (std::size_t i = segment.first; i < segment.end && model.loaded; ++i)
    work.g_tangent.set(i, Vec3::Zero());
  const Loops loops = energy ? Loops{never, hinge_with_energy} : Loops{hinge_near, hinge_far};
  if (run(loops, model, reference, segment, work)) return {};
  for (std::size_t i = segment.first; i < segment.end; ++i)
    if (model.bending.hinge[i] != 0.0 && !((work.e[i - 1] + work.e[i]).norm() >= kFoldBack))
      return {Evaluation::Outcome::fold_back, i};
  return {};
}

}  // namespace tendril
