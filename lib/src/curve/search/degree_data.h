#pragma once

#include <cmath>

#include "curve/distance/capsule_tree.h"
#include "curve/distance/projector_data.h"
#include "describe.h"
#include "projection_batch.h"

namespace tendril {

template <int P>
std::array<Vec3, P + 1> absolute(const search::Control<P>& points) {
  std::array<Vec3, P + 1> out;
  for (std::size_t i = 0; i <= P; ++i) out[i] = {points[i].x, points[i].y, points[i].z};
  return out;
}

/// Halves a Bezier piece `times` times and appends the parts.
template <int P>
void divide(const search::Piece<P>& piece, int times, std::vector<search::Piece<P>>& out) {
  if (times == 0) {
    out.push_back(piece);
    return;
  }
  search::Interval<P> left;
  left.points = search::relative<P>(piece, Vec3::Zero());
  left.low = 0.0;
  left.high = 1.0;
  left.depth = 0;
  const search::Interval<P> right = left.halve();
  const double middle = piece.parameter(0.5);
  divide<P>({absolute<P>(left.points), piece.begin, middle}, times - 1, out);
  divide<P>({absolute<P>(right.points), middle, piece.end}, times - 1, out);
}

/// How often to halve: more parts are resolved at once, and are more to choose from. By the mean over the
/// spans of how far the control points lie from the chord, in chords.
inline int halvings(const std::vector<BezierPiece>& pieces) {
  double bend = 0.0;
  for (const BezierPiece& piece : pieces) {
    const Capsule capsule = around(piece.points);
    const double chord = capsule.axis.norm();
    bend += capsule.radius < chord ? capsule.radius / chord : 1.0;
  }
  bend /= static_cast<double>(pieces.size());
  return bend > 0.2 ? 2 : bend > 0.14 ? 1 : 0;
}

template <int P>
std::vector<search::Piece<P>> sub_pieces(const BSpline& curve) {
  std::vector<search::Piece<P>> pieces;
  const std::vector<BezierPiece> whole = curve.bezier_pieces();
  const int times = P == 1 ? 0 : halvings(whole);
  for (const BezierPiece& bezier : whole) {
    search::Piece<P> piece{{}, bezier.begin, bezier.end};
    std::copy(bezier.points.begin(), bezier.points.end(), piece.points.begin());
    divide<P>(piece, times, pieces);
  }
  return pieces;
}

template <int P>
std::vector<Vec3> all_points(const std::vector<search::Piece<P>>& pieces) {
  std::vector<Vec3> points;
  for (const auto& piece : pieces) points.insert(points.end(), piece.points.begin(), piece.points.end());
  return points;
}

template <int P>
struct DataOfDegree final : CurveProjector::Data {
  explicit DataOfDegree(const BSpline& c)
      : Data(c),
        pieces(sub_pieces<P>(curve)),
        fine(search::fine_pieces<P>(curve)),
        tree(all_points<P>(pieces), P + 1) {}

  Found find(const Vec3& p, const search::Bounds& bounds, double hint) const override {
    search::Search<P> search(curve, p, bounds);
    const std::size_t first = std::isnan(hint) ? pieces.size() : piece_at(hint);
    if (first < pieces.size()) search.examine(pieces[first]);
    tree.descend(
        p, [&] { return search.cut(); },
        [&](std::size_t piece) {
          if (piece != first) search.examine(pieces[piece]);
        });
    search.finish();
    return {search.t(), search.least()};
  }

  std::unique_ptr<Batch> batch() const override { return make_batch<P>(*this, pieces, tree); }

  std::vector<Projection> describe(Points points, std::span<const Found> found) const override {
    return describe_all<P>(*this, points, found);
  }

  std::size_t piece_at(double t) const {
    const auto after =
        std::upper_bound(pieces.begin(), pieces.end(), t,
                         [](double at, const search::Piece<P>& piece) { return at < piece.begin; });
    return after == pieces.begin() ? 0 : static_cast<std::size_t>(after - pieces.begin()) - 1;
  }

  std::vector<search::Minimum> sweep(const Vec3& p, double cut, double blur) const override {
    std::vector<std::size_t> near;
    tree.descend(
        p, [&] { return cut; }, [&](std::size_t piece) { near.push_back(piece); });
    std::sort(near.begin(), near.end());
    search::MinimaRecorder recorder(curve, p, cut, blur);
    search::Sweep<P> examiner(p, cut, blur, recorder);
    const std::size_t parts = pieces.size() / fine.size();
    std::size_t expected = 0;
    for (const std::size_t i : near) {
      if (i != expected) recorder.beyond_band(pieces[i].begin);
      examiner.examine(pieces[i], fine[i / parts], static_cast<int>(i % parts), static_cast<int>(parts));
      expected = i + 1;
    }
    if (expected == pieces.size()) {
      recorder.trend(1, curve.knots().end());
    } else {
      recorder.beyond_band(curve.knots().end());
    }
    return recorder.take_all();
  }

  std::vector<search::Piece<P>> pieces;
  std::vector<search::FinePiece<P>> fine;
  CapsuleTree tree;
};

}  // namespace tendril
