#pragma once

#include <tendril/bind/binding.h>

#include "axis_nodes.h"

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
  /// The first run that does not end before the slot.
  std::size_t index_of_run(std::size_t slot) const;
};

/// A binding on flat arrays. Its entries are the nearest projection of every point; what else points are
/// bound to are shares in nodes of the axes.
struct BindingLayout {
  std::vector<KnotVector> knots;  ///< of each curve-pair
  std::size_t size = 0;           ///< points
  std::vector<AxialPoint> entries;
  std::vector<std::uint32_t> pair;  ///< of each entry; empty when there is one curve-pair

  /// A point with shares in nodes, which are [begin, end) of them.
  struct Blend {
    std::uint32_t point, begin, end;
  };
  std::vector<Blend> blends;        ///< ascending
  std::vector<std::uint32_t> node;  ///< of each share
  std::vector<AxisNode> nodes;      ///< those with shares, by span
  Vec3 rest_base = Vec3::Zero();    ///< what nodes and places of blends at rest are relative to
  std::vector<double> kept;         ///< per point, the share of its nearest projection; empty without blends

  std::vector<Span> spans;
  Order nearest;
  std::vector<std::uint32_t> slot;  ///< of each point

  template <class T>
  struct Numbers {
    Records<T> nearest;            ///< in the order of the slots
    std::vector<T> share;          ///< in nodes
    std::vector<Triple<T>> place;  ///< of each blend's point at rest, from rest_base
  };
  Numbers<double> numbers;

  std::uint32_t pair_of(std::size_t entry) const { return pair.empty() ? 0 : pair[entry]; }
  const Blend* blend_of(std::size_t point) const;
  template <class T>
  NodeShares<T> shares_of(const Numbers<T>& of, const Blend& blend) const {
    return {node.data() + blend.begin, of.share.data() + blend.begin, blend.end - blend.begin};
  }
  template <class T>
  const Triple<T>& place_of(const Numbers<T>& of, const Blend& blend) const {
    return of.place[static_cast<std::size_t>(&blend - blends.data())];
  }
  /// A blend's point in the frame of one of its shares' nodes, at rest.
  AxialPoint record(const Blend& blend, std::size_t share) const;
  /// What a pose is relative to where blends take shares in it.
  static Vec3 base_of(std::span<const CurvePair> pairs);

  /// Makes the spans; before any node.
  void make_spans();
  /// \param pair  whose place t it is, at rest
  AxisNode make_node(std::uint32_t pair, double t, const CurvePair& rest) const;
  /// Fills what follows from the entries and the shares: orders, slots, numbers.
  /// \param negligible  w that is left out of the numbers [length]
  void arrange(double negligible);
  /// InvalidInput unless the curve-pairs are on the knots of the rest.
  void require_same_knots(std::span<const CurvePair> posed) const;
  void require_point(std::size_t point) const;

 private:
  std::uint32_t span_of(std::uint32_t pair, double t) const;
  std::vector<std::vector<std::uint32_t>> span_index_;  ///< per curve-pair, of each of its knots
};

}  // namespace tendril::bind
