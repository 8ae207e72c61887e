#include <gtest/gtest.h>

#include <algorithm>

#include "runner/bending.h"

/// A program that was built where npm or its packages were not.
namespace tendril::test {
namespace {

TEST(PlayerAbsent, IsRefusedBeforeAnythingIsRunOrWritten) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("s.json", bending().dump());
  for (const std::string what : {"s.json", "tube.off", "nothing.json"}) {
    const Outcome run = folder.run("run " + what + " --out out --player");
    EXPECT_EQ(run.code, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find("--player"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("apt-get install nodejs npm"), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

TEST(PlayerAbsent, AllElseRuns) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("s.json", bending().dump());
  const Outcome run = folder.run("run s.json --out out --no-frames --no-pictures");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "out/summary.json"));
}

}  // namespace
}  // namespace tendril::test
