#include "film/apng.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tendril::runner {
namespace {

constexpr std::size_t kSignature = 8;

/// \param bytes  at most 4
std::string big(std::uint32_t value, int bytes) {
  std::string out;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    out.push_back(static_cast<char>(value >> shift & 255U));
  return out;
}

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t k = 0; k < 4; ++k) out = out << 8 | static_cast<std::uint8_t>(bytes.at(at + k));
  return out;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big(static_cast<std::uint32_t>(data.size()), 4) + body + big(static_cast<std::uint32_t>(sum), 4);
}

/// The data of all chunks of a type, in order.
std::vector<std::string> chunks_of(const std::string& png, const std::string& type) {
  std::vector<std::string> out;
  for (std::size_t at = kSignature; at + 12 <= png.size(); at += 12 + word(png, at))
    if (png.compare(at + 4, 4, type) == 0) out.push_back(png.substr(at + 8, word(png, at)));
  return out;
}

/// How long a frame is shown, in milliseconds: 16 bits, and 0 means as short as can be.
std::string delay(double seconds) {
  const double most = 65535.0, milliseconds = std::round(1000.0 * seconds);
  return big(static_cast<std::uint32_t>(std::clamp(milliseconds, 1.0, most)), 2) + big(1000, 2);
}

}  // namespace

std::string apng_bytes(const std::vector<std::string>& pngs, const std::vector<double>& seconds) {
  const std::string header = chunks_of(pngs.at(0), "IHDR").at(0);
  const std::string frames = big(static_cast<std::uint32_t>(pngs.size()), 4), forever = big(0, 4);
  std::string out = pngs[0].substr(0, kSignature) + chunk("IHDR", header) + chunk("acTL", frames + forever);
  std::uint32_t sequence = 0;
  for (std::size_t k = 0; k < pngs.size(); ++k) {
    const std::string corner = big(0, 4) + big(0, 4),
                      over = big(0, 2);  // the whole picture, in place of the last
    out += chunk("fcTL", big(sequence++, 4) + header.substr(0, 8) + corner + delay(seconds.at(k)) + over);
    for (const std::string& data : chunks_of(pngs[k], "IDAT"))
      out += k == 0 ? chunk("IDAT", data) : chunk("fdAT", big(sequence++, 4) + data);
  }
  return out + chunk("IEND", "");
}

}  // namespace tendril::runner
