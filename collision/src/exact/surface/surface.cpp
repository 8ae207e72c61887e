#include <tendril/base/error.h>
#include <tendril/exact/surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "exact/crossing.h"
#include "exact/narrow.h"
#include "exact/surface/boxes.h"
#include "exact/surface/inside.h"

namespace tendril::exact {

using collision::Box;

namespace {

void check(Points points, std::span<const std::uint32_t> corners) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (range_of({points.subspan(i, 1)}) == Range::not_finite)
      throw InvalidInput("Surface: points[" + std::to_string(i) + "]", "not finite", "finite coordinates");
  if (corners.size() % 3 != 0)
    throw InvalidInput("Surface: corners", std::to_string(corners.size()) + " of them",
                       "three for each triangle");
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (corners[i] >= points.size())
      throw InvalidInput("Surface: corners[" + std::to_string(i) + "]", std::to_string(corners[i]),
                         "an index below " + std::to_string(points.size()));
}

bool ordinary(Points points) {
  return points.empty() || range_of({points}) == Range::ordinary;
}

Range larger(bool ordinary, Range range) {
  return ordinary ? range : std::max(range, Range::extreme);
}

}  // namespace

Surface::Surface(Points points, std::span<const std::uint32_t> corners)
    : points_(points.begin(), points.end()), corners_(corners.begin(), corners.end()) {
  check(points, corners);
  tree_ = collision::BoxTree(boxes(points));
  ordinary_ = ordinary(points);
  closure_by_index_ = closure_of(corners_);
  find_closure();
}

void Surface::refit(Points points) {
  if (points.size() != points_.size())
    throw InvalidInput("Surface: points", std::to_string(points.size()),
                       std::to_string(points_.size()) + " as before");
  check(points, {});
  tree_.refit(boxes(points));
  points_.assign(points.begin(), points.end());
  ordinary_ = ordinary(points);
  find_closure();
}

void Surface::find_closure() {
  closure_ = closure_by_index_;
  if (closure_ != Closure::oriented)
    closure_ = std::max(closure_, closure_of(with_coincident_as_one(points_, corners_)));
}

Triangle Surface::triangle(std::size_t i) const {
  return {points_[corners_[3 * i]], points_[corners_[3 * i + 1]], points_[corners_[3 * i + 2]]};
}

std::vector<Box> Surface::boxes(Points points) const {
  std::vector<Box> out;
  out.reserve(size());
  for (std::size_t i = 0; i < size(); ++i)
    out.push_back(collision::box_of(
        std::array{points[corners_[3 * i]], points[corners_[3 * i + 1]], points[corners_[3 * i + 2]]}));
  return out;
}

Answer Surface::relation(const Shape& shape) const {
  const Range range = larger(ordinary_, range_of(shape));
  if (range == Range::not_finite) return undecidable(Reason::not_finite);
  const Shape query = reduced(Predicates(range), shape);
  const Box box = box_about(query);
  Relation most = Relation::free;
  tree_.descend([&](const Box& b) { return most != Relation::hit && b.meets(box); },
                [&](std::size_t i) {
                  most = std::max(most, exact::relation(range, query, exact::triangle(triangle(i))));
                });
  return {most};
}

std::vector<Meeting> Surface::meetings(const Shape& shape) const {
  std::vector<Meeting> out;
  const Range range = larger(ordinary_, range_of(shape));
  if (range == Range::not_finite) return out;
  const Box box = box_about(shape);
  tree_.descend([&](const Box& b) { return b.meets(box); },
                [&](std::size_t i) {
                  const Relation r = exact::relation(range, shape, exact::triangle(triangle(i)));
                  if (r != Relation::free) out.push_back({static_cast<std::uint32_t>(i), 0, r});
                });
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Meeting> Surface::meetings(const Surface& other) const {
  std::vector<Meeting> out;
  const Range range = ordinary_ && other.ordinary_ ? Range::ordinary : Range::extreme;
  tree_.pairs(other.tree_, [&](std::size_t i, std::size_t j) {
    const Relation r = exact::relation(range, triangle(i), other.triangle(j));
    if (r != Relation::free) out.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), r});
  });
  std::sort(out.begin(), out.end());
  return out;
}

Inside Surface::inside(const Vec3& point) const {
  const Range range = larger(ordinary_, range_of({Points(&point, 1)}));
  if (range == Range::not_finite) return {undecidable(Reason::not_finite)};
  const Predicates signs(range);
  const Shape query = exact::point(point);
  bool touching = false;
  Crossings crossed;
  tree_.descend([&](const Box& b) { return !touching && above_or_in(b, point); },
                [&](std::size_t i) {
                  const Triangle t = triangle(i);
                  touching = collision::box_of(t).holds(point) &&
                             exact::relation(range, query, exact::triangle(t)) != Relation::free;
                  if (!touching) crossed.add(crossing_above(signs, t, point));
                });
  if (touching) return {collision::kTouching};
  if (!closed()) return {undecidable(Reason::open), winding_about(point)};
  return {crossed.inside(closure_) ? collision::kHit : collision::kFree,
          static_cast<double>(crossed.winding)};
}

double Surface::winding_about(const Vec3& point) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) sum += solid_angle(triangle(i), point);
  return sum / (4 * std::numbers::pi);
}

Answer Surface::solid_relation(const Vec3& centre, double radius) const {
  const Answer surface = relation(ball(centre, radius));
  if (surface.relation == Relation::hit || surface.relation == Relation::undecidable) return surface;
  const Answer at_centre = inside(centre).answer;
  return at_centre.relation == Relation::free ? surface : at_centre;
}

Nearest Surface::nearest(const Shape& shape) const {
  Nearest best;
  best.distance.lower = best.distance.upper = std::numeric_limits<double>::infinity();
  best.distance.answer = undecidable(size() == 0 ? Reason::degenerate : Reason::not_finite);
  if (range_of(shape) == Range::not_finite || size() == 0) return best;
  const Box box = box_about(shape);
  bool found = false;
  tree_.nearest([&](const Box& b) { return boxes_apart(b, box); }, [&] { return best.distance.upper; },
                [&](std::size_t item) {
                  const auto i = static_cast<std::uint32_t>(item);
                  const Distance d = distance(shape, exact::triangle(triangle(i)));
                  const bool nearer =
                      d.upper < best.distance.upper || (d.upper == best.distance.upper && i < best.triangle);
                  if (!found || nearer) best = {d, i};
                  found = true;
                });
  return best;
}

}  // namespace tendril::exact
