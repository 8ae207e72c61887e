#include <tendril/base/error.h>
#include <tendril/exact/bound_surface.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "exact/narrow.h"
#include "exact/surface/boxes.h"
#include "exact/surface/inside.h"

namespace tendril::exact {

using collision::Box;
using collision::PlacedTriangle;

namespace {

// A vertex is a combination of control points and of unit frames made from their differences: below this,
// squares and triple products on the way stay finite, and so does every corner that predicates see.
constexpr double kLargest = 0x1p200;

void check(std::span<const CurvePair> pairs) {
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (const BSpline* curve : {&pairs[k].primary(), &pairs[k].orientation()})
      for (const Vec3& x : curve->control_points())
        if (!(x.cwiseAbs().maxCoeff() <= kLargest))
          throw InvalidInput("BoundSurface: curve-pair " + std::to_string(k), "a control point beyond 2^200",
                             "coordinates of at most 2^200");
}

/// All that a point's place in any pose depends on.
using Coordinates = std::vector<double>;

Coordinates coordinates_of(const BoundPoints& points, std::size_t i, std::vector<BoundShare>& shares) {
  points.shares(i, shares);
  Coordinates out;
  for (const BoundShare& p : shares)
    out.insert(out.end(),
               {static_cast<double>(p.pair), p.weight, p.record.t, p.record.u, p.record.v, p.record.w});
  return out;
}

/// The corners with one of all points that are bound alike in each one's stead: these are at the same place
/// in every pose.
std::vector<std::uint32_t> with_alike_as_one(const BoundPoints& points,
                                             std::span<const std::uint32_t> corners) {
  std::vector<BoundShare> shares;
  std::vector<Coordinates> all;
  for (std::size_t i = 0; i < points.size(); ++i) all.push_back(coordinates_of(points, i, shares));
  std::vector<std::uint32_t> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return all[a] < all[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && all[order[i - 1]] == all[order[i]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  std::vector<std::uint32_t> out;
  for (const std::uint32_t c : corners) out.push_back(first[c]);
  return out;
}

/// Asked of the binding once, not of positions in each pose: what points bound alike sew up stays so, and
/// what only happens to coincide in a pose does not count.
Closure closure(const BoundPoints& points, std::span<const collision::Triangle> triangles) {
  std::vector<std::uint32_t> corners;
  for (const collision::Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
  const Closure by_index = closure_of(corners);
  if (by_index == Closure::oriented) return by_index;
  return std::max(by_index, closure_of(with_alike_as_one(points, corners)));
}

Shape shape_of(const PlacedTriangle& t) {
  return exact::triangle(t.corners);
}

}  // namespace

BoundSurface::BoundSurface(std::span<const CurvePair> rest, const BoundPoints& points,
                           std::span<const collision::Triangle> triangles,
                           const collision::HierarchyOptions& options)
    : hierarchy_((check(rest), rest), points, triangles, options),
      closure_(exact::closure(points, triangles)) {}

void BoundSurface::pose(std::span<const CurvePair> posed) {
  check(posed);
  hierarchy_.pose(posed);
}

Answer BoundSurface::relation(const Shape& shape) {
  if (range_of(shape) == Range::not_finite) return undecidable(Reason::not_finite);
  // A hit cannot be outdone: from there on nothing is entered, and no cell deformed.
  const Box box = box_about(shape);
  Relation most = Relation::free;
  hierarchy_.descend(
      [&](const Box& b) { return most != Relation::hit && b.meets(box); },
      [&](const PlacedTriangle& t) { most = std::max(most, exact::relation(shape, shape_of(t)).relation); });
  return {most};
}

std::vector<Meeting> BoundSurface::meetings(const Shape& shape) {
  std::vector<Meeting> out;
  if (range_of(shape) == Range::not_finite) return out;
  hierarchy_.meeting(box_about(shape), [&](const PlacedTriangle& t) {
    const Relation r = exact::relation(shape, shape_of(t)).relation;
    if (r != Relation::free) out.push_back({t.index, 0, r});
  });
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Meeting> BoundSurface::meetings(const Surface& other) {
  std::vector<Meeting> out;
  // The other's tree is asked for each box of ours before what is in it is deformed: deforming a cell costs
  // far more than a descent that finds nothing.
  const auto meets_some = [&](const Box& box) {
    bool some = false;
    other.tree().descend([&](const Box& b) { return !some && b.meets(box); },
                         [&](std::size_t) { some = true; });
    return some;
  };
  hierarchy_.descend(meets_some, [&](const PlacedTriangle& t) {
    other.tree().descend([&](const Box& b) { return b.meets(t.box); },
                         [&](std::size_t j) {
                           const Relation r = exact::relation(t.corners, other.triangle(j)).relation;
                           if (r != Relation::free)
                             out.push_back({t.index, static_cast<std::uint32_t>(j), r});
                         });
  });
  std::sort(out.begin(), out.end());
  return out;
}

Inside BoundSurface::inside(const Vec3& point) {
  const Shape query = exact::point(point);
  if (range_of(query) == Range::not_finite) return {undecidable(Reason::not_finite)};
  bool touching = false;
  Crossings crossed;
  hierarchy_.descend([&](const Box& b) { return !touching && above_or_in(b, point); },
                     [&](const PlacedTriangle& t) {
                       touching = t.box.holds(point) &&
                                  exact::relation(query, shape_of(t)).relation != Relation::free;
                       if (touching) return;
                       // Triangles are known one by one, so the range of numbers is, too: an extreme one
                       // elsewhere makes no other test slow.
                       const Predicates signs(std::max(range_of(query), range_of(shape_of(t))));
                       crossed.add(crossing_above(signs, t.corners, point));
                     });
  if (touching) return {collision::kTouching};
  if (!closed()) return {undecidable(Reason::open), winding_about(point)};
  return {crossed.inside(closure_) ? collision::kHit : collision::kFree,
          static_cast<double>(crossed.winding)};
}

/// Every triangle has its solid angle, so nothing can be left out.
double BoundSurface::winding_about(const Vec3& point) {
  double sum = 0.0;
  hierarchy_.descend([](const Box&) { return true; },
                     [&](const PlacedTriangle& t) { sum += solid_angle(t.corners, point); });
  return sum / (4 * std::numbers::pi);
}

Answer BoundSurface::solid_relation(const Vec3& centre, double radius) {
  const Answer surface = relation(ball(centre, radius));
  if (surface.relation == Relation::hit || surface.relation == Relation::undecidable) return surface;
  const Answer at_centre = inside(centre).answer;
  return at_centre.relation == Relation::free ? surface : at_centre;
}

Nearest BoundSurface::nearest(const Shape& shape) {
  Nearest best;
  best.distance.lower = best.distance.upper = std::numeric_limits<double>::infinity();
  best.distance.answer = undecidable(Reason::not_finite);
  if (range_of(shape) == Range::not_finite) return best;
  const Box box = box_about(shape);
  bool found = false;
  hierarchy_.nearest([&](const Box& b) { return boxes_apart(b, box); }, [&] { return best.distance.upper; },
                     [&](const PlacedTriangle& t) {
                       const Distance d = distance(shape, shape_of(t));
                       // Of equals the first, as of the whole mesh: the order of visits is the pose's.
                       const bool nearer = d.upper < best.distance.upper ||
                                           (d.upper == best.distance.upper && t.index < best.triangle);
                       if (!found || nearer) best = {d, t.index};
                       found = true;
                     });
  return best;
}

}  // namespace tendril::exact
