#pragma once

#include <tendril/base/export.h>

#include <functional>

namespace tendril {

/// |R(z)| of the Cash-Karp solution of order 5, R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24 + z^5/120 + z^6/800:
/// the factor by which a step of size h multiplies a motion x' = lambda x, z = h lambda = re + i im.
TENDRIL_CORE_API double cash_karp_amplification(double re, double im);

/// Growth a step beyond 1 of x'' + (alpha + beta w^2) x' + w^2 x = 0 under Cash-Karp with steps h.
TENDRIL_CORE_API double cash_karp_growth(double w, double alpha, double beta, double h);

/// The same under Nystrom's steps (nystrom.h), of a frequency higher by 0.08, since they are stable up to a
/// sharp limit and the largest frequency is an estimate from below.
TENDRIL_CORE_API double nystrom_growth(double w, double alpha, double beta, double h);

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

/// The same of another method.
/// \param frequency, alpha, beta, limits  as above
/// \param growth  of (w, alpha, beta, h), as cash_karp_growth
TENDRIL_CORE_API double guard_step(double frequency, double alpha, double beta, const GuardLimits& limits,
                                   const std::function<double(double, double, double, double)>& growth);

}  // namespace tendril
