#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

// Point 3 is where point 0 is, point 4 in no face, face 1 turned over, face 2 without area.
constexpr const char* kOdd =
    "OFF\n6 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 0\n5 5 5\n1 1 0\n3 0 1 2\n3 1 2 5\n3 0 1 1\n3 3 1 2\n";

TEST(RepairCommand, MendsAndSaysWhatBecameOfWhat) {
  const Folder folder;
  folder.write("odd.off", kOdd);
  const Outcome outcome = folder.run("repair odd.off --out even.ply --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json what = Json::parse(outcome.out);
  EXPECT_EQ(what.at("points"), 4);
  EXPECT_EQ(what.at("faces"), 2);
  EXPECT_EQ(what.at("merged_points"), Json::parse(R"([{"id": 3, "now": 0}])"));
  EXPECT_EQ(what.at("dropped_points"), Json::array({4}));
  EXPECT_EQ(what.at("dropped_faces"), Json::array({2, 3}));
  EXPECT_EQ(what.at("turned_faces"), Json::array({1}));
  const Json again = Json::parse(folder.run("repair even.ply --out same.ply --json").out);
  EXPECT_EQ(again.at("changed"), false);
  EXPECT_EQ(bytes_of(folder / "same.ply"), bytes_of(folder / "even.ply"));
  EXPECT_EQ(folder.run("repair odd.off --out even.obj").code, 2);
}

}  // namespace
}  // namespace tendril::test
