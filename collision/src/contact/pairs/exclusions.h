#pragma once

#include <tendril/contact/rod_rod_contact.h>

#include <functional>

#include "contact/rod_line.h"

namespace tendril::contact {

/// Two edges near each other along the rods: pairs of their points are left out.
struct Excluded {
  std::uint64_t key;  ///< of the two
  bool whole;         ///< no points of theirs are ever in contact
  std::size_t first;  ///< else: where it says of which
};

/// Which points are near each other along the rods, as they rest, so that they are no contact: their way is
/// shorter than pi / 2 times the distance at which they meet, or shorter than eight times that and they rest
/// nearer than one and a half.
class Exclusions {
 public:
  /// The distance at which points of two edges come into each other's range.
  using Meets = std::function<double(std::uint32_t, std::uint32_t)>;

  /// Throws InvalidInput for joints of nodes that are not there.
  /// \param most  largest of these distances
  Exclusions(const RodLines& lines, const std::vector<RodJoint>& joints, double most, const Meets& meets);

  /// Null where no points of the two edges are left out. first < second.
  const Excluded* between(std::uint32_t first, std::uint32_t second) const;
  /// Of the points i and j of two edges that have some which are.
  /// \param columns  number of points of the second edge
  bool excludes(const Excluded& edges, std::size_t i, std::size_t j, std::size_t columns) const {
    return edges.whole || excluded_[edges.first + i * columns + j];
  }

 private:
  std::vector<Excluded> edges_;  // by ascending key
  std::vector<char> excluded_;
};

}  // namespace tendril::contact
