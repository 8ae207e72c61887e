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

TEST(Player, PageAsksForNothingElse) {
  const Folder folder;
  make_page(folder, "page", bending(), tube_off());
  const std::string page = bytes_of(folder / "page/page.html");
  for (const std::string word : {"http", "src=", "url(", "import", "@STYLE@", "@FILM@", "@DATA@", "@SCRIPT@"})
    EXPECT_EQ(page.find(word), std::string::npos) << word;
  const auto files = Json::parse(bytes_of(folder / "page/summary.json"))["files"];
  EXPECT_NE(std::find(files.begin(), files.end(), "page.html"), files.end());
}

/// What stands in a page, read as its script does.
struct Page {
  Json film;
  std::string bytes;

  explicit Page(const std::string& html) : film(Json::parse(between(html, "application/json\">"))) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string packed;
    std::uint32_t word = 0;
    int bits = 0;
    for (const char c : between(html, "text/plain\">")) {
      if (c == '=') break;
      word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
      if ((bits += 6) >= 8) packed.push_back(static_cast<char>(word >> (bits -= 8) & 255U));
    }
    bytes.resize(10000000);
    uLongf size = bytes.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                         reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
              Z_OK);
    bytes.resize(size);
  }

  static std::string between(const std::string& html, const std::string& mark) {
    const std::size_t at = html.find(mark) + mark.size();
    return html.substr(at, html.find("</script>", at) - at);
  }

  std::vector<std::int64_t> array(const std::string& name) const {
    const Json& section = film["sections"][name];
    const std::size_t count = section["count"], stride = section["stride"], at = section["at"];
    std::vector<std::int64_t> out(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t zigzag = 0;
      for (std::size_t k = 0; k < 4; ++k)
        zigzag |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + k * count + i)))
                  << 8 * k;
      out[i] = zigzag % 2 == 0 ? zigzag / 2 : -static_cast<std::int64_t>(zigzag / 2) - 1;
    }
    for (int k = 0; k < section["order"]; ++k)
      for (std::size_t i = stride; i < count; ++i) out[i] += out[i - stride];
    return out;
  }
};

TEST(Player, PageHoldsMeshBindingAndControlPoints) {
  const Folder folder;
  make_page(folder, "page", forked(), tube_off(41));
  const Page page(bytes_of(folder / "page/page.html"));
  const bind::PolygonMesh mesh = bind::read_mesh(folder / "tube.off");
  const std::vector<std::int64_t> points = page.array("points");
  ASSERT_EQ(points.size(), 3 * mesh.points.size());
  const double size = bind::bounding_diagonal(mesh.points), unit = page.film["pointUnit"];
  const Vec3 middle(0.0, 0.5, 0.0);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(static_cast<double>(points[3 * i + k]) * unit,
                  (mesh.points[i] - middle)[static_cast<int>(k)] / size, 0.51 * unit);
  const std::vector<std::int64_t> corners = page.array("triangles");
  EXPECT_EQ(corners.size(), 2 * 3 * mesh.face_count());
  EXPECT_EQ(corners[4], mesh.corners[2]);
  std::size_t others = 0;
  for (const std::int64_t n : page.array("other_count")) others += static_cast<std::size_t>(n);
  EXPECT_EQ(others + mesh.points.size(),
            Json::parse(bytes_of(folder / "page/summary.json"))["binding"]["shares"]);
  for (const std::int64_t w : page.array("other_weight")) EXPECT_GT(w, 0);
  const std::vector<std::int64_t> control = page.array("control");
  const std::size_t stride = control.size() / 14;  // at rest, and at 13 outputs
  EXPECT_EQ(control.size(), 14 * stride);
  const auto at = [&](std::size_t moment, std::size_t i) {
    return static_cast<double>(control[moment * stride + i]) * page.film["controlUnits"][0].get<double>() *
           size;
  };
  EXPECT_NEAR(at(0, 0), -0.05, 1e-8);
  EXPECT_NEAR(at(0, 1), -0.5, 1e-8);
  EXPECT_NEAR(at(13, 1), -0.5, 1e-8);  // held
  std::ifstream table(folder / "page/trajectory.csv");
  std::string line, last;
  while (std::getline(table, line)) last = line;
  double tip = 0.0;
  std::sscanf(last.c_str(), "%*[^,],%*[^,],%*[^,],%lf", &tip);
  EXPECT_NEAR(at(13, stride - 7), tip, 1e-8) << last;
}

TEST(Player, PageHoldsEveryContact) {
  const Folder folder;
  const Outcome run = folder.run("run '" TENDRIL_SOURCE_DIR
                                 "/examples/scenes/rope_over_rods.json"
                                 "' --out out --no-pictures --player");
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string table = bytes_of(folder / "out/rod_contacts.csv");
  const auto lines = std::count(table.begin(), table.end(), '\n');
  EXPECT_GT(lines, 10);
  const Page page(bytes_of(folder / "out/rope_over_rods.html"));
  std::int64_t contacts = 0;
  for (const std::int64_t n : page.array("contact_count")) contacts += n;
  EXPECT_EQ(contacts, lines - 1);
  EXPECT_EQ(page.array("contact_ends").size(), 6 * static_cast<std::size_t>(contacts));
}

TEST(Player, IsWrittenOfRodsWithoutAMesh) {
  Json scene = bending();
  scene.erase("mesh");
  scene.erase("bound_to");
  const Folder folder;
  make_page(folder, "rods", scene, tube_off());
  EXPECT_NE(bytes_of(folder / "rods/rods.html").find("\"name\":\"rods\",\"about\":\"2 curve-pairs"),
            std::string::npos);
}

}  // namespace
}  // namespace tendril::test
