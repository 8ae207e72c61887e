#include "tears.h"

#include <algorithm>

namespace tendril::bind {
namespace {

void halve(const SurfaceBinder& binder, std::span<const CurvePair> posed, std::vector<Piece>& pieces,
           int threads) {
  std::vector<Vec3> middles, at(pieces.size());
  std::vector<std::uint32_t> faces;
  for (const Piece& piece : pieces) {
    middles.push_back(0.5 * (piece.rest[0] + piece.rest[1]));
    faces.push_back(piece.face);
  }
  binder.bind(middles, faces).update(posed, at, threads);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Piece& piece = pieces[i];
    const std::size_t away = (at[i] - piece.posed[0]).norm() < (at[i] - piece.posed[1]).norm() ? 0 : 1;
    piece.rest[away] = middles[i];
    piece.posed[away] = at[i];
  }
}

}  // namespace

Limits find_limits(const SurfaceBinder& binder, std::span<const CurvePair> posed, std::vector<Piece> pieces,
                   double least_gap, double shortest, int threads) {
  Limits out;
  const auto is_done = [&](const Piece& piece) {
    if (piece.gap() < least_gap) {
      if (piece.length() > 0.0) out.steepest = std::max(out.steepest, piece.gap() / piece.length());
      return true;
    }
    if (piece.length() > shortest) return false;
    out.tears.push_back({piece.rest[0], piece.gap()});
    return true;
  };
  for (std::erase_if(pieces, is_done); !pieces.empty(); std::erase_if(pieces, is_done))
    halve(binder, posed, pieces, threads);
  return out;
}

}  // namespace tendril::bind
