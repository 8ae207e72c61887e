#pragma once

#include <tendril/base/export.h>

namespace tendril {

/// |R(z)| of the Cash-Karp solution of order 5, R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24 + z^5/120 + z^6/800:
/// the factor by which a step of size h multiplies a motion x' = lambda x, z = h lambda = re + i im.
TENDRIL_CORE_API double cash_karp_amplification(double re, double im);

/// How much a run may amplify its fastest oscillation.
struct GuardLimits {
  double per_step;  ///< |R| - 1 of one step
  double whole;     ///< the sum of that over the run
  double duration;  ///< of what is left of the run
};

/// Largest step h at which no oscillator x'' + (alpha + beta w^2) x' + w^2 x = 0 with w <= frequency is
/// amplified beyond the limits. Undamped, |R(iy)| - 1 = y^6 / 7200: 1e-6 a step is h w = 0.44. Infinite for
/// frequency 0; 0 where frequency or beta w^2 is not finite.
/// \param frequency  largest one of the system [rad / time]
/// \param alpha      mass-proportional damping [1 / time]
/// \param beta       Kelvin-Voigt viscosity [time]
/// \param limits     what is allowed
TENDRIL_CORE_API double guard_step(double frequency, double alpha, double beta, const GuardLimits& limits);

}  // namespace tendril
