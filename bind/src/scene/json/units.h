#pragma once

#include <map>
#include <optional>
#include <string>

namespace tendril::scene {

/// What a scene's units are in metres, kilograms and seconds.
struct Units {
  double length = 1.0, mass = 1.0, time = 1.0;
};

/// By their words, each with or without a number before it ("mm", "5 m", "lb"). Nothing where one is missing
/// or means nothing known; metres, kilograms and seconds where none of the three is given.
std::optional<Units> units_of(const std::map<std::string, std::string>& words);

}  // namespace tendril::scene
