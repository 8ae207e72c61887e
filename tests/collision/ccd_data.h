#pragma once

#include <tendril/collision/query_file.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tendril::test {

/// Where the public continuous queries are: $TENDRIL_CCD_DATA, or ../shared/data/ccd beside the source tree.
/// They are not part of it; what uses them says so and is skipped without.
inline std::filesystem::path ccd_data() {
  const char* given = std::getenv("TENDRIL_CCD_DATA");
  return given ? given : std::filesystem::path(TENDRIL_SOURCE_DIR) / "../shared/data/ccd";
}

/// Why a test of them is skipped.
inline std::string no_ccd_data() {
  return "the public queries (Continuous-Collision-Detection/Sample-Queries) are no part of this tree and "
         "not at " +
         ccd_data().string() +
         "; TENDRIL_CCD_DATA names their folder. The tree's own queries are tested all the same.";
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All .csv files below a folder, in the order of their names.
inline std::vector<std::filesystem::path> query_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::exists(folder))
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline collision::Features features_of(const std::filesystem::path& file) {
  return file.string().find("edge-edge") != std::string::npos ? collision::Features::edge_edge
                                                              : collision::Features::vertex_face;
}

}  // namespace tendril::test
