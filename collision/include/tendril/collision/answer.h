#pragma once

/// What every test of the collision components answers: never a bare bool.
namespace tendril::collision {

/// Of two closed convex sets A and B by their Minkowski difference A - B = {a - b}: free when 0 lies outside
/// it, touching when 0 lies on its boundary (they meet, and an arbitrarily small translation parts them), hit
/// when 0 lies inside it (they meet, and go on meeting under every small enough translation). So triangles
/// that cross are hit; a vertex on a face, edges that meet and any coplanar overlap are touching. Of unions
/// of such sets (surfaces): hit if any pair is, else touching if any pair is.
enum class Relation { free, touching, hit, undecidable };

/// Why an answer is undecidable.
enum class Reason {
  none,
  not_finite,  ///< a coordinate or a radius is NaN or infinite, or a radius negative
  open,        ///< the inside was asked of a surface that has a border
  degenerate,  ///< the question has no answer: there is nothing to ask about (an empty surface)
  unbounded,   ///< the motion is not bounded by what is known of it
};

struct Answer {
  Relation relation = Relation::undecidable;
  Reason reason = Reason::none;

  friend bool operator==(const Answer&, const Answer&) = default;
};

inline constexpr Answer kFree{Relation::free}, kTouching{Relation::touching}, kHit{Relation::hit};

constexpr Answer undecidable(Reason reason) {
  return {Relation::undecidable, reason};
}

}  // namespace tendril::collision
