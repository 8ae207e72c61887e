// Times of bindings, projections and readers, and of their peers, from one run on one thread:
//   binding_bench MESHES [--quick] [--json FILE] [--only update|transpose|projection|reading]
// MESHES is the folder of the meshes of libcgal-demo. Exit code 0; 1 when a result is wrong; 2 for bad
// arguments.
#include <tendril/base/file.h>

#include <cstdio>
#include <cstring>

#include "bench/binding/sections.h"

namespace tendril::bench {
namespace {

struct Arguments {
  Settings settings;
  bool understood = true;
  std::string json, only;
};

Arguments read(int argc, char** argv) {
  Arguments out;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--quick")
      out.settings.quick = true;
    else if (word == "--json" && has_value)
      out.json = argv[++i];
    else if (word == "--only" && has_value)
      out.only = argv[++i];
    else if (out.settings.meshes.empty() && word[0] != '-')
      out.settings.meshes = word;
    else
      out.understood = false;
  }
  out.understood = out.understood && !out.settings.meshes.empty();
  return out;
}

int run(Arguments& arguments) {
  OrderedJson out;
  const auto wanted = [&](const char* name) { return arguments.only.empty() || arguments.only == name; };
  Settings& settings = arguments.settings;
  if (wanted("update")) out["update"] = update_section(settings);
  if (wanted("transpose")) out["transpose"] = transpose_section(settings);
  if (wanted("projection")) out["projection"] = projection_section(settings);
  if (wanted("reading")) out["reading"] = reading_section(settings);
  out["broken"] = settings.broken;
  if (!arguments.json.empty()) write_file_whole(arguments.json, out.dump(2) + "\n");
  for (const std::string& fact : settings.broken) std::printf("BROKEN: %s\n", fact.c_str());
  return settings.broken.empty() ? 0 : 1;
}

}  // namespace
}  // namespace tendril::bench

int main(int argc, char** argv) {
  tendril::bench::Arguments arguments = tendril::bench::read(argc, argv);
  if (!arguments.understood) {
    std::fprintf(stderr, "%s MESHES [--quick] [--json FILE] [--only update|transpose|projection|reading]\n",
                 argv[0]);
    return 2;
  }
  try {
    return tendril::bench::run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
