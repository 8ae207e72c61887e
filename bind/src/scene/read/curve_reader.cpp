#include "scene/read/curve_reader.h"

#include <tendril/dynamics/rod.h>

#include <cmath>

namespace tendril::scene {

Parametrisation read_parametrisation(const JsonNode& parent) {
  const std::string name = parent.text_or("parametrisation", "centripetal");
  if (name == "uniform") return Parametrisation::uniform;
  if (name == "chord_length") return Parametrisation::chord_length;
  if (name == "universal") return Parametrisation::universal;
  if (name != "centripetal") parent.at("parametrisation").refuse(quote(name), "a known parametrisation");
  return Parametrisation::centripetal;
}

double mean_edge(const JsonNode& points, const std::vector<Vec3>& p) {
  double length = 0.0;
  for (std::size_t i = 1; i < p.size(); ++i) {
    const double edge = (p[i] - p[i - 1]).stableNorm();
    if (!(edge > 0.0)) points.at(i).refuse("the same point as the one before", "distinct neighbours");
    if (!std::isfinite(edge)) points.at(i).refuse("too far from the one before", "finite lengths");
    length += edge;
  }
  return length / static_cast<double>(p.size() - 1);
}

std::vector<Vec3> read_orientation(const JsonNode& orientation, const std::vector<Vec3>& p, double offset) {
  if (orientation.size() > 0 && orientation.at(0).is_array()) {
    if (orientation.size() != p.size()) {
      orientation.refuse(std::to_string(orientation.size()) + " orientation points",
                         "one for each of the " + std::to_string(p.size()) + " points");
    }
    return orientation.points();
  }
  const Vec3 side = orientation.vec3();
  return orientation.locate([&] { return orientation_towards(p, side, offset); });
}

}  // namespace tendril::scene
