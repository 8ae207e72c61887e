#include "scene/json/names.h"

#include <algorithm>

namespace tendril::scene {

std::size_t read_name(const JsonNode& name, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name.text());
  if (found == names.end()) name.refuse("no curve-pair is called " + quote(name.value()), "the name of one");
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace tendril::scene
