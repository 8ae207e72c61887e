#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/box_tree.h>
#include <tendril/exact/distance.h>

#include <cstdint>
#include <vector>

namespace tendril::exact {

/// A triangle that a shape or another triangle meets.
struct Meeting {
  std::uint32_t triangle;  ///< of this surface
  std::uint32_t other;     ///< of the other surface; 0 for a shape
  Relation relation;       ///< touching or hit

  /// By the triangle, then the other.
  friend auto operator<=>(const Meeting&, const Meeting&) = default;
};

/// What encloses: nothing; a surface each of whose edges belongs to an even number of triangles; one of whose
/// edges as many triangles go one way round as the other.
enum class Closure : unsigned char { open, even, oriented };

/// Where a point lies to what a surface encloses.
struct Inside {
  /// hit within, touching on the surface, free outside; undecidable: open, or not finite.
  Answer answer;
  /// Times that the surface goes round the point: a whole number where it is closed (meaningful where its
  /// triangles are oriented alike); the generalised winding number [Jacobson et al. 2013],
  /// rounded, where it is open: about 1 within what it nearly encloses, about 0 outside. 0 for a point on the
  /// surface.
  double winding = 0.0;
};

/// The triangle of a surface that is nearest to a shape.
struct Nearest {
  Distance distance;           ///< on_b is on the surface
  std::uint32_t triangle = 0;  ///< the first with the least upper bound
};

/// Triangles under a hierarchy of boxes; degenerate ones are what is left of them. Answers are those of all
/// triangles looked at one by one.
class TENDRIL_EXACT_API Surface {
 public:
  /// \param points   no triangle need use them all
  /// \param corners  three indices into the points for each triangle
  /// Throws InvalidInput for points that are not finite, indices out of range, and a number of them not
  /// divisible by 3.
  Surface(Points points, std::span<const std::uint32_t> corners);

  /// The same triangles elsewhere: O(n) where no triangle's neighbour is one by place alone, else O(n log n).
  /// Throws InvalidInput for another number of points or as above; then nothing changed.
  void refit(Points points);

  /// The number of triangles.
  std::size_t size() const { return corners_.size() / 3; }
  /// As it is now; i < size().
  Triangle triangle(std::size_t i) const;
  /// The boxes of the triangles.
  const collision::BoxTree& tree() const { return tree_; }

  /// Every edge belongs to an even number of triangles, where points that coincide are one: then each point
  /// not on the surface is inside or outside.
  bool closed() const { return closure_ != Closure::open; }
  /// And how: what an oriented surface goes round, however often, is inside, so that parts that overlap are
  /// one solid and a shell turned inward is a cavity; else the parity of crossings counts.
  Closure closure() const { return closure_; }

  /// With the surface itself, not with its inside.
  Answer relation(const Shape& shape) const;
  /// All triangles met, in order. None for shapes that are not finite.
  std::vector<Meeting> meetings(const Shape& shape) const;
  /// All pairs that meet, in order. For a surface and itself, neighbours touch.
  std::vector<Meeting> meetings(const Surface& other) const;

  /// By the crossings of a vertical ray (closure()), moved aside by less than any number where it meets an
  /// edge [Edelsbrunner and Muecke 1990]; exact. Open surfaces: O(n).
  Inside inside(const Vec3& point) const;

  /// A ball, or a point for radius 0, with the surface and all that it encloses: undecidable(open) where the
  /// answer needs an inside that there is not.
  Answer solid_relation(const Vec3& centre, double radius) const;

  /// Undecidable(degenerate) where there are no triangles.
  Nearest nearest(const Shape& shape) const;

 private:
  std::vector<collision::Box> boxes(Points points) const;
  double winding_about(const Vec3& point) const;
  void find_closure();

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> corners_;
  collision::BoxTree tree_;
  bool ordinary_ = true;
  Closure closure_by_index_ = Closure::open, closure_ = Closure::open;
};

}  // namespace tendril::exact
