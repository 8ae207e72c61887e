#include <tendril/base/number.h>

#include <array>
#include <charconv>

namespace tendril {

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return std::string(text.data(), end);
}

}  // namespace tendril
