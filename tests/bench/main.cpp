// Times of the dynamics and of its peers, from one run on one thread:
//   dynamics_bench [--quick] [--json FILE] [--only rhs|stiff|growth|plant|mujoco]
// Exit code 0; 1 when something is wrong that no machine's speed can excuse; 2 for bad arguments.
#include <tendril/base/file.h>

#include <cstdio>
#include <cstring>

#include "bench/sections.h"

namespace tendril::bench {
namespace {

struct Arguments {
  bool quick = false, understood = true;
  std::string json, only;
};

Arguments read(int argc, char** argv) {
  Arguments out;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--quick")
      out.quick = true;
    else if (word == "--json" && has_value)
      out.json = argv[++i];
    else if (word == "--only" && has_value)
      out.only = argv[++i];
    else
      out.understood = false;
  }
  return out;
}

int run(const Arguments& arguments) {
  Settings settings{arguments.quick, {}};
  OrderedJson out;
  for (const std::string& peer : {odeint_version(), sundials_version(), mujoco_version()}) {
    std::printf("peer: %s\n", peer.c_str());
    out["peers"].push_back(peer);
  }
  const auto wanted = [&](const char* name) { return arguments.only.empty() || arguments.only == name; };
  if (wanted("rhs")) out["right_hand_side"] = right_hand_side(settings);
  if (wanted("growth")) out["growth"] = growth(settings);
  if (wanted("plant")) out["plant"] = plant_in_real_time(settings);
  if (wanted("mujoco")) out["mujoco"] = mujoco_chain(settings);
  if (wanted("stiff")) out["stiff_rods"] = stiff_rods(settings);
  out["broken"] = settings.broken;
  if (!arguments.json.empty()) write_file_whole(arguments.json, out.dump(2) + "\n");
  for (const std::string& fact : settings.broken) std::printf("BROKEN: %s\n", fact.c_str());
  return settings.broken.empty() ? 0 : 1;
}

}  // namespace
}  // namespace tendril::bench

int main(int argc, char** argv) {
  const tendril::bench::Arguments arguments = tendril::bench::read(argc, argv);
  if (!arguments.understood) {
    std::fprintf(stderr, "%s [--quick] [--json FILE] [--only rhs|growth|plant|mujoco|stiff]\n", argv[0]);
    return 2;
  }
  try {
    return tendril::bench::run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
