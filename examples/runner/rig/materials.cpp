#include "rig/materials.h"

#include <tendril/base/error.h>

#include <algorithm>

namespace tendril::runner {

const std::vector<NamedMaterial>& materials() {
  static const std::vector<NamedMaterial> all{
      {"rubber", 2e6, 0.49, 925, 0.1, "natural rubber", "[Ashby 2011] appendix A"},
      {"foam", 2e6, 0.3, 55, 0.2, "flexible polymer foam of low density", "[Ashby 2011] appendix A"},
      {"wood", 1e10, 0.38, 700, 0.01, "wood, along the grain", "[Ashby 2011] appendix A"},
      {"steel", 2.07e11, 0.29, 7850, 0.001, "low carbon steel", "[Ashby 2011] appendix A"},
      {"leaf", 3e7, 0.3, 800, 0.1, "leaves and young stems, full of water",
       "a round value in the range of [Niklas 1992]"},
  };
  return all;
}

const NamedMaterial& find_material(const std::string& name) {
  const auto& all = materials();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& m) { return name == m.name; });
  if (found != all.end()) return *found;
  std::string names;
  for (const NamedMaterial& m : all) names += (names.empty() ? "" : ", ") + std::string(m.name);
  throw InvalidInput("--material", "'" + name + "'", "one of: " + names);
}

}  // namespace tendril::runner
