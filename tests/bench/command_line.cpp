#include "bench/command_line.h"

#include <tendril/base/file.h>

#include <algorithm>
#include <cstdio>

namespace tendril::bench {
namespace {

struct Arguments {
  Settings settings;
  std::string json, only;
};

/// False when they are not understood.
bool read(int argc, char** argv, bool with_meshes, Arguments& out) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--quick")
      out.settings.quick = true;
    else if (word == "--json" && has_value)
      out.json = argv[++i];
    else if (word == "--only" && has_value)
      out.only = argv[++i];
    else if (with_meshes && out.settings.meshes.empty() && word[0] != '-')
      out.settings.meshes = word;
    else
      return false;
  }
  return with_meshes != out.settings.meshes.empty();
}

int usage(const char* program, bool with_meshes, const std::vector<Section>& sections) {
  std::string names;
  for (const Section& section : sections) names += (names.empty() ? "" : "|") + section.name;
  std::fprintf(stderr, "%s%s [--quick] [--json FILE] [--only %s]\n", program, with_meshes ? " MESHES" : "",
               names.c_str());
  return 2;
}

int run(Arguments& arguments, OrderedJson out, const std::vector<Section>& sections) {
  for (const Section& section : sections)
    if (arguments.only.empty() || arguments.only == section.name)
      out[section.key] = section.run(arguments.settings);
  out["broken"] = arguments.settings.broken;
  if (!arguments.json.empty()) write_file_whole(arguments.json, out.dump(2) + "\n");
  for (const std::string& fact : arguments.settings.broken) std::printf("BROKEN: %s\n", fact.c_str());
  return arguments.settings.broken.empty() ? 0 : 1;
}

}  // namespace

int run_bench(int argc, char** argv, bool with_meshes, OrderedJson out,
              const std::vector<Section>& sections) {
  Arguments arguments;
  const bool understood = read(argc, argv, with_meshes, arguments);
  const bool known = arguments.only.empty() ||
                     std::any_of(sections.begin(), sections.end(),
                                 [&](const Section& section) { return section.name == arguments.only; });
  if (!understood || !known) return usage(argv[0], with_meshes, sections);
  try {
    return run(arguments, std::move(out), sections);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace tendril::bench
