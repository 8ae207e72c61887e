#include "write/spoilt.h"

#include <cstdio>

namespace tendril::runner {

std::string describe(const bind::Distortion& d) {
  const bind::SpoiltZone& worst = d.zones.front();
  char text[400];
  std::snprintf(
      text, sizeof text,
      "%.2g %% of the mesh: %zu triangle(s) folded, %zu stretched and %zu crushed more than tenfold, in "
      "%zu zone(s), the largest about %g %g %g",
      100.0 * d.spoilt, d.folded, d.stretched, d.crushed, d.zones.size(), worst.centre.x(), worst.centre.y(),
      worst.centre.z());
  return text;
}

}  // namespace tendril::runner
