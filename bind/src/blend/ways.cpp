#include "ways.h"

#include <algorithm>
#include <cmath>

#include "mesh/parallel.h"

namespace tendril::bind {
namespace {

constexpr double kMost = 2.302585092994046;  ///< log 10
constexpr double kSlope = 1.0;               ///< of the logarithm, by length over distance
constexpr double kDetour = 1.08;             ///< by which a way along edges and diagonals may be too long
constexpr double kSlack = 2.0;               ///< voxels that a way is taken to be shorter

}  // namespace

Ways::Ways(std::span<const CurveProjector> projectors, BodyGrid& grid, const CurveDistances& distances,
           int threads) {
  if (projectors.size() < 2) return;
  std::vector<const BSpline*> curves;
  for (const CurveProjector& projector : projectors) curves.push_back(&projector.curve());
  grid.empty_pockets(curves);
  for (const BSpline* curve : curves) grid.fill_about(*curve);
  log_.resize(projectors.size());
  std::vector<std::vector<float>> ways(projectors.size());
  in_parts(projectors.size(), threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) ways[k] = grid.ways_from(projectors[k].curve());
  });
  const std::size_t nodes = grid.nodes().size();
  std::vector<bool> reached(nodes, false);
  for (const auto& way : ways)
    for (std::size_t i = 0; i < nodes; ++i) reached[i] = reached[i] || std::isfinite(way[i]);
  in_parts(projectors.size(), threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const bool any = std::any_of(ways[k].begin(), ways[k].end(), [](float w) { return std::isfinite(w); });
      const std::vector<double>& nearest = distances.to(static_cast<std::uint32_t>(k));
      std::vector<double>& log = log_[k];
      log.assign(nodes, 0.0);
      for (std::size_t i = 0; any && i < nodes; ++i) {
        if (!reached[i]) continue;
        log[i] = kMost;
        if (!std::isfinite(ways[k][i])) continue;
        const double way = static_cast<double>(ways[k][i]) / kDetour - kSlack * grid.spacing();
        const double straight = std::max(nearest[i], grid.spacing());
        log[i] = way > straight ? std::min(kMost, 2.0 * std::log(way / straight)) : 0.0;
      }
      bound_growth(
          grid.nodes(), grid.neighbours(), [&](std::uint32_t i) -> double& { return log[i]; },
          [&](std::uint32_t i, double length) {
            return kSlope * length / std::max(grid.spacing(), nearest[i]);
          });
    }
  });
}

}  // namespace tendril::bind
