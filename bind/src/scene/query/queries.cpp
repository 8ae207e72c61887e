#include <tendril/base/file.h>
#include <tendril/scene/queries.h>

#include "scene/json/line_of.h"
#include "scene/json/schema.h"

namespace tendril::scene {
namespace {

/// One value for each entry of a list, where the file has it.
template <class Read>
auto each(const JsonNode& file, const char* key, Read&& read) {
  std::vector<decltype(read(file))> out;
  if (!file.has(key)) return out;
  const JsonNode list = file.at(key);
  for (std::size_t i = 0; i < list.size(); ++i) out.push_back(read(list.at(i)));
  return out;
}

Queries queries_of(const JsonNode& file) {
  Queries out;
  out.points = each(file, "points", [](const JsonNode& p) { return p.vec3(); });
  out.balls = each(file, "balls", [](const JsonNode& b) {
    return QueryBall{b.at("centre").vec3(), b.at("radius").positive()};
  });
  out.segments = each(file, "segments", [](const JsonNode& s) {
    return std::array<Vec3, 2>{s.at(std::size_t{0}).vec3(), s.at(1).vec3()};
  });
  out.triangles = each(file, "triangles", [](const JsonNode& t) {
    return std::array<Vec3, 3>{t.at(std::size_t{0}).vec3(), t.at(1).vec3(), t.at(2).vec3()};
  });
  if (out.points.size() + out.balls.size() + out.segments.size() + out.triangles.size() == 0)
    file.refuse("no queries", "at least one of points, balls, segments and triangles");
  return out;
}

}  // namespace

Queries parse_queries(std::string_view text, const std::string& name) {
  return with_lines(text, [&] {
    const Json json = parse_json(text, name);
    require_schema(json, kQueriesSchema, name);
    return queries_of(JsonNode(name, json));
  });
}

Queries read_queries(const std::string& path) {
  return parse_queries(read_file(path), path);
}

}  // namespace tendril::scene
