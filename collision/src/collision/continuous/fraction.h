#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Doubles as fractions in decimal digits, of any length, exactly.
namespace tendril::collision {

/// The double that equals numerator / denominator; nothing where one of them is no integer, the denominator
/// is not positive, or no double equals the fraction.
std::optional<double> from_fraction(std::string_view numerator, std::string_view denominator);

/// "numerator,denominator" in lowest terms of a finite x; "0,1" for zero.
std::string to_fraction(double x);

}  // namespace tendril::collision
