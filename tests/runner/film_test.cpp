#include <gtest/gtest.h>
#include <png.h>
#include <tendril/bind/import.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "runner/bending.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

std::uint32_t big(const std::string& bytes, std::size_t at, std::size_t count = 4) {
  std::uint32_t out = 0;
  for (std::size_t k = 0; k < count; ++k) out = out << 8 | static_cast<unsigned char>(bytes.at(at + k));
  return out;
}

struct Chunk {
  std::string type, data;
};

/// The chunks of a PNG file, their sums checked.
std::vector<Chunk> chunks_of(const std::string& png) {
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  std::vector<Chunk> out;
  for (std::size_t at = 8; at < png.size();) {
    const std::size_t length = big(png, at);
    out.push_back({png.substr(at + 4, 4), png.substr(at + 8, length)});
    const std::string body = png.substr(at + 4, length + 4);
    EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())),
              big(png, at + 8 + length));
    at += 12 + length;
  }
  return out;
}

/// The pixels that deflated rows of a picture hold; none of rows that do not fit it.
std::string pixels(const std::string& header, const std::string& data) {
  const std::size_t row = 3 * static_cast<std::size_t>(big(header, 0)) + 1, rows = big(header, 4);
  std::string out(row * rows, '\0');
  uLongf size = out.size();
  const int code = uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                              reinterpret_cast<const Bytef*>(data.data()), static_cast<uLong>(data.size()));
  return code == Z_OK && size == out.size() ? out : "";
}

TEST(Film, HasAFrameAnOutputEachShownAsLongAsItLasts) {
  Json scene = bending();
  scene["simulation"]["duration"] = 1.2;
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("s.json", scene.dump());
  const Outcome run = folder.run("run s.json --out out --no-frames --no-pictures --film film.apng");
  ASSERT_EQ(run.code, 0) << run.err;
  std::vector<std::string> frames;
  std::string header;
  std::uint32_t sequence = 0;
  double seconds = 0.0;
  for (const Chunk& chunk : chunks_of(bytes_of(folder / "film.apng"))) {
    if (chunk.type == "IHDR") header = chunk.data;
    if (chunk.type == "acTL") EXPECT_EQ(big(chunk.data, 0), 13u);
    if (chunk.type == "fcTL" || chunk.type == "fdAT") EXPECT_EQ(big(chunk.data, 0), sequence++);
    if (chunk.type == "fcTL") {
      EXPECT_EQ(chunk.data.substr(4, 8), header.substr(0, 8));
      seconds += static_cast<double>(big(chunk.data, 20, 2)) / big(chunk.data, 22, 2);
      frames.emplace_back();
    }
    if (chunk.type == "IDAT") frames.at(0) += chunk.data;
    if (chunk.type == "fdAT") frames.back() += chunk.data.substr(4);
  }
  ASSERT_EQ(frames.size(), 13u);
  EXPECT_NEAR(seconds, 1.3, 1e-9);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_NE(pixels(header, frames[k]), "");
    if (k > 0) EXPECT_NE(pixels(header, frames[k]), pixels(header, frames[k - 1]));
  }
}

TEST(Film, IsRefusedUnderANameThatSaysSomethingElse) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("s.json", bending().dump());
  const Outcome run = folder.run("run s.json --out out --film film.gif");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("--film"), std::string::npos);
}

/// Pixels that are clearly red.
std::size_t red_in(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr), 0);
  std::size_t out = 0;
  for (std::size_t i = 0; i < rgb.size(); i += 3)
    if (rgb[i] > 110 && rgb[i] > 2 * rgb[i + 1]) ++out;
  return out;
}

TEST(Pictures, MarkAmbiguousPointsWhereAsked) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  Json scene = forked();
  scene["picture"]["axis"] = false;
  folder.write("s.json", scene.dump());
  for (const std::string flags : {"--out plain", "--out marked --mark-ambiguous"})
    ASSERT_EQ(folder.run("run s.json --no-frames " + flags).code, 0);
  EXPECT_EQ(red_in(folder / "plain/final.png"), 0u);
  EXPECT_GT(red_in(folder / "marked/final.png"), 10u);
}

}  // namespace
}  // namespace tendril::test
