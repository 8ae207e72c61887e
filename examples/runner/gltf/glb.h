#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace tendril::runner {

/// A binary glTF 2.0 file in the making: the JSON, and the buffer with what accessors are about. Offsets are
/// multiples of four; numbers are little-endian.
class Glb {
 public:
  using Json = nlohmann::ordered_json;
  enum Component : int { u8 = 5121, u16 = 5123, u32 = 5125, f32 = 5126 };
  enum Target : int { none = 0, vertices = 34962, indices = 34963 };

  Json json;

  /// Adds an accessor with its data and gives its index.
  /// \param type        "SCALAR", "VEC3", "MAT4", ...
  /// \param components  numbers an element
  /// \param bounds      whether to state the least and largest of each component
  template <class T>
  std::size_t add(const std::vector<T>& values, const std::string& type, std::size_t components,
                  Target target = none, bool bounds = false, bool normalized = false) {
    Json accessor{{"bufferView", add_view(std::as_bytes(std::span(values)), target)},
                  {"componentType", static_cast<int>(component(T{}))},
                  {"count", values.size() / components},
                  {"type", type}};
    if (normalized) accessor["normalized"] = true;
    if (bounds) add_bounds(values, components, accessor);
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
  }

  /// The file.
  std::string bytes() const;

 private:
  static Component component(std::uint8_t) { return u8; }
  static Component component(std::uint16_t) { return u16; }
  static Component component(std::uint32_t) { return u32; }
  static Component component(float) { return f32; }

  template <class T>
  static void add_bounds(const std::vector<T>& values, std::size_t components, Json& accessor) {
    std::vector<T> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components)), high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % components] = std::min(low[i % components], values[i]);
      high[i % components] = std::max(high[i % components], values[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }

  std::size_t add_view(std::span<const std::byte> data, Target target);

  std::string buffer_;
};

}  // namespace tendril::runner
