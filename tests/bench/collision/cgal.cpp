#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include "bench/collision/peers.h"

namespace tendril::bench {

void cgal_meet(std::span<const test::TrianglePair> pairs, std::span<char> out) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto convert = [](const std::array<Vec3, 3>& t) {
    const auto point = [](const Vec3& x) { return Kernel::Point_3(x.x(), x.y(), x.z()); };
    return Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2]));
  };
  for (std::size_t i = 0; i < pairs.size(); ++i)
    out[i] = CGAL::do_intersect(convert(pairs[i].a), convert(pairs[i].b)) ? 1 : 0;
}

}  // namespace tendril::bench
