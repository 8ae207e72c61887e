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
  /// \param parts  of the same length that each is cut into
  SpanList(const RodPoints& points, std::vector<UsedSpan>& spans, int parts = 1)
      : points_(points), spans_(spans), parts_(parts) {
    for (const std::size_t rod : points.rods()) knots_.push_back(&points.curves().knots(rod));
  }

  /// Those of a vertex, appended.
  void of(std::uint32_t vertex, std::vector<std::uint32_t>& out) {
    points_.points().shares(vertex, shares_);
    for (const BoundShare& share : shares_) {
      const KnotVector& knots = *knots_.at(share.pair);
      const int span = knots.span(share.record.t), part = part_of(knots, span, share.record.t);
      const auto [at, added] = number_.try_emplace({share.pair, parts_ * span + part}, spans_.size());
      if (added) spans_.emplace_back(share.pair, knots, span, part, parts_);
      const AxialPoint& r = share.record;
      const double far = std::abs(r.u) + std::abs(r.v) + std::abs(r.w);
      spans_[at->second].reach = std::max(spans_[at->second].reach, far);
      out.push_back(static_cast<std::uint32_t>(at->second));
    }
  }

 private:
  int part_of(const KnotVector& knots, int span, double t) const {
    const auto i = static_cast<std::size_t>(span);
    const double from = knots.knots()[i], share = (t - from) / (knots.knots()[i + 1] - from);
    return std::clamp(static_cast<int>(share * parts_), 0, parts_ - 1);
  }

  const RodPoints& points_;
  std::vector<UsedSpan>& spans_;
  int parts_;
  std::vector<const KnotVector*> knots_;
  std::map<std::pair<std::uint32_t, int>, std::size_t> number_;
  std::vector<BoundShare> shares_;
};

}  // namespace tendril::contact
