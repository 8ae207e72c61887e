#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/output.h"

namespace tendril::bench {

struct Settings {
  bool quick = false;
  std::string meshes;               ///< folder of the meshes of libcgal-demo, of a bench that needs them
  std::vector<std::string> broken;  ///< what no machine's speed can excuse
};

/// A part of a bench, by the name that --only knows it by and its key in the JSON.
struct Section {
  std::string name, key;
  std::function<OrderedJson(Settings&)> run;
};

/// What main does: PROGRAM [MESHES] [--quick] [--json FILE] [--only NAME], MESHES when `with_meshes`.
/// \param out  what the JSON begins with
/// Exit code 0; 1 when something is broken or fails; 2 for arguments it does not know.
int run_bench(int argc, char** argv, bool with_meshes, OrderedJson out, const std::vector<Section>& sections);

}  // namespace tendril::bench
