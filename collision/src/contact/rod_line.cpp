#include "rod_line.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tendril::contact {
namespace {

constexpr double kMostPoints = 1e7;  // of all rods

std::string place_of_rod(std::size_t i) {
  return "contact.rods[" + std::to_string(i) + "]";
}

void check_rod(const ContactRod& rod, std::size_t i) {
  if (!(rod.radius > 0.0 && std::isfinite(rod.radius)))
    throw InvalidInput(place_of_rod(i) + ".radius", std::to_string(rod.radius), "a positive length");
  if (rod.rest.size() < 2)
    throw InvalidInput(place_of_rod(i) + ".rest", std::to_string(rod.rest.size()) + " points", "at least 2");
  if (!all_finite(rod.rest)) throw InvalidInput(place_of_rod(i) + ".rest", "not finite", "finite points");
}

}  // namespace

double thickest(const std::vector<ContactRod>& rods) {
  if (rods.empty()) throw InvalidInput("contact.rods", "none", "at least one");
  double result = 0.0;
  for (std::size_t i = 0; i < rods.size(); ++i) {
    check_rod(rods[i], i);
    result = std::max(result, rods[i].radius);
  }
  return result;
}

RodLines::RodLines(std::vector<ContactRod> of, const Apart& apart) : rods(std::move(of)) {
  thickest(rods);
  for (std::uint32_t i = 0; i < rods.size(); ++i) {
    lay(i, apart(rods[i].radius));
    nodes += rods[i].rest.size();
  }
}

/// Points stand at the nodes and between them; each edge has those from its first node on, the last also its
/// end. A point's weight is half of what lies beside it, on either side.
void RodLines::lay(std::uint32_t rod, double apart) {
  const std::vector<Vec3>& rest = rods[rod].rest;
  double before = 0.0;
  for (std::uint32_t i = 0; i + 1 < rest.size(); ++i) {
    const double length = (rest[i + 1] - rest[i]).norm(), wanted = std::max(1.0, std::ceil(length / apart));
    if (!(wanted + static_cast<double>(points.size()) < kMostPoints))
      throw InvalidInput("contact.law.range", "a rod would need a point every " + std::to_string(apart),
                         "a range that less than 1e7 points along the rods are enough for");
    const auto parts = static_cast<std::size_t>(wanted);
    const double part = length / wanted;
    const bool last = i + 2 == rest.size();
    LineEdge edge{rod, i, static_cast<std::uint32_t>(nodes + i), static_cast<std::uint32_t>(points.size()),
                  0};
    const auto e = static_cast<std::uint32_t>(edges.size());
    for (std::size_t k = 0; k < parts + (last ? 1 : 0); ++k) {
      const double left = k == 0 ? before : part, right = k == parts ? 0.0 : part;
      points.push_back({e, static_cast<double>(k) / wanted, 0.5 * (left + right)});
    }
    before = part;
    edge.end = static_cast<std::uint32_t>(points.size());
    edges.push_back(edge);
  }
}

double RodLines::widest(const LineEdge& edge) const {
  const std::vector<Vec3>& rest = rods[edge.rod].rest;
  const bool last = edge.node + 2 == rest.size();
  const auto parts = static_cast<double>(edge.end - edge.first - (last ? 1 : 0));
  return kStretch * (rest[edge.node + 1] - rest[edge.node]).norm() / parts;
}

std::vector<Vec3> RodLines::positions(const StateView& state) const {
  std::vector<Vec3> result;
  result.reserve(nodes);
  for (const ContactRod& rod : rods) {
    const Points all = state.p.subspan(state.rods[rod.rod].first, rod.rest.size());
    result.insert(result.end(), all.begin(), all.end());
  }
  return result;
}

void RodLines::check(std::span<const NodeRange> scene) const {
  for (std::size_t i = 0; i < rods.size(); ++i) {
    const ContactRod& rod = rods[i];
    if (rod.rod >= scene.size())
      throw InvalidInput(place_of_rod(i) + ".rod", std::to_string(rod.rod),
                         "below the number of rods, " + std::to_string(scene.size()));
    if (rod.rest.size() != scene[rod.rod].count)
      throw InvalidInput(place_of_rod(i) + ".rest", std::to_string(rod.rest.size()) + " points",
                         "as many as the rod has masses, " + std::to_string(scene[rod.rod].count));
  }
}

}  // namespace tendril::contact
