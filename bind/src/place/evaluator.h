#pragma once

#include "layout.h"
#include "mesh/parallel.h"
#include "sweep.h"

namespace tendril::bind {

/// At 2 to 4 ns a point, fewer take no longer than a thread takes to start.
constexpr std::size_t kPointsWorthAThread = 32768;

/// Evaluates a binding on posed curve-pairs, in numbers of type T.
///
/// Two passes: the loops of sweep.h write the points of a span's nearest projections in binding order, and
/// flag the ones whose frame is near degenerate, which evaluate_by_rule() then overwrites; blend() adds the
/// shares that points have in nodes, whose maps are found once.
template <class T>
class Evaluator {
 public:
  using Numbers = BindingLayout::Numbers<T>;
  Evaluator(const BindingLayout& layout, const Numbers& numbers, std::span<const CurvePair> posed)
      : layout_(layout), numbers_(numbers), posed_(posed) {
    layout.require_same_knots(posed);
    base_ = BindingLayout::base_of(posed);
    rounded_base_ = {static_cast<T>(base_.x()), static_cast<T>(base_.y()), static_cast<T>(base_.z())};
  }

  /// All points, in binding order.
  void update(const ColumnsView<T>& out, int threads) const;
  /// All points, in the mesh's order.
  template <class Row>
  void update(Row* out, int threads) const;

  /// The points named, in their order.
  template <class Row>
  void some(std::span<const std::uint32_t> points, Row* out) const;
  Triple<T> one(std::size_t point) const;

  using Pieces = std::vector<Piece<T>>;
  /// Slots [begin, end) of an order of nearest projections, the first of them to out[0]; blends are left out.
  /// \param records  from slot `begin` on
  void evaluate(const Pieces& pieces, const Order& order, const RecordsView<T>& records, std::size_t begin,
                std::size_t end, const ColumnsView<T>& out) const {
    evaluate(pieces, order, order.index_of_run(begin), records, begin, end, out);
  }
  /// \param run  the index of that of slot `begin`, or of an earlier one
  void evaluate(const Pieces& pieces, const Order& order, std::size_t run, const RecordsView<T>& records,
                std::size_t begin, std::size_t end, const ColumnsView<T>& out) const;
  /// The point of a blend.
  /// \param nearest  where its nearest projection takes it
  /// \param map_of   of a node's index
  template <class MapOf>
  TENDRIL_INLINE Triple<T> blended(const BindingLayout::Blend& blend, const Triple<T>& nearest,
                                   const MapOf& map_of) const {
    return rounded_base_ + mix(layout_.shares_of(numbers_, blend), map_of, layout_.place_of(numbers_, blend),
                               nearest - rounded_base_);
  }
  /// Of all nodes.
  std::vector<AffineMap<T>> maps(const Pieces& pieces) const;

 private:
  AffineMap<T> map(std::size_t node, const Piece<double>& piece) const {
    const AxisNode& at = layout_.nodes[node];
    return map_of<T>(at, piece, posed_[at.pair], base_);
  }
  /// Slots of one run; true when one was left to the second pass.
  static bool evaluate_run(const Piece<T>& piece, bool off, const RecordsView<T>& records, std::size_t count,
                           const ColumnsView<T>& out);
  void mend_degenerate(const Piece<T>& piece, const Order& order, const RecordsView<T>& records,
                       const Run& part, const ColumnsView<T>& out) const;
  Triple<T> evaluate_by_rule(std::uint32_t entry) const;
  /// \param piece_of  of a span's index
  template <class PieceOf>
  Triple<T> evaluate_slot(const PieceOf& piece_of, const Order& order, const Records<T>& records,
                          std::size_t slot) const;
  template <class PieceOf, class MapOf>
  Triple<T> one(std::size_t point, const PieceOf& piece_of, const MapOf& map_of) const;
  template <class Access>
  void blend(const Pieces& pieces, const Access& access, int threads) const;
  template <class Access>
  struct BlendSome;

