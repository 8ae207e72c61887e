#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/box_queries.h>
#include <tendril/collision/placed_nearest.h>

namespace tendril::collision {

/// A hierarchy of boxes over the triangles of a mesh that follows curve-pairs, made once, in axial space. A
/// pose costs the bounds of at most some hundred slabs of the curve-pairs, whatever the size of the mesh;
/// boxes are made from these where a query comes, and only cells of at most 64 triangles that it enters are
/// deformed and boxed exactly. A deformed triangle lies in the hull of its three corners, so convex boxes
/// about the corners hold all of it, and no query is ever projected onto a curve (after [James and Pai 2004],
/// [Kavan and Zara 2005], for curve frames). Containment is proven (slab bounds in interval arithmetic); the
/// boxes of triangles that a query sees are exact for the very doubles that an update of the whole mesh
/// gives.
///
/// What a query finds does not depend on what was asked before. Queries change what is kept: one thread at a
/// time. Memory: about 70 bytes a triangle.
class TENDRIL_COLLISION_API AxialHierarchy {
 public:
  /// Throws InvalidInput for indices out of range, 2^31 triangles or more, and options out of range.
  /// \param rest       the curve-pairs in their rest shapes
  /// \param points     bound to them; not kept
  /// \param triangles  of indices into the points; degenerate ones are allowed
  /// \param options    see there
  AxialHierarchy(std::span<const CurvePair> rest, const BoundPoints& points,
                 std::span<const Triangle> triangles, const HierarchyOptions& options = {});

  /// What follows is about this pose. Boxes of slabs whose control points are as they were are kept.
  void pose(std::span<const CurvePair> posed) { cells_.pose(posed); }
  /// Deforms and boxes everything, as queries do by themselves once they have touched enough of it.
  void refit() { cells_.refit(); }
  HierarchyWork work() const { return cells_.work(); }          ///< since the last pose
  std::size_t size() const { return cells_.triangle_count(); }  ///< number of triangles

  /// Calls visit(triangle) for the triangles of which enter(box) holds, and held for every box above. enter
  /// must hold for a box about a box it holds for.
  template <class Enter, class Visit>
  void descend(Enter&& enter, Visit&& visit) {
    descend(cells_.root(), enter, visit);
  }

  /// Triangles whose boxes meet the box.
  template <class Visit>
  void meeting(const Box& box, Visit&& visit) {
    descend([&](const Box& other) { return box.meets(other); }, visit);
  }
  /// Triangles whose boxes come within `radius` of `centre`, or seem to by a rounding.
  template <class Visit>
  void near(const Vec3& centre, double radius, Visit&& visit) {
    const double limit = radius * radius * (1.0 + 0x1p-48);
    descend([&](const Box& box) { return !(square_distance(box, centre) > limit); }, visit);
  }
  /// Triangles whose boxes the segment from a to b meets, or seems to by a rounding.
  template <class Visit>
  void along(const Vec3& a, const Vec3& b, Visit&& visit) {
    descend([&](const Box& box) { return segment_meets(box, a, b); }, visit);
  }

  /// As BoxTree::nearest: the triangles with distance(box) not more than bound(), the nearer boxes first.
  template <class Distance, class Bound, class Visit>
  void nearest(Distance&& distance, Bound&& bound, Visit&& visit) {
    collision::nearest(cells_, cells_.root(), distance, bound, visit);
  }
  /// Calls visit(triangle, other's triangle) for all pairs whose boxes meet. Of one hierarchy with itself
  /// every pair is met both ways round, and every triangle meets itself.
  template <class Visit>
  void pairs(AxialHierarchy& other, Visit&& visit) {
    pairs(cells_.root(), other, other.cells_.root(), visit);
  }

 private:
  using Node = PlacedCells::Node;

  template <class Enter, class Visit>
  void descend(const Node& n, Enter& enter, Visit& visit) {
    if (!enter(cells_.box(n)) || (cells_.open(n) && !enter(cells_.box(n)))) return;
    if (n.leaf()) {
      cells_.triangles(n, [&](const PlacedTriangle& triangle) {
        if (enter(triangle.box)) visit(triangle);
      });
    } else {
      descend(n.left(), enter, visit);
      descend(n.right(), enter, visit);
    }
  }

  template <class Visit>
  void pairs(const Node& a, AxialHierarchy& other, const Node& b, Visit& visit) {
    if (!cells_.box(a).meets(other.cells_.box(b))) return;
    const bool opened = cells_.open(a);
    if ((other.cells_.open(b) || opened) && !cells_.box(a).meets(other.cells_.box(b))) return;
    if (a.leaf() && b.leaf()) {
      cells_.triangles(a, [&](const PlacedTriangle& mine) {
        other.cells_.triangles(b, [&](const PlacedTriangle& its) {
          if (mine.box.meets(its.box)) visit(mine, its);
        });
      });
      return;
    }
    const bool first = !a.leaf() && (b.leaf() || a.size() >= b.size());
    pairs(first ? a.left() : a, other, first ? b : b.left(), visit);
    pairs(first ? a.right() : a, other, first ? b : b.right(), visit);
  }

  PlacedCells cells_;
};

}  // namespace tendril::collision
