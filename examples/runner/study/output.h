#pragma once

#include "study/ladder.h"
#include "write/json_output.h"

namespace tendril::runner {

/// What the errors of a study are, in one sentence.
std::string error_definition(const Results& results);

/// All of a study but the tracks.
OrderedJson to_json(const Results& results, const Study& study);

/// The same as lines of text.
std::string to_table(const Results& results, const Study& study);

/// Error against CPU time and against evaluations as an SVG picture, both axes logarithmic.
std::string to_svg(const Results& results, const Study& study);

}  // namespace tendril::runner
