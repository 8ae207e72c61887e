#pragma once

#include "query/ask.h"
#include "write/json_output.h"

namespace tendril::runner {

/// "hit", "touching", "free", "undecidable".
const char* to_string(exact::Relation relation);
/// "none", "not_finite", "open", ...
const char* to_string(exact::Reason reason);

/// What was asked, of what, and what was found; README.md of collision/ describes it.
OrderedJson to_json(const Target& target, const std::vector<Finding>& findings);
OrderedJson to_json(const Target& target, const Target& other, const MeshFinding& found);

std::string to_table(const Target& target, const std::vector<Finding>& findings);
std::string to_table(const Target& target, const Target& other, const MeshFinding& found);

}  // namespace tendril::runner
