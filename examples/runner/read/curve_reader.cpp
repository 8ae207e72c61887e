#include "read/curve_reader.h"

#include "read/schema.h"

#include <tendril/base/file.h>
#include <tendril/dynamics/rod.h>

#include <array>
#include <cmath>

namespace tendril::runner {
namespace {

CurveFile from_control_points(const JsonNode& file, int degree) {
  for (const char* key : {"points", "orientation", "parametrisation"}) {
    if (file.has(key))
      file.at(key).refuse("not used with control points", "points or control_points, not both");
  }
  const KnotVector knots =
      file.at("knots").locate([&] { return KnotVector(degree, file.at("knots").numbers()); });
  const auto count = static_cast<std::size_t>(knots.control_points());
  for (const char* key : {"control_points", "orientation_control_points"}) {
    if (file.at(key).size() == count) continue;
    file.at(key).refuse(std::to_string(file.at(key).size()) + " control points",
                        std::to_string(count) + ", as the knots and the degree ask for");
  }
  return {file.locate([&] {
            return CurvePair(knots, file.at("control_points").points(),
                             file.at("orientation_control_points").points());
          }),
          {},
          std::nullopt};
}

CurveFile from_masses(const JsonNode& file, int degree, const CurveFile* rest) {
  for (const char* key : {"knots", "control_points", "orientation_control_points"}) {
    if (file.has(key)) file.at(key).refuse("not used with points", "points or control_points, not both");
  }
  const JsonNode points = file.at("points");
  const std::vector<Vec3> p = points.points();
  const std::vector<Vec3> q = read_orientation(file.at("orientation"), p, mean_edge(points, p));
  const bool as_rest = rest != nullptr && rest->through && rest->masses.size() == p.size();
  const Interpolator through =
      as_rest ? *rest->through
              : points.locate([&] { return Interpolator(degree, p, read_parametrisation(file)); });
  return {CurvePair(through.knots(), through.solve(p), through.solve(q)), p, through};
}

}  // namespace

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

CurveFile read_curve(const std::string& path, const CurveFile* rest) {
  const Json json = parse_json(read_file(path), path);
  require_schema(json, kCurveSchema, path);
  const JsonNode file(path, json);
  const int degree = file.has("degree") ? static_cast<int>(file.at("degree").integer(1, kMaxDegree)) : 3;
  if (file.has("control_points")) return from_control_points(file, degree);
  if (file.has("points")) return from_masses(file, degree, rest);
  file.refuse("neither points nor control points", "the key 'points' or 'control_points'");
}

}  // namespace tendril::runner
