#pragma once

/// What every test of the collision components answers: never a bare bool.
namespace tendril::collision {

/// Of two closed convex sets A and B by their Minkowski difference A - B = {a - b}: free when 0 lies outside
/// it, touching when 0 lies on its boundary (they meet, and an arbitrarily small translation parts them), hit
/// when 0 lies inside it (they meet, and go on meeting under every small enough translation). So triangles
/// that cross are hit; a vertex on a face, edges that meet and any coplanar overlap are touching. Of unions
/// of such sets (surfaces): hit if any pair is, else touching if any pair is.
enum class Relation {
  free,        ///< apart
  touching,    ///< in contact, without an inner point in common
  hit,         ///< in contact under every small enough translation
  undecidable  ///< see Reason
};

/// Why an answer is undecidable.
enum class Reason {
  none,        ///< it is decided
  not_finite,  ///< a coordinate or a radius is NaN or infinite, or a radius negative
  open,        ///< the inside was asked of a surface that has a border
  degenerate,  ///< the question has no answer: there is nothing to ask about (an empty surface)
  unbounded,   ///< the motion is not bounded by what is known of it
  rounding,    ///< closer than doubles can tell, of tests in doubles alone: tendril::exact decides
};

/// A relation, and why there is none.
struct Answer {
  Relation relation = Relation::undecidable;  ///< of the two sets
  Reason reason = Reason::none;               ///< none unless undecidable

  /// Memberwise.
  friend bool operator==(const Answer&, const Answer&) = default;
};

inline constexpr Answer kFree{Relation::free};          ///< apart
inline constexpr Answer kTouching{Relation::touching};  ///< in contact
inline constexpr Answer kHit{Relation::hit};            ///< inner points in common

/// The answer that there is none.
constexpr Answer undecidable(Reason reason) {
  return {Relation::undecidable, reason};
}

}  // namespace tendril::collision
