#pragma once

#include "scene/json/json_node.h"

#include <tendril/contact/shape.h>
#include <tendril/scene/contact.h>

namespace tendril::scene {

/// The shape of a solid, which the library takes; a mesh's file is read.
SolidShape read_shape(const JsonNode& node);
/// As the library has it.
contact::ShapePtr make_shape(const SolidShape& shape);
/// Principal moments of a body of uniform density and mass 1, about the centre of its frame.
Vec3 moments(const SolidShape& shape);

}  // namespace tendril::scene