  const BindingLayout& layout_;
  const Numbers& numbers_;
  std::span<const CurvePair> posed_;
  Vec3 base_;               ///< of the pose
  Triple<T> rounded_base_;  ///< the same in these numbers
};

template <class T>
Triple<T> Evaluator<T>::evaluate_by_rule(std::uint32_t entry) const {
  const Vec3 p = from_axial(posed_[layout_.pair_of(entry)], layout_.entries[entry]);
  return {static_cast<T>(p.x()), static_cast<T>(p.y()), static_cast<T>(p.z())};
}

/// Where the loops found the frame near degenerate: by the rules of CurvePair::frame.
template <class T>
void Evaluator<T>::mend_degenerate(const Piece<T>& piece, const Order& order, const RecordsView<T>& records,
                                   const Run& part, const ColumnsView<T>& out) const {
  for (std::size_t i = part.begin; i < part.end; ++i) {
    if (!evaluate_one(piece, part.off, records.from(i - part.begin)).fault) continue;
    const Triple<T> p = evaluate_by_rule(order.entry[i]);
    out.x[i - part.begin] = p.x;
    out.y[i - part.begin] = p.y;
    out.z[i - part.begin] = p.z;
  }
}

template <class T>
bool Evaluator<T>::evaluate_run(const Piece<T>& piece, bool off, const RecordsView<T>& records,
                                std::size_t count, const ColumnsView<T>& out) {
  if (!piece.turned) return sweep(piece, off, records, out, count);
  constexpr std::size_t kBlock = 256;
  std::array<T, kBlock> u, v;
  bool fault = false;
  for (std::size_t at = 0; at < count; at += kBlock) {
    const std::size_t some = std::min(kBlock, count - at);
    const RecordsView<T> turned = turn_records(piece, records.from(at), some, u.data(), v.data());
    fault = sweep(piece, off, turned, out.from(at), some) || fault;
  }
  return fault;
}

template <class T>
void Evaluator<T>::evaluate(const Pieces& pieces, const Order& order, std::size_t first,
                            const RecordsView<T>& records, std::size_t begin, std::size_t end,
                            const ColumnsView<T>& out) const {
  for (std::size_t i = first; i < order.runs.size() && order.runs[i].begin < end; ++i) {
    const Run& run = order.runs[i];
    if (run.end <= begin) continue;
    const Run part{run.span, std::max(run.begin, static_cast<std::uint32_t>(begin)),
                   std::min(run.end, static_cast<std::uint32_t>(end)), run.off};
    const ColumnsView<T> to = out.from(part.begin - begin);
    const RecordsView<T> from = records.from(part.begin - begin);
    if (evaluate_run(pieces[part.span], part.off, from, part.end - part.begin, to))
      mend_degenerate(pieces[part.span], order, from, part, to);
  }
}

template <class T>
template <class PieceOf>
Triple<T> Evaluator<T>::evaluate_slot(const PieceOf& piece_of, const Order& order, const Records<T>& records,
                                      std::size_t slot) const {
  const Run& run = order.run_of(slot);
  const Piece<T>& piece = piece_of(run.span);
  T u, v;
  const RecordsView<T> given = records.from(slot);
  const RecordsView<T> record = piece.turned ? turn_records(piece, given, 1, &u, &v) : given;
  const Evaluated<T> evaluated = evaluate_one(piece, run.off, record);
  return evaluated.fault ? evaluate_by_rule(order.entry[slot]) : evaluated.point;
}

template <class T>
template <class PieceOf, class MapOf>
Triple<T> Evaluator<T>::one(std::size_t point, const PieceOf& piece_of, const MapOf& map_of) const {
  layout_.require_point(point);
  const Triple<T> nearest = evaluate_slot(piece_of, layout_.nearest, numbers_.nearest, layout_.slot[point]);
  const BindingLayout::Blend* blend = layout_.blend_of(point);
  return blend ? blended(*blend, nearest, map_of) : nearest;
}

template <class T>
Triple<T> Evaluator<T>::one(std::size_t point) const {
  auto pieces = on_demand<double>(layout_.spans, posed_);
  return one(
      point,
      [&](std::uint32_t span) { return pose<T>(layout_.spans[span], posed_[layout_.spans[span].pair]); },
      [&](std::uint32_t node) { return map(node, pieces[layout_.nodes[node].span]); });
}

template <class T>
template <class Row>
void Evaluator<T>::some(std::span<const std::uint32_t> points, Row* out) const {
  auto pieces = on_demand<T>(layout_.spans, posed_);
  const auto piece_of = [&](std::uint32_t span) -> const Piece<T>& { return pieces[span]; };
  auto exact = on_demand<double>(layout_.spans, posed_);
  const auto make = [&](std::uint32_t node) { return map(node, exact[layout_.nodes[node].span]); };
  OnDemand<AffineMap<T>, decltype(make)> made(layout_.nodes.size(), make);
  const auto map_of = [&](std::uint32_t node) -> const AffineMap<T>& { return made[node]; };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Triple<T> p = one(points[i], piece_of, map_of);
    out[i] = Row(p.x, p.y, p.z);
  }
}

