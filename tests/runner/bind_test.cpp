#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kAxis = R"({"version": 1, "orientation": [0, 0, 1], "points":
  [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2.5, 0.5, 0], [2, 1, 0], [1, 1, 0], [0, 1, 0]]})";
constexpr const char* kPose = R"({"version": 1, "orientation": [0, 0, 1], "points":
  [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2.7, 0, 0], [3.4, 0, 0], [4.4, 0, 0], [5.4, 0, 0]]})";

/// A sheet between and around the legs of the axis, which is a U.
std::string sheet_off() {
  constexpr int kAlong = 24, kAcross = 12;
  std::ostringstream text;
  text << "OFF\n" << (kAlong + 1) * (kAcross + 1) << ' ' << kAlong * kAcross << " 0\n";
  for (int i = 0; i <= kAlong; ++i)
    for (int k = 0; k <= kAcross; ++k) text << 0.1 * i << ' ' << -0.3 + 1.6 * k / kAcross << " 0.1\n";
  for (int i = 0; i < kAlong; ++i)
    for (int k = 0; k < kAcross; ++k) {
      const int a = i * (kAcross + 1) + k, b = a + kAcross + 1;
      text << "4 " << a << ' ' << b << ' ' << b + 1 << ' ' << a + 1 << '\n';
    }
  return text.str();
}

TEST(Bind, ShowsTheTearOfNearestBindingAndNoneOfContinuous) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  folder.write("axis.json", kAxis);
  folder.write("pose.json", kPose);
  const std::string command = "bind sheet.off --axis axis.json --pose pose.json --refinements 1 --json";
  const Outcome nearest = folder.run(command + " --nearest");
  EXPECT_EQ(nearest.code, 1);
  const auto torn = Json::parse(nearest.out).at("judge");
  EXPECT_EQ(torn.at("verdict"), "tear");
  EXPECT_NEAR(torn.at("growth_of_max").get<double>(), 2.0, 0.1);
  const Outcome continuous = folder.run(command);
  EXPECT_EQ(continuous.code, 0) << continuous.err;
  const Json smooth = Json::parse(continuous.out);
  EXPECT_EQ(smooth.at("judge").at("verdict"), "smooth");
  EXPECT_GT(smooth.at("binding").at("ambiguous").size(), 0U);
  EXPECT_LT(smooth.at("binding").at("ambiguous").size(), 25U * 13U);
}

TEST(Bind, DrawsAndReportsWithoutAPose) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  folder.write("axis.json", kAxis);
  const Outcome outcome = folder.run("bind sheet.off --axis axis.json --refinements 1 --picture sheet.png");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(bytes_of(folder / "sheet.png").substr(1, 3), "PNG");
}

TEST(Bind, RefusesAPoseThatDoesNotFit) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  folder.write("axis.json", kAxis);
  folder.write(
      "other.json",
      R"({"version": 1, "orientation": [0, 0, 1], "points": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]})");
  EXPECT_EQ(folder.run("bind sheet.off --axis axis.json --pose other.json").code, 2);
  EXPECT_EQ(folder.run("bind sheet.off --axis axis.json --axis axis.json --pose axis.json").code, 2);
  EXPECT_EQ(folder.run("bind sheet.off --axis axis.json --band 3").code, 2);
}

}  // namespace
}  // namespace tendril::test
