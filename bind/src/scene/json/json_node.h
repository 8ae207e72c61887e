#pragma once

#include <tendril/base/types.h>
#include <tendril/scene/scene_error.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tendril::scene {

using Json = nlohmann::json;

/// JSON with // and /* */ comments. Refused, as "name:line:column": a syntax error, a number beyond double
/// precision, nesting deeper than 64; as "name#/pointer": a key given twice in one object.
Json parse_json(std::string_view text, const std::string& name);

/// A value in a JSON file that knows where it stands, so that whoever refuses it can say so. Keeps a
/// reference to the value.
class JsonNode {
 public:
  JsonNode(std::string file, const Json& value, std::string pointer = "");

  std::string place() const { return file_ + "#" + pointer_; }
  const std::string& file() const { return file_; }
  const std::string& pointer() const { return pointer_; }
  const Json& value() const { return *value_; }
  [[noreturn]] void refuse(const std::string& reason, const std::string& expected) const;

  /// Present and not null.
  bool has(const std::string& key) const;
  JsonNode at(const std::string& key) const;  ///< refuses a missing one
  JsonNode at(std::size_t index) const;
  std::size_t size() const { return value_->size(); }
  bool is_array() const { return value_->is_array(); }
  bool is_number() const { return value_->is_number(); }

  double number() const;
  double positive() const;
  double not_negative() const;
  long integer(long least, long most) const;
  std::string text() const;
  std::string path() const;  ///< a text, not empty, as a path relative to the file
  Vec3 vec3() const;
  std::vector<Vec3> points() const;
  std::vector<double> numbers() const;

  double number_or(const std::string& key, double otherwise) const;
  std::string text_or(const std::string& key, const std::string& otherwise) const;

  /// Runs f; what the library refuses in it is refused here, with the library's own place in the reason.
  template <class F>
  auto locate(F&& f) const {
    try {
      return f();
    } catch (const InvalidInput& error) {
      refuse_as(error);
    }
  }

 private:
  [[noreturn]] void refuse_as(const InvalidInput& error) const;

  std::string file_;
  const Json* value_;
  std::string pointer_;
};

/// A key as a JSON pointer has it: ~ and / are written ~0 and ~1.
std::string escape(const std::string& key);

/// A short quotation of a value for messages.
std::string quote(const Json& value);

}  // namespace tendril::scene
