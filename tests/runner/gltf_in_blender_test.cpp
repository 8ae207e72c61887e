#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iostream>
#include <optional>

#include "runner/bending.h"
#include "runner/glb_reader.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// Largest distance, at any moment, between where Blender has a file's vertices and where our skinning has
/// them.
double blender_off_by(const Folder& folder, const Json& scene) {
  folder.write("tube.off", tube_off(41));
  folder.write("s.json", scene.dump());
  const Outcome run = folder.run("run s.json --out out --no-frames --no-pictures --gltf");
  EXPECT_EQ(run.code, 0) << run.err;
  const std::string command = "cd '" + folder.path().string() +
                              "' && blender -b --python-exit-code 1 -P '" TENDRIL_SOURCE_DIR
                              "/tests/runner/films/import.py' -- out/s.glb seen.bin > blender.txt 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << bytes_of(folder / "blender.txt");
  const GlbReader glb(bytes_of(folder / "out/s.glb"));
  const std::string bytes = bytes_of(folder / "seen.bin");
  const std::size_t count = glb.at(0).size();
  EXPECT_EQ(bytes.size(), glb.moments() * count * sizeof(Vec3));
  if (bytes.size() != glb.moments() * count * sizeof(Vec3)) return 1.0;
  std::vector<Vec3> seen(count);
  double worst = 0.0;
  for (std::size_t m = 0; m < glb.moments(); ++m) {
    std::memcpy(seen.data()->data(), bytes.data() + m * count * sizeof(Vec3), count * sizeof(Vec3));
    const std::vector<Vec3> ours = glb.at(m);
    for (std::size_t i = 0; i < count; ++i) worst = std::max(worst, (seen[i] - ours[i]).norm());
  }
  return worst;
}

TEST(GltfInBlender, MovesAsOurSkinningWhereInstalled) {
  if (!does("command -v blender")) GTEST_SKIP() << "needs Debian's blender, which no script here installs";
  const double size = std::sqrt(1.0 + 0.04 + 0.04);  // of the tube
  const std::pair<const char*, Json> scenes[] = {{"bending", bending()}, {"forked", forked()}};
  for (const auto& [name, scene] : scenes) {
    const Folder folder;
    const double off = blender_off_by(folder, scene) / size;
    EXPECT_LT(off, 1e-6) << name;
    std::cout << name << ": Blender is " << off << " of the size off our skinning\n";
  }
}

}  // namespace
}  // namespace tendril::test
