#include "hinge.h"

#include <cmath>
#include <cstdint>

#include "dynamics/vector/column_access.h"
#include "kinematics.h"
#include "spring_loops.h"

namespace tendril {
namespace {

using Segment = Model::Segment;
using lanes::Reader;
using lanes::V3;
using lanes::Writer;

/// Without a twist state bending is isotropic and straight at rest: both springs together are K phi^2, phi
/// the angle that either edge makes with the tangent between them, half of that between the unit edges a and
/// b. With d = (b - a) / 2, of length sin(phi), the gradient by d is 2 K phi / (sin(phi) cos(phi)) d. False
/// when two edges fold back (or turn further than was taken for granted). Beside it the stretch of the edges.
enum class Reach { near, wide, any };
template <bool Energy, Reach R>
TENDRIL_INLINE bool hinge_nodes(const Model& model, std::size_t first, std::size_t end, const Kinematics& kin,
                                Gradient& grad) {
  const Reader e(kin.e);
  const Writer to(grad.bend);
  double* __restrict energy = grad.energy.data(), * __restrict g_length = grad.length.data();
  const double *__restrict length = kin.length.data(), *__restrict rest = model.rest_length.data(),
               *__restrict k_stretch = model.stretch.data();
  const double* __restrict stiffness = model.bending.hinge.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const V3 a = e.at(i - 1);
    const V3 b = e.at(i);
    const V3 d = 0.5 * (b - a);
    const double sine2 = lanes::dot(d, d);
    double slope;
    bool good;
    if constexpr (R == Reach::near) {
      slope = lanes::asin_slope(sine2);
      good = sine2 <= lanes::kNearSquare;
    } else if constexpr (R == Reach::wide) {
      good = sine2 <= lanes::kWideSquare;
      const double w = good ? sine2 : 0.0;
      slope = lanes::wide_asin_ratio(w) / std::sqrt(1.0 - w);
    } else {
      const V3 sum = a + b;
      const double sine = std::sqrt(sine2);
      const double cosine = 0.5 * std::sqrt(lanes::dot(sum, sum));
      const double phi = lanes::angle(sine, cosine);
      good = cosine >= 0.5 * kFoldBack;
      slope = good && sine > 1e-12 ? phi / (sine * cosine) : 1.0;
      if constexpr (Energy) energy[i] = stiffness[i] * phi * phi;
    }
    to.put(i, (stiffness[i] * slope) * d);
    const double strain = length[i] - rest[i];
    g_length[i] = k_stretch[i] * strain;
    if constexpr (Energy) energy[i] += 0.5 * g_length[i] * strain;
    bad |= good || stiffness[i] == 0.0 ? 0 : 1;
  }
  return bad == 0;
}

TENDRIL_LANES bool hinge_near(const Model& model, const State&, std::size_t first, std::size_t end,
                              const Kinematics& kin, Gradient& grad) {
  return hinge_nodes<false, Reach::near>(model, first, end, kin, grad);
}
TENDRIL_LANES bool hinge_wide(const Model& model, const State&, std::size_t first, std::size_t end,
                              const Kinematics& kin, Gradient& grad) {
  return hinge_nodes<false, Reach::wide>(model, first, end, kin, grad);
}
TENDRIL_LANES bool hinge_any(const Model& model, const State&, std::size_t first, std::size_t end,
                             const Kinematics& kin, Gradient& grad) {
  return hinge_nodes<false, Reach::any>(model, first, end, kin, grad);
}
TENDRIL_LANES bool hinge_with_energy(const Model& model, const State&, std::size_t first, std::size_t end,
                                     const Kinematics& kin, Gradient& grad) {
  return hinge_nodes<true, Reach::any>(model, first, end, kin, grad);
}

/// Up to 60 degrees between two edges a series does, without an arc tangent.
bool hinge_far(const Model& model, const State& reference, std::size_t first, std::size_t end,
               const Kinematics& kin, Gradient& grad) {
  return hinge_wide(model, reference, first, end, kin, grad) ||
         hinge_any(model, reference, first, end, kin, grad);
}

bool never(const Model&, const State&, std::size_t, std::size_t, const Kinematics&, Gradient&) {
  return false;
}

}  // namespace

Evaluation hinge(const Model& model, const State& reference, const Segment& segment, bool energy,
                 const Kinematics& kin, Gradient& grad) {
  // No springs act on these tangents, but torques may.
  for (std::size_t i = segment.first; i < segment.end && model.acts_on_frames; ++i)
    grad.tangent.set(i, Vec3::Zero());
  const Loops loops = energy ? Loops{never, hinge_with_energy} : Loops{hinge_near, hinge_far};
  if (run(loops, model, reference, segment, kin, grad)) return {};
  for (std::size_t i = segment.first; i < segment.end; ++i)
    if (model.bending.hinge[i] != 0.0 && !((kin.e[i - 1] + kin.e[i]).norm() >= kFoldBack))
      return {Evaluation::Outcome::fold_back, i};
  return {};
}

}  // namespace tendril
