#pragma once

#include "scene/json/json_node.h"

namespace tendril::scene {

/// Which of the names a node of the file says; refused where it is none.
std::size_t read_name(const JsonNode& name, const std::vector<std::string>& names);

}  // namespace tendril::scene