template <class T>
std::vector<AffineMap<T>> Evaluator<T>::maps(const Pieces& pieces) const {
  std::vector<AffineMap<T>> out;
  out.reserve(layout_.nodes.size());
  const auto add_all = [&](auto& exact) {
    for (std::size_t k = 0; k < layout_.nodes.size(); ++k)
      out.push_back(map(k, exact[layout_.nodes[k].span]));
  };
  if constexpr (std::is_same_v<T, double>) {
    add_all(pieces);
  } else {
    auto exact = on_demand<double>(layout_.spans, posed_);
    add_all(exact);
  }
  return out;
}

/// Blends [begin, end), on one vector unit.
template <class T>
template <class Access>
struct Evaluator<T>::BlendSome {
  static TENDRIL_INLINE void run(const Evaluator& of, const AffineMap<T>* maps, const Access& access,
                                 std::size_t begin, std::size_t end) {
    const auto map_of = [maps](std::uint32_t node) -> const AffineMap<T>& { return maps[node]; };
    for (std::size_t b = begin; b < end; ++b) {
      const BindingLayout::Blend& blend = of.layout_.blends[b];
      access.write(blend.point, of.blended(blend, access.read(blend.point), map_of));
    }
  }
};

/// Adds their shares in nodes to the points that have some.
/// \param access  reads and writes a point by its index in the mesh
template <class T>
template <class Access>
void Evaluator<T>::blend(const Pieces& pieces, const Access& access, int threads) const {
  if (layout_.blends.empty()) return;
  const std::vector<AffineMap<T>> all = maps(pieces);
  in_parts(layout_.blends.size(), threads, [&](std::size_t begin, std::size_t end) {
    OnUnits<BlendSome<Access>>::run(widest_unit(), *this, all.data(), access, begin, end);
  });
}

template <class T>
void Evaluator<T>::update(const ColumnsView<T>& out, int threads) const {
  const Pieces pieces = pose<T>(layout_.spans, posed_);
  in_parts(layout_.size, threads, kPointsWorthAThread, [&](std::size_t begin, std::size_t end) {
    evaluate(pieces, layout_.nearest, numbers_.nearest.from(begin), begin, end, out.from(begin));
  });
  struct Access {
    const ColumnsView<T>& out;
    const std::vector<std::uint32_t>& slot;
    Triple<T> read(std::size_t i) const { return {out.x[slot[i]], out.y[slot[i]], out.z[slot[i]]}; }
    void write(std::size_t i, const Triple<T>& p) const {
      out.x[slot[i]] = p.x;
      out.y[slot[i]] = p.y;
      out.z[slot[i]] = p.z;
    }
  };
  blend(pieces, Access{out, layout_.slot}, threads);
}

template <class T>
template <class Row>
void Evaluator<T>::update(Row* out, int threads) const {
  constexpr std::size_t kBlock = 512;  // columns that stay in the fastest cache until they are rows
  const Pieces pieces = pose<T>(layout_.spans, posed_);
  in_parts(layout_.size, threads, kPointsWorthAThread, [&](std::size_t begin, std::size_t end) {
    std::array<T, kBlock> x, y, z;
    for (std::size_t at = begin; at < end; at += kBlock) {
      const std::size_t count = std::min(kBlock, end - at);
      evaluate(pieces, layout_.nearest, numbers_.nearest.from(at), at, at + count,
               {x.data(), y.data(), z.data()});
      for (std::size_t i = 0; i < count; ++i) out[layout_.nearest.entry[at + i]] = Row(x[i], y[i], z[i]);
    }
  });
  struct Access {
    Row* out;
    Triple<T> read(std::size_t i) const { return {out[i].x(), out[i].y(), out[i].z()}; }
    void write(std::size_t i, const Triple<T>& p) const { out[i] = Row(p.x, p.y, p.z); }
  };
  blend(pieces, Access{out}, threads);
}

}  // namespace tendril::bind
