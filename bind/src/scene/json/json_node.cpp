#include "scene/json/json_node.h"

#include "scene/json/json_walk.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace tendril::scene {
namespace {

constexpr std::size_t kDeepest = 64;

FilePlace line_and_column(const std::string& name, std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, std::min(position > 0 ? position - 1 : 0, text.size()));
  const auto line = static_cast<std::size_t>(1 + std::count(before.begin(), before.end(), '\n'));
  const std::size_t newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? before.size() + 1 : before.size() - newline;
  return {name, "", line, column};
}

/// The parser's own message without its code and its position, which the place already gives.
std::string without_prefix(const std::string& message) {
  const std::size_t bracket = message.find("] ");
  std::string rest = bracket == std::string::npos ? message : message.substr(bracket + 2);
  const std::size_t colon = rest.find(": ");
  if (rest.rfind("parse error", 0) == 0 && colon != std::string::npos) rest = rest.substr(colon + 2);
  return rest;
}

/// First pass over the text: what the building parser would not tell, or not with a place.
class SyntaxCheck : public JsonWalk {
 public:
  SyntaxCheck(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    throw SceneError(line_and_column(name_, text_, position), without_prefix(error.what()),
                     "JSON (comments allowed)");
  }

 private:
  bool at_key() override {
    if (keys_.back().insert(levels().back().key).second) return true;
    throw SceneError({name_, pointer()}, "the key is given twice", "each key once in an object");
  }
  bool at_open() override {
    if (levels().size() == kDeepest)
      throw SceneError({name_, pointer(kDeepest - 1)}, "nested too deeply",
                       "at most " + std::to_string(kDeepest) + " levels");
    keys_.emplace_back();
    return true;
  }
  void at_close() override { keys_.pop_back(); }

  std::string_view text_;
  const std::string& name_;
  std::vector<std::set<std::string>> keys_;  ///< of the objects around
};

}  // namespace

std::string escape(const std::string& key) {
  std::string out;
  for (const char c : key) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  return out;
}

std::string quote(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

Json parse_json(std::string_view text, const std::string& name) {
  SyntaxCheck check(text, name);
  Json::sax_parse(text, &check, Json::input_format_t::json, true, true);
  return Json::parse(text, nullptr, true, true);
}

JsonNode::JsonNode(std::string file, const Json& value, std::string pointer)
    : file_(std::move(file)), value_(&value), pointer_(std::move(pointer)) {}

void JsonNode::refuse(const std::string& reason, const std::string& expected) const {
  throw SceneError({file_, pointer_}, reason, expected);
}

void JsonNode::refuse_as(const InvalidInput& error) const {
  if (const auto* closer = dynamic_cast<const SceneError*>(&error)) throw SceneError(*closer);
  refuse(error.place() + ": " + error.reason(), error.expected());
}

bool JsonNode::has(const std::string& key) const {
  return value_->is_object() && value_->contains(key) && !(*value_)[key].is_null();
}

JsonNode JsonNode::at(const std::string& key) const {
  if (!has(key)) refuse("the key '" + key + "' is missing", "it to be given");
  return {file_, (*value_)[key], pointer_ + "/" + escape(key)};
}

JsonNode JsonNode::at(std::size_t index) const {
  if (!is_array() || index >= size()) refuse("there is no entry " + std::to_string(index), "a longer array");
  return {file_, (*value_)[index], pointer_ + "/" + std::to_string(index)};
}

double JsonNode::number() const {
  if (!is_number()) refuse(quote(*value_) + " is not a number", "a finite number");
  const double x = value_->get<double>();
  if (!std::isfinite(x)) refuse("the number is not finite", "a finite number");
  return x;
}

double JsonNode::positive() const {
  const double x = number();
  if (!(x > 0.0)) refuse(quote(*value_) + " is not positive", "a positive number");
  return x;
}

double JsonNode::not_negative() const {
  const double x = number();
  if (x < 0.0) refuse(quote(*value_) + " is negative", "a number of at least 0");
  return x;
}

long JsonNode::integer(long least, long most) const {
  const std::string range = "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  const double x = number();
  if (x != std::floor(x) || x < static_cast<double>(least) || x > static_cast<double>(most)) {
    refuse(quote(*value_) + " is out of range", range);
  }
  return static_cast<long>(x);
}

std::string JsonNode::path() const {
  if (text().empty()) refuse("an empty path", "the path of a file");
  return (std::filesystem::path(file_).parent_path() / text()).lexically_normal().string();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) refuse(quote(*value_) + " is not a text", "a text in quotes");
  return value_->get<std::string>();
}

Vec3 JsonNode::vec3() const {
  if (!is_array() || size() != 3) refuse(quote(*value_) + " is not a vector", "three numbers [x, y, z]");
  return {at(0).number(), at(1).number(), at(2).number()};
}

std::vector<Vec3> JsonNode::points() const {
  if (!is_array()) refuse(quote(*value_) + " is not a list", "a list of points [x, y, z]");
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < size(); ++i) out.push_back(at(i).vec3());
  return out;
}

std::vector<double> JsonNode::numbers() const {
  if (!is_array()) refuse(quote(*value_) + " is not a list", "a list of numbers");
  std::vector<double> out;
  for (std::size_t i = 0; i < size(); ++i) out.push_back(at(i).number());
  return out;
}

double JsonNode::number_or(const std::string& key, double otherwise) const {
  return has(key) ? at(key).number() : otherwise;
}

std::string JsonNode::text_or(const std::string& key, const std::string& otherwise) const {
  return has(key) ? at(key).text() : otherwise;
}

}  // namespace tendril::scene
