#include "player/pack.h"

#include <zlib.h>

#include <stdexcept>

namespace tendril::runner {
namespace {

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const auto* from = reinterpret_cast<const Bytef*>(bytes.data());
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, from, static_cast<uLong>(bytes.size()),
                Z_BEST_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib could not deflate the page's data");
  out.resize(size);
  return out;
}

std::string base64(const std::string& bytes) {
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63U] : '=');
  }
  return out;
}

}  // namespace

void Pack::add(const std::string& name, const std::vector<std::int32_t>& values, std::size_t stride,
               int order) {
  std::vector<std::uint32_t> words(values.begin(), values.end());  // wraps as the reader's sums do
  for (int k = 0; k < order; ++k)
    for (std::size_t i = words.size(); i-- > stride;) words[i] -= words[i - stride];
  sections_[name] = {{"at", bytes_.size()}, {"count", words.size()}, {"stride", stride}, {"order", order}};
  for (int shift = 0; shift < 32; shift += 8)
    for (const std::uint32_t w : words) {
      const std::uint32_t zigzag = w << 1 ^ (w >> 31 != 0 ? 0xFFFFFFFFU : 0U);
      bytes_.push_back(static_cast<char>(zigzag >> shift & 255U));
    }
}

std::string Pack::text() const {
  return base64(deflated(bytes_));
}

}  // namespace tendril::runner
