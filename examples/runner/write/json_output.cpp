#include "write/json_output.h"

#include <iostream>

namespace tendril::runner {

OrderedJson to_json(const Vec3& v) {
  return OrderedJson::array({v.x(), v.y(), v.z()});
}

OrderedJson to_json(const bind::Distortion& distortion) {
  OrderedJson zones = OrderedJson::array();
  for (const bind::SpoiltZone& zone : distortion.zones)
    zones.push_back({{"centre", to_json(zone.centre)},
                     {"radius", zone.radius},
                     {"area", zone.area},
                     {"faces", zone.faces}});
  return {{"most_stretch", distortion.most_stretch},
          {"least_stretch", distortion.least_stretch},
          {"stretched", distortion.stretched},
          {"crushed", distortion.crushed},
          {"folded", distortion.folded},
          {"spoilt_area", distortion.spoilt},
          {"zones", zones}};
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
