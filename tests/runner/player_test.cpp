#include <gtest/gtest.h>
#include <tendril/bind/import.h>
#include <zlib.h>

#include <algorithm>

#include "runner/bending.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

std::string between(const std::string& html, const std::string& mark) {
  const std::size_t at = html.find(mark) + mark.size();
  return html.substr(at, html.find("</script>", at) - at);
}

/// What is deflated in base64.
std::string inflated(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string packed, out(10000000, '\0');
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((bits += 6) >= 8) packed.push_back(static_cast<char>(word >> (bits -= 8) & 255U));
  }
  uLongf size = out.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  out.resize(size);
  return out;
}

TEST(Player, PageAsksForNothingElse) {
  const Folder folder;
  make_page(folder, "page", bending(), tube_off());
  const std::string page = bytes_of(folder / "page/page.html");
  for (const std::string word :
       {"http", "src=", "url(", "import", "@STYLE@", "@LICENCE@", "@FILM@", "@DATA@", "@SCRIPT@"})
    EXPECT_EQ(page.find(word), std::string::npos) << word;
  const auto files = Json::parse(bytes_of(folder / "page/summary.json"))["files"];
  EXPECT_NE(std::find(files.begin(), files.end(), "page.html"), files.end());
}

TEST(Player, PageCarriesThreeJsAndItsLicence) {
  const Folder folder;
  make_page(folder, "page", bending(), tube_off());
  const std::string html = bytes_of(folder / "page/page.html");
  const std::size_t licence = html.find("The MIT License"), end = html.find("-->");
  EXPECT_LT(html.find("<!--"), licence);
  EXPECT_LT(html.find("three.js authors", licence), end);
  EXPECT_LT(html.find("WITHOUT WARRANTY OF ANY KIND", licence), end);
  EXPECT_NE(inflated(between(html, "text/base64\">")).find("WebGLRenderer"), std::string::npos);
}

/// What stands in a page, read as its script does.
struct Page {
  Json film;
  std::string bytes;

  explicit Page(const std::string& html)
      : film(Json::parse(between(html, "application/json\">"))),
        bytes(inflated(between(html, "text/plain\">"))) {}

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
