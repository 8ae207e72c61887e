#pragma once

#include <tendril/bind/import.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "runner/bending.h"

/// Pages of players, played. Needs TENDRIL_NPM, the folder of npm's packages, and TENDRIL_HAS_PLAYER.
namespace tendril::test {

inline constexpr const char* kToPlay =
    "needs the program's player, node, Debian's chromium, and playwright-core of npm in " TENDRIL_NPM
    ", which tests/run.sh --long installs";

inline bool can_play() {
  return TENDRIL_HAS_PLAYER != 0 && does("command -v node") && does("command -v chromium") &&
         std::filesystem::exists(TENDRIL_NPM "/playwright-core");
}

/// What tests/runner/films/play.cjs saw of pages, in order.
inline nlohmann::json play(const Folder& folder, const std::vector<std::string>& names) {
  std::string command = "cd '" + folder.path().string() +
                        "' && node '" TENDRIL_SOURCE_DIR "/tests/runner/films/play.cjs' '" TENDRIL_NPM
                        "' \"$(command -v chromium)\" .";
  for (const std::string& name : names) command += " " + name + "/" + name + ".html";
  EXPECT_EQ(std::system((command + " > seen.json").c_str()), 0);
  return nlohmann::json::parse(bytes_of(folder / "seen.json"));
}

/// Largest distance of the page's vertices from the run's, over the mesh's size.
inline double shader_error(const Folder& folder, const std::string& mesh, const std::string& name,
                           std::size_t moment) {
  const std::string bytes = bytes_of(folder / (name + "_" + std::to_string(moment) + ".f32"));
  std::vector<float> seen(bytes.size() / 4);
  std::memcpy(seen.data(), bytes.data(), bytes.size());
  const std::vector<Vec3> rest = bind::read_mesh(folder / mesh).points;
  const std::vector<Vec3> exact = bind::read_mesh(folder / (name + "/" + frame_name(moment))).points;
  EXPECT_EQ(seen.size(), 4 * exact.size());
  Vec3 low = rest.front(), high = low;
  for (const Vec3& p : rest) low = low.cwiseMin(p), high = high.cwiseMax(p);
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Vec3 now = Eigen::Map<const Eigen::Vector3f>(seen.data() + 4 * i).cast<double>();
    const double off = (now - (exact[i] - 0.5 * (low + high)) / (high - low).norm()).norm();
    if (!(off <= worst)) worst = off;
    if (std::isnan(off)) return 1.0;  // never drawn
  }
  return worst;
}

}  // namespace tendril::test
