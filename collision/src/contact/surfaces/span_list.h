#pragma once

#include <tendril/dynamics/rod_points.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "span_motion.h"

namespace tendril::contact {

/// The spans that vertices are bound to, numbered as they turn up; each keeps how far off the curve what it
/// carries reaches, since a turn of its frames moves that by as much times the angle.
class SpanList {
 public:
  SpanList(const RodPoints& points, std::vector<UsedSpan>& spans) : points_(points), spans_(spans) {
    for (const std::size_t rod : points.rods()) knots_.push_back(&points.curves().knots(rod));
  }

  /// Those of a vertex, appended.
  void of(std::uint32_t vertex, std::vector<std::uint32_t>& out) {
    points_.points().shares(vertex, shares_);
    for (const BoundShare& share : shares_) {
      const KnotVector& knots = *knots_.at(share.pair);
      const int span = knots.span(share.record.t);
      const auto [at, added] = number_.try_emplace({share.pair, span}, spans_.size());
      if (added) spans_.emplace_back(share.pair, knots, span);
      const AxialPoint& r = share.record;
      const double far = std::abs(r.u) + std::abs(r.v) + std::abs(r.w);
      spans_[at->second].reach = std::max(spans_[at->second].reach, far);
      out.push_back(static_cast<std::uint32_t>(at->second));
    }
  }

 private:
  const RodPoints& points_;
  std::vector<UsedSpan>& spans_;
  std::vector<const KnotVector*> knots_;
  std::map<std::pair<std::uint32_t, int>, std::size_t> number_;
  std::vector<BoundShare> shares_;
};

}  // namespace tendril::contact
