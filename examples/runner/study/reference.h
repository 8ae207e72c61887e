#pragma once

#include "study/trial.h"

namespace tendril::runner {

/// What errors are measured against, and how far it can be trusted.
struct Reference {
  Trial first, second;     ///< the first is the reference
  bool certified = false;  ///< two methods agree to what was asked
  Distance gap;            ///< between the two; infinite when there is only one
  std::string statement;   ///< one sentence
};

/// How closely two methods must agree.
struct Agreement {
  double position;  ///< relative to the scene's length
  double director;  ///< [rad]
};

/// Says whether two runs certify each other: both finished, by different methods, and close enough.
Reference certify(Trial first, Trial second, double length, const Agreement& wanted);

/// The last of a row of ever tighter runs.
struct Tightest {
  Trial trial;
  double settled;  ///< how far it moved from the run before; infinite when there was none
};

/// Runs RODAS and Cash-Karp, each at ever tighter tolerances down to `tightest` while its half of `seconds`
/// lasts. Where one of them cannot take the scene, classic Runge-Kutta 4 at ever smaller steps stands in. The
/// reference is the one of the two that changed less between its last two runs. Nothing when no run finishes.
std::optional<Reference> make_reference(const Study& study, double seconds, double tightest,
                                        const Agreement& wanted);

}  // namespace tendril::runner
