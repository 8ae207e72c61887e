#include <gtest/gtest.h>

#include <algorithm>

#include "runner/bending.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

TEST(Player, PageAsksForNothingElse) {
  const Folder folder;
  make_page(folder, "page", bending(), tube_off());
  const std::string page = bytes_of(folder / "page/page.html");
  for (const std::string word : {"http", "src=", "url(", "import", "@STYLE@", "@FILM@", "@DATA@", "@SCRIPT@"})
    EXPECT_EQ(page.find(word), std::string::npos) << word;
  const auto files = Json::parse(bytes_of(folder / "page/summary.json"))["files"];
  EXPECT_NE(std::find(files.begin(), files.end(), "page.html"), files.end());
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
