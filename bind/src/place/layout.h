#pragma once

#include <tendril/bind/binding.h>

#include "records.h"
#include "spans.h"

namespace tendril::bind {

/// Neighbouring slots on one span.
struct Run {
  std::uint32_t span, begin, end;
  bool off;  ///< the normal planes: w is more than rounding
};

/// Records sorted by span, those off their normal plane last, in either part in the order given.
struct Order {
  std::vector<std::uint32_t> entry;  ///< of each slot
  std::vector<Run> runs;

  const Run& run_of(std::size_t slot) const;
};

/// A binding on flat arrays. Its entries are the nearest projection of every point, then their other
/// records, point after point.
struct BindingLayout {
  std::vector<KnotVector> knots;  ///< of each curve-pair
  std::size_t size = 0;           ///< points
  std::vector<AxialPoint> entries;
  std::vector<std::uint32_t> pair;  ///< of each entry; empty when there is one curve-pair

  /// Points with several shares: their others are the entries size + [begin, end).
  struct Blend {
    std::uint32_t point, begin, end;
  };
  std::vector<Blend> blends;         ///< ascending
  std::vector<double> share;         ///< of the entries after size
  std::vector<std::uint32_t> owner;  ///< their points
  std::vector<double> kept;          ///< per point, the share of its nearest projection; empty without blends

  std::vector<Span> spans;
  Order nearest, others;
  std::vector<std::uint32_t> slot, other_slot;  ///< of each point, of each entry after size

  /// The records in the order of the slots.
  template <class T>
  struct Numbers {
    Records<T> nearest, others;
  };
  Numbers<double> numbers;

  std::uint32_t pair_of(std::size_t entry) const { return pair.empty() ? 0 : pair[entry]; }
  const Blend* blend_of(std::size_t point) const;
  /// Fills what follows from the entries: spans, orders, slots, numbers.
  /// \param negligible  w that is left out of the numbers [length]
  void arrange(double negligible);
  /// InvalidInput unless the curve-pairs are on the knots of the rest.
  void require_same_knots(std::span<const CurvePair> posed) const;
  void require_point(std::size_t point) const;
};

}  // namespace tendril::bind
