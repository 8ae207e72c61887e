#pragma once

#include <tendril/scene/curve_file.h>

namespace tendril::runner {

/// The curve-pairs of the files of axes at rest and, one file for each or none, of their poses. Each posed
/// one is on the knots of its rest, else refused with the words given, unless these are empty. Refused, too,
/// are curve-pairs whose frames jump, naming the nodes.
struct Axes {
  std::vector<CurvePair> rest, posed;
  std::vector<std::string> names;  ///< as the files call them, or their places there
};
Axes read_axes(const std::vector<std::string>& rest, const std::vector<std::string>& posed,
               const std::string& expected_knots = "the same");

}  // namespace tendril::runner
