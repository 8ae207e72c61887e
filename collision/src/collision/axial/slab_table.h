#pragma once

#include <tendril/curve/curve_pair.h>

#include <cstdint>

#include "slab.h"

namespace tendril::collision {

/// The slabs of some curve-pairs, every span of their knots cut into equal parts; all that a frame costs
/// before the first query. Slabs are numbered along each curve-pair, and from one to the next.
class SlabTable {
 public:
  /// \param rest    at least one
  /// \param wanted  slabs in all; as many as there are spans at least
  SlabTable(std::span<const CurvePair> rest, std::size_t wanted);

  std::size_t size() const { return slabs_.size(); }
  std::uint32_t slab_of(std::uint32_t pair, double t) const;

  /// About all points with records in the slabs [first, last], of one curve-pair, and in the range.
  Box box(std::uint32_t first, std::uint32_t last, const AxialRange& range);

  /// Bounds the spans whose control points are no longer the same doubles; O(control points + spans).
  /// InvalidInput unless the curve-pairs are on the knots of the rest.
  /// \param frame  ascending, above 0
  void pose(std::span<const CurvePair> posed, std::uint32_t frame);

  /// The last frame in which a point of the slabs [first, last] may have moved.
  std::uint32_t last_change(std::uint32_t first, std::uint32_t last) const;
  /// Slabs made since the last pose, spans among them, and how many of them have no frame.
  std::size_t made() const { return made_; }
  std::size_t unframed() const { return unframed_; }

 private:
  struct PairSpans {
    KnotVector knots;
    std::vector<std::uint32_t> span_at;  ///< of each knot index
    std::vector<Vec3> primary, orientation;
    std::vector<double> turn;
    std::uint32_t first_span = 0;
  };
  struct Span {
    std::uint32_t pair, first_slab, slabs;
    std::size_t first_control, count;
    double begin, length;
    SlabWeights weights{};
    SpanControls controls{};
    Slab whole{};
    std::uint32_t changed = 0;
    bool framed = false;  ///< all of it: nothing but these control points matters
  };
  void add_pair(const CurvePair& rest, std::size_t per_span);
  void change(Span& span, const CurvePair& posed, std::uint32_t frame);
  Slab make(const Span& span, const SlabWeights& weights);
  const Slab& slab(std::size_t index);

  std::vector<PairSpans> pairs_;
  std::vector<Span> spans_;
  std::vector<SlabWeights> weights_;
  std::vector<Slab> slabs_;
  std::vector<std::uint32_t> made_at_;  ///< frame of each slab
  std::vector<std::uint32_t> span_of_;
  std::size_t made_ = 0, unframed_ = 0;
};

}  // namespace tendril::collision
