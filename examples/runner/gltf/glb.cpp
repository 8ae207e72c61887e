#include "gltf/glb.h"

#include <bit>
#include <cstring>

namespace tendril::runner {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

std::string word(std::uint32_t value) {
  std::string out(4, '\0');
  std::memcpy(out.data(), &value, 4);
  return out;
}

std::string chunk(const std::string& type, std::string data, char filler) {
  data.resize((data.size() + 3) / 4 * 4, filler);
  return word(static_cast<std::uint32_t>(data.size())) + type + data;
}

}  // namespace

std::size_t Glb::add_view(std::span<const std::byte> data, Target target) {
  buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
  Json view{{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", data.size()}};
  if (target != none) view["target"] = static_cast<int>(target);
  buffer_.append(reinterpret_cast<const char*>(data.data()), data.size());
  json["bufferViews"].push_back(std::move(view));
  return json["bufferViews"].size() - 1;
}

std::string Glb::bytes() const {
  Json all = json;
  all["buffers"] = {{{"byteLength", buffer_.size()}}};
  const std::string text = all.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string chunks = chunk("JSON", text, ' ') + chunk(std::string("BIN\0", 4), buffer_, '\0');
  return "glTF" + word(2) + word(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

}  // namespace tendril::runner
