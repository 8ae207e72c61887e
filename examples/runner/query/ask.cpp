#include "query/ask.h"

#include <algorithm>
#include <limits>

namespace tendril::runner {
namespace {

using exact::Answer;
using exact::Relation;
using exact::Shape;

template <class Surface>
Finding common(Surface& s, const Shape& shape, std::string name) {
  Finding out;
  out.query = std::move(name);
  out.answer = out.surface = s.relation(shape);
  out.meetings = s.meetings(shape);
  out.nearest = s.nearest(shape);
  const bool free = out.surface.relation == Relation::free;
  out.side = free ? s.inside(shape.points[0]) : exact::Inside{collision::kTouching};
  return out;
}

template <class Surface>
std::vector<Finding> ask_all(Surface& s, const scene::Queries& queries) {
  std::vector<Finding> out;
  const auto name = [](const char* list, std::size_t i) { return list + std::to_string(i); };
  for (std::size_t i = 0; i < queries.points.size(); ++i) {
    out.push_back(common(s, exact::point(queries.points[i]), name("points/", i)));
    out.back().answer = out.back().side.answer;
  }
  for (std::size_t i = 0; i < queries.balls.size(); ++i) {
    const auto& [centre, radius] = queries.balls[i];
    out.push_back(common(s, exact::ball(centre, radius), name("balls/", i)));
    out.back().answer = s.solid_relation(centre, radius);
  }
  for (std::size_t i = 0; i < queries.segments.size(); ++i)
    out.push_back(common(s, exact::segment(queries.segments[i]), name("segments/", i)));
  for (std::size_t i = 0; i < queries.triangles.size(); ++i)
    out.push_back(common(s, exact::triangle(queries.triangles[i]), name("triangles/", i)));
  return out;
}

Relation most_of(const std::vector<exact::Meeting>& pairs) {
  Relation most = Relation::free;
  for (const exact::Meeting& pair : pairs) most = std::max(most, pair.relation);
  return most;
}

template <class Surface>
Parts parts_in(Surface& s, const std::vector<Vec3>& parts) {
  Parts out;
  for (const Vec3& x : parts) {
    const Relation r = s.inside(x).answer.relation;
    ++(r == Relation::hit ? out.within : r == Relation::free ? out.outside : out.undecidable);
  }
  return out;
}

/// Triangle by triangle of the other.
template <class Surface>
void find_nearest(Surface& s, const exact::Surface& other, MeshFinding& out) {
  out.nearest.distance.upper = std::numeric_limits<double>::infinity();
  for (std::uint32_t j = 0; j < other.size(); ++j) {
    const exact::Nearest near = s.nearest(exact::triangle(other.triangle(j)));
    if (!(near.distance.upper < out.nearest.distance.upper)) continue;
    out.nearest = near;
    out.nearest_other = j;
  }
}

}  // namespace

std::vector<Finding> ask(Target& target, const scene::Queries& queries) {
  return std::visit([&](auto& s) { return ask_all(s, queries); }, target.surface);
}

MeshFinding ask(Target& target, Target& other) {
  MeshFinding out;
  auto& its = std::get<exact::Surface>(other.surface);
  std::visit(
      [&](auto& mine) {
        out.pairs = mine.meetings(its);
        out.surfaces = {most_of(out.pairs)};
        if (!out.pairs.empty()) {
          out.nearest.distance.answer = out.surfaces;
          out.nearest.triangle = out.pairs[0].triangle;
          out.nearest_other = out.pairs[0].other;
          return;
        }
        find_nearest(mine, its, out);
        out.parts_of_other = parts_in(mine, other.parts);
        out.parts_of_target = parts_in(its, target.parts);
      },
      target.surface);
  return out;
}

}  // namespace tendril::runner
