#pragma once

#include "scene/json/json_node.h"
#include "scene/json/units.h"

#include <tendril/dynamics/force.h>
#include <tendril/dynamics/rod.h>

#include <memory>

namespace tendril::scene {

/// One entry of forces.
/// \param units  for what is not given: 1.2 kg/m^3 of air, gusts about 1 Hz; nothing where they are not known
std::shared_ptr<const Force> read_force(const JsonNode& force, const std::vector<Rod>& rods,
                                        const std::vector<std::string>& names,
                                        const std::optional<Units>& units);

}  // namespace tendril::scene
