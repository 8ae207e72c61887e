#include "scene/json/line_of.h"
#include "scene/json/schema.h"
#include "scene/read/curve_reader.h"

#include <tendril/base/file.h>
#include <tendril/dynamics/rod.h>
#include <tendril/scene/curve_file.h>

#include <algorithm>

namespace tendril::scene {
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
          std::nullopt,
          file.place()};
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
  return {CurvePair(through.knots(), through.solve(p), through.solve(q)), p, through, file.place()};
}

CurveFile one_curve(const JsonNode& curve, const CurveFile* rest) {
  const int degree = curve.has("degree") ? static_cast<int>(curve.at("degree").integer(1, kMaxDegree)) : 3;
  if (!curve.has("control_points") && !curve.has("points"))
    curve.refuse("neither points nor control points", "the key 'points' or 'control_points'");
  CurveFile out =
      curve.has("control_points") ? from_control_points(curve, degree) : from_masses(curve, degree, rest);
  out.name = curve.text_or("name", "");
  return out;
}

/// The place in a list of curves that a joint names: an earlier curve, and a point of it.
CurveJoint read_joint(const JsonNode& joint, const std::vector<CurveFile>& before) {
  const std::string name = joint.at("curve_pair").text();
  const auto parent =
      std::find_if(before.begin(), before.end(), [&](const CurveFile& c) { return c.name == name; });
  if (parent == before.end()) joint.at("curve_pair").refuse("'" + name + "'", "the name of an earlier curve");
  const auto node = static_cast<std::size_t>(joint.at("node").integer(0, 1L << 30));
  if (node >= parent->masses.size())
    joint.at("node").refuse(std::to_string(node), "one of the " + std::to_string(parent->masses.size()) +
                                                      " points of '" + name + "', from 0");
  return {static_cast<std::size_t>(parent - before.begin()), node};
}

Json curve_json(const std::string& text, const std::string& path) {
  Json json = parse_json(text, path);
  require_schema(json, kCurveSchema, path);
  return json;
}

std::vector<CurveFile> several(const JsonNode& file, std::span<const CurveFile> rest) {
  const std::size_t count = file.has("curves") ? file.at("curves").size() : 1;
  if (!rest.empty() && count != rest.size())
    file.refuse(std::to_string(count) + " curve-pairs", std::to_string(rest.size()) + ", as at rest");
  std::vector<CurveFile> out;
  for (std::size_t k = 0; k < count; ++k) {
    const CurveFile* at_rest = rest.empty() ? nullptr : &rest[k];
    const JsonNode curve = file.has("curves") ? file.at("curves").at(k) : file;
    CurveFile one = one_curve(curve, at_rest);
    if (curve.has("joint")) one.joint = read_joint(curve.at("joint"), out);
    out.push_back(std::move(one));
  }
  if (file.has("curves") && file.size() > 2)
    file.refuse("more than a list of curve-pairs", "no keys but 'version' and 'curves'");
  return out;
}

}  // namespace

CurveFile read_curve(const std::string& path, const CurveFile* rest) {
  const std::string text = read_file(path);
  return with_lines(text, [&] {
    const Json json = curve_json(text, path);
    const JsonNode file(path, json);
    if (file.has("curves")) file.at("curves").refuse("a list of curve-pairs", "one curve-pair");
    return one_curve(file, rest);
  });
}

std::vector<CurveFile> read_curves(const std::string& path, std::span<const CurveFile> rest) {
  const std::string text = read_file(path);
  return with_lines(text, [&] {
    const Json json = curve_json(text, path);
    return several(JsonNode(path, json), rest);
  });
}

}  // namespace tendril::scene
