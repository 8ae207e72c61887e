#include "curve_distances.h"

#include "mesh/parallel.h"

namespace tendril::bind {

CurveDistances::CurveDistances(std::span<const CurveProjector> projectors, Points nodes, int threads) {
  of_.assign(projectors.size(), std::vector<double>(nodes.size()));
  in_parts(nodes.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < projectors.size(); ++k) {
      const std::vector<Projection> nearest = projectors[k].nearest(nodes.subspan(begin, end - begin));
      for (std::size_t i = begin; i < end; ++i) of_[k][i] = nearest[i - begin].distance;
    }
  });
}

}  // namespace tendril::bind
