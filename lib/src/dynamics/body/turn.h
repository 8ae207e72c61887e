#pragma once

#include <tendril/base/types.h>

namespace tendril {

// Rotation vectors: exp([phi]) turns by |phi| about phi.

constexpr double kMostTurn = 2.2142974355881810;  ///< 1 + cos = 0.4, as for tangents [rad]

/// exp([phi]).
Mat3 rotation_of(const Vec3& phi);

/// phi' = D omega of a body that turns by omega (world) and stands at exp([phi]) from its reference
/// [Hairer et al. 2006].
Mat3 turning_rate(const Vec3& phi);

}  // namespace tendril
