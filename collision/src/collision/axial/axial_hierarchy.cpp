#include <tendril/base/error.h>
#include <tendril/collision/axial_hierarchy.h>

#include <string>

#include "cell_order.h"

namespace tendril::collision {
namespace {

void check(std::span<const CurvePair> rest, const BoundPoints& points, std::span<const Triangle> triangles,
           const HierarchyOptions& options) {
  if (rest.empty()) throw InvalidInput("rest", "no curve-pair", "at least one");
  if (triangles.empty() || triangles.size() >= 0x7fffffff)
    throw InvalidInput("triangles", std::to_string(triangles.size()) + " of them", "1 to 2^31 - 1");
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t corner : triangles[i])
      if (corner >= points.size())
        throw InvalidInput("triangles[" + std::to_string(i) + "]", "point " + std::to_string(corner),
                           "less than " + std::to_string(points.size()));
  if (options.most_slabs < 1 || options.most_slabs > 65536)
    throw InvalidInput("most_slabs", std::to_string(options.most_slabs), "1 to 65536");
  if (!(options.refit_share > 0.0))
    throw InvalidInput("refit_share", std::to_string(options.refit_share), "above 0");
}

const HierarchyOptions& checked(std::span<const CurvePair> rest, const BoundPoints& points,
                                std::span<const Triangle> triangles, const HierarchyOptions& options) {
  check(rest, points, triangles, options);
  return options;
}

}  // namespace

AxialHierarchy::AxialHierarchy(std::span<const CurvePair> rest, const BoundPoints& points,
                               std::span<const Triangle> triangles, const HierarchyOptions& options)
    : cells_(rest, points, triangles, checked(rest, points, triangles, options)) {}

}  // namespace tendril::collision
