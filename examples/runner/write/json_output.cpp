#include "write/json_output.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

namespace tendril::runner {
namespace {

/// Entries of a list that may be as long as the mesh.
constexpr std::size_t kListed = 100;

}  // namespace

OrderedJson to_json(const Vec3& v) {
  return OrderedJson::array({v.x(), v.y(), v.z()});
}

OrderedJson to_json(const std::vector<std::uint32_t>& ids) {
  const auto end = ids.begin() + static_cast<std::ptrdiff_t>(std::min(ids.size(), kListed));
  return {{"count", ids.size()}, {"ids", std::vector<std::uint32_t>(ids.begin(), end)}};
}

OrderedJson to_json(const bind::Distortion& distortion) {
  OrderedJson zones = OrderedJson::array();
  for (std::size_t k = 0; k < std::min(distortion.zones.size(), kListed); ++k) {
    const bind::SpoiltZone& zone = distortion.zones[k];
    zones.push_back({{"centre", to_json(zone.centre)},
                     {"radius", zone.radius},
                     {"area", zone.area},
                     {"faces", to_json(zone.faces)}});
  }
  return {{"most_stretch", distortion.most_stretch},
          {"least_stretch", distortion.least_stretch},
          {"stretched", distortion.stretched},
          {"crushed", distortion.crushed},
          {"folded", distortion.folded},
          {"spoilt_area", distortion.spoilt},
          {"zone_count", distortion.zones.size()},
          {"zones", zones}};
}

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

void print(const OrderedJson& value) {
  std::cout << value.dump(2, ' ', false, OrderedJson::error_handler_t::replace) << '\n';
}

const char* to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::ok:
      return "ok";
    case FrameStatus::zero_speed:
      return "zero_speed";
    case FrameStatus::zero_edge:
      return "zero_edge";
    case FrameStatus::fold_back:
      return "fold_back";
    case FrameStatus::zero_offset:
      return "zero_offset";
    case FrameStatus::offset_along_tangent:
      return "offset_along_tangent";
  }
  return "unknown";
}

}  // namespace tendril::runner
