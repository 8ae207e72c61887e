#pragma once

#include <tendril/base/export.h>

#include <string>

/// What a closing gap is answered with.
namespace tendril::contact {

/// How contact responds. Per length of rod (or per area of surface): the potential of a gap d is stiffness
/// b(d), 0 from the range on.
struct Law {
  /// b(d).
  enum class Kind {
    /// -(d - range)^2 ln(d / range) [Li et al. 2020]: infinite at d = 0, so that nothing gets through; a
    /// state with d <= 0 is refused, and the step that met it shortened.
    barrier,
    /// (range - d)^2 / 2: a spring, which lets go through what is fast or heavy enough.
    penalty
  };
  Kind kind = Kind::barrier;  ///< which of them
  /// kappa [force / length per length]. A barrier stops an energy E of a length w of rod at about
  /// d = range exp(-E / (kappa w range^2)): keep kappa w range^2 above E / 10. Where it
  /// keeps gaps close to the range, points of a line are felt one by one. Positive.
  double stiffness = 1.0;
  /// Where the response begins [length], positive. Shapes seem larger by about half of it.
  double range = 1e-3;
  /// Coulomb's coefficient mu, at least 0: what slides is held back by mu N; what sticks holds its point.
  double friction = 0.0;
  /// What sticks gives way by the friction over this [force / length per length]; 0 for the stiffness.
  double stick_stiffness = 0.0;
  /// What sticks is also held by its velocity times this and that stiffness [time], at least 0: without, it
  /// swings about its place for ever.
  double stick_damping = 0.0;
  /// c of [Hunt and Crossley 1975] [time / length]: the normal force is multiplied by 1 - c d', at least by
  /// 0. At least 0.
  double damping = 0.0;
};

/// InvalidInput("PLACE.field") for numbers out of range.
TENDRIL_CONTACT_API void check(const Law& law, const std::string& place);

/// b and its derivatives at a gap.
struct Potential {
  double value;  ///< b
  double slope;  ///< b'
  double bend;   ///< b''
};
/// At any gap for a penalty, at d > 0 for a barrier.
TENDRIL_CONTACT_API Potential potential(const Law& law, double gap);

}  // namespace tendril::contact
