#include <tendril/base/error.h>
#include <tendril/collision/axial_sections.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace tendril::collision {
namespace {

void check(std::span<const AxialPoint> records, std::span<const Triangle> triangles, std::size_t regions,
           double allowance) {
  if (regions < 1) throw InvalidInput("regions", "0", "1 or more");
  if (!(allowance >= 0.0)) throw InvalidInput("allowance", std::to_string(allowance), "0 or more");
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t corner : triangles[i])
      if (corner >= records.size())
        throw InvalidInput("triangles[" + std::to_string(i) + "]", "point " + std::to_string(corner),
                           "less than " + std::to_string(records.size()));
}

double largest(std::span<const AxialPoint> records) {
  double most = 0.0;
  for (const AxialPoint& at : records)
    most = std::max({most, std::abs(at.u), std::abs(at.v), std::abs(at.w)});
  return most;
}

/// In the eight directions of an octagon.
std::array<double, 8> directions(double u, double v) {
  return {u, -u, v, -v, u + v, -u - v, u - v, v - u};
}

}  // namespace

AxialSections::Region AxialSections::empty() {
  Region region;
  region.reach.fill(-std::numeric_limits<double>::infinity());
  return region;
}

void AxialSections::take_in(double u, double v, Region& region) {
  const std::array<double, 8> at = directions(u, v);
  for (std::size_t k = 0; k < 8; ++k) region.reach[k] = std::max(region.reach[k], at[k]);
  region.radius = std::max(region.radius, std::hypot(u, v));
}

AxialSections::AxialSections(std::span<const AxialPoint> records, std::span<const Triangle> triangles,
                             const KnotVector& knots, Section section, std::size_t regions, double allowance)
    : section_(section),
      start_(knots.start()),
      length_(knots.end() - knots.start()),
      before_(empty()),
      after_(empty()) {
  check(records, triangles, regions, allowance);
  regions_.assign(regions, empty());
  for (const auto& [a, b, c] : triangles) add(records[a], records[b], records[c], allowance * length_);
  const double more = allowance * largest(records);
  const auto widen = [&](Region& region) {
    for (double& reach : region.reach) reach += 2.0 * more;
    if (region.radius >= 0.0) region.radius += 2.0 * more;
    region.deepest += more;
  };
  std::for_each(regions_.begin(), regions_.end(), widen);
  widen(before_);
  widen(after_);
}

/// All corners of a triangle to every region that it may have a point in.
void AxialSections::add(const AxialPoint& a, const AxialPoint& b, const AxialPoint& c, double over) {
  const std::array<AxialPoint, 3> corner{a, b, c};
  const auto [low, high] = std::minmax({a.t, b.t, c.t});
  for (std::size_t i = region_of(low - over); i <= region_of(high + over); ++i)
    for (const AxialPoint& p : corner) take_in(p.u, p.v, regions_[i]);
  const auto end_region = [&](bool beyond, double sign, Region& region) {
    if (!beyond) return;
    for (const AxialPoint& p : corner) {
      take_in(p.u, p.v, region);
      region.deepest = std::max(region.deepest, sign * p.w);
    }
  };
  end_region(low <= start_, -1.0, before_);
  end_region(high >= start_ + length_, 1.0, after_);
}

std::size_t AxialSections::region_of(double t) const {
  const auto count = static_cast<double>(regions_.size());
  return static_cast<std::size_t>(std::clamp((t - start_) / length_ * count, 0.0, count - 1.0));
}

bool AxialSections::holds(const Region& region, double u, double v) const {
  if (section_ == Section::circle) return std::hypot(u, v) <= region.radius;
  const std::array<double, 8> at = directions(u, v);
  const std::size_t count = section_ == Section::box ? 4 : 8;
  for (std::size_t k = 0; k < count; ++k)
    if (at[k] > region.reach[k]) return false;
  return true;
}

bool AxialSections::holds(const AxialPoint& e) const {
  if (holds(regions_[region_of(e.t)], e.u, e.v) && start_ < e.t && e.t < start_ + length_) return true;
  if (e.t <= start_ && -e.w <= before_.deepest && holds(before_, e.u, e.v)) return true;
  if (e.t >= start_ + length_ && e.w <= after_.deepest && holds(after_, e.u, e.v)) return true;
  return false;
}

}  // namespace tendril::collision
