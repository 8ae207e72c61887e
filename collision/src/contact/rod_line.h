#pragma once

#include <tendril/contact/rod_contact.h>

#include <cstdint>
#include <functional>

namespace tendril::contact {

/// A place on a rod that is followed as a point of its line.
struct LinePoint {
  std::uint32_t edge;  ///< of those of the lines
  double fraction;     ///< along it
  double weight;       ///< its share of the rest length
};

/// An edge of a rod in contact, and its points [first, end).
struct LineEdge {
  std::uint32_t rod;     ///< of those in contact
  std::uint32_t node;    ///< its first, of the rod's
  std::uint32_t global;  ///< that node among the nodes of all rods in contact
  std::uint32_t first, end;
};

/// By how much an edge may lengthen before its points stand too far apart.
constexpr double kStretch = 1.25;

/// The largest radius of rods that are fit for it; throws InvalidInput for others.
double thickest(const std::vector<ContactRod>& rods);

/// Rods as points along their lines, so close that what happens between them is known.
struct RodLines {
  /// How far apart points of a rod of that radius may be.
  using Apart = std::function<double(double radius)>;

  /// Throws InvalidInput for rods that are none, and for more than 10^7 points.
  RodLines(std::vector<ContactRod> rods, const Apart& apart);

  std::vector<ContactRod> rods;
  std::vector<LineEdge> edges;
  std::vector<LinePoint> points;
  std::size_t nodes = 0;  ///< of all rods in contact

  /// Flat index of an edge's first node in a state.
  std::size_t node_of(const StateView& state, const LineEdge& edge) const {
    return state.rods[rods[edge.rod].rod].first + edge.node;
  }
  /// The way between two points of an edge that is stretched by a quarter.
  double widest(const LineEdge& edge) const;
  /// Positions of all nodes of rods in contact.
  std::vector<Vec3> positions(const StateView& state) const;
  /// InvalidInput where a rod is not of the scene, or has another number of masses there.
  void check(std::span<const NodeRange> scene) const;

 private:
  void lay(std::uint32_t rod, double apart);
};

/// The point of an edge between a and b.
inline Vec3 between(const Vec3& a, const Vec3& b, double fraction) {
  return a + fraction * (b - a);
}

}  // namespace tendril::contact
