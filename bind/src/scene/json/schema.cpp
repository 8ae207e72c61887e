#include "scene/json/schema.h"

#include <optional>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace tendril::scene {
namespace {

using Error = valijson::ValidationResults::Error;

/// "[key]" or "[3]" of a violation's context.
std::string step_of(const std::string& context) {
  return context.substr(1, context.size() - 2);
}

const Json& follow_reference(const Json& root, const Json& schema) {
  if (!schema.contains("$ref")) return schema;
  return root.at(Json::json_pointer(schema.at("$ref").get<std::string>().substr(1)));
}

/// The value a violation is at, and the part of the schema that speaks of it.
struct Spot {
  JsonNode node;
  const Json* schema;
};

Spot find_spot(const JsonNode& document, const Json& root, const Error& error) {
  Spot spot{document, &root};
  for (std::size_t i = 1; i < error.context.size(); ++i) {
    const std::string step = step_of(error.context[i]);
    if (spot.node.is_array()) {
      spot.node = spot.node.at(std::stoul(step));
      spot.schema = &follow_reference(root, spot.schema->at("items"));
    } else {
      spot.node = spot.node.at(step);
      spot.schema = &follow_reference(root, spot.schema->at("properties").at(step));
    }
  }
  return spot;
}

std::string names(const Json& list, bool keys) {
  std::string out;
  for (const auto& item : list.items()) {
    if (!out.empty()) out += ", ";
    out += keys ? item.key() : quote(item.value());
  }
  return out;
}

std::string quoted_part(const std::string& text) {
  const std::size_t begin = text.find_last_of('\'', text.size() - 3);
  return text.substr(begin, text.rfind('\'') + 1 - begin);
}

bool starts(const std::string& text, const char* with) {
  return text.rfind(with, 0) == 0;
}

std::string unknown_key(const std::string& description) {
  const std::string quoted = quoted_part(description);
  return quoted.substr(1, quoted.size() - 2);
}

std::string reason_of(const Error& error, const Json& value) {
  const std::string& said = error.description;
  if (starts(said, "Object contains a property")) return "unknown key " + quoted_part(said);
  if (starts(said, "Missing required property")) return "the key " + quoted_part(said) + " is missing";
  if (starts(said, "Value type")) return quote(value) + " has the wrong type";
  if (starts(said, "Expected number")) return quote(value) + " is out of range";
  if (starts(said, "Failed to match against any enum")) return quote(value) + " is not one of the choices";
  if (starts(said, "Array")) return "a list of " + std::to_string(value.size()) + " entries";
  return quote(value) + ": " + said;
}

std::string expectation_of(const Error& error, const Json& schema) {
  if (starts(error.description, "Object contains a property")) {
    return "one of: " + names(schema.at("properties"), true);
  }
  if (schema.contains("enum")) return "one of: " + names(schema.at("enum"), false);
  return schema.value("description", std::string("what the schema says"));
}

std::optional<Error> deepest(valijson::ValidationResults& results) {
  std::optional<Error> found;
  Error error;
  while (results.popError(error)) {
    if (!found || error.context.size() > found->context.size()) found = error;
  }
  return found;
}

}  // namespace

void require_schema(const Json& document, const char* schema_text, const std::string& name) {
  const Json schema_json = Json::parse(schema_text);
  valijson::Schema schema;
  valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_json), schema);

  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(document), &results)) return;
  const std::optional<Error> error = deepest(results);
  const JsonNode root(name, document);
  if (!error) root.refuse("the schema does not allow it", "what the schema says");
  const Spot spot = find_spot(root, schema_json, *error);
  if (starts(error->description, "Object contains a property")) {
    const std::string key = unknown_key(error->description);
    if (spot.node.has(key)) spot.node.at(key).refuse("unknown key", expectation_of(*error, *spot.schema));
  }
  spot.node.refuse(reason_of(*error, spot.node.value()), expectation_of(*error, *spot.schema));
}

}  // namespace tendril::scene
