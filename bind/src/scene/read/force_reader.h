#pragma once

#include "scene/json/json_node.h"

#include <tendril/dynamics/force.h>
#include <tendril/dynamics/rod.h>

#include <memory>

namespace tendril::scene {

/// One entry of forces.
std::shared_ptr<const Force> read_force(const JsonNode& force, const std::vector<Rod>& rods,
                                        const std::vector<std::string>& names);

}  // namespace tendril::scene
