#pragma once

#include "scene/json/json_node.h"

namespace tendril::scene {

/// The JSON Schemas of bind/src/scene/schema, embedded when the library is built.
extern const char* const kSceneSchema;
extern const char* const kCurveSchema;
extern const char* const kQueriesSchema;

/// Holds a file against a schema (draft 7). InvalidInput for the deepest violation, as "name#/pointer" with
/// the value found; what was expected is the description the schema gives at that place.
void require_schema(const Json& document, const char* schema_text, const std::string& name);

}  // namespace tendril::scene
