#pragma once

#include <tendril/bind/distortion.h>

#include <string>

namespace tendril::runner {

/// A share of the mesh's area that is worth a word where a whole run is concerned: what a verdict of `right`
/// allows.
constexpr double kSpoilt = 1e-3;

/// What is spoilt, how and where, for a message: "2 % of the mesh: 3 triangle(s) folded, ...". Of at least
/// one zone.
std::string describe(const bind::Distortion& distortion);

}  // namespace tendril::runner
