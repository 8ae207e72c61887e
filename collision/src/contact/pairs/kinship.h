#pragma once

#include <tendril/contact/rod_rod_contact.h>

#include "contact/rod_line.h"

namespace tendril::contact {

/// The ways along rods and through joints between the ends of two edges, at rest; infinite where longer than
/// asked for.
struct Ways {
  std::uint64_t key;  ///< of the two edges
  double way[2][2];   ///< from the first's ends to the second's
};

/// Which edges are near each other along the rods, as they rest.
class Kinship {
 public:
  /// Throws InvalidInput for joints of nodes that are not there.
  /// \param reach  ways longer than this are not asked for
  Kinship(const RodLines& lines, const std::vector<RodJoint>& joints, double reach);

  /// Null where all points of the two edges are farther apart than the reach. first < second.
  const Ways* between(std::uint32_t first, std::uint32_t second) const;

 private:
  std::vector<Ways> ways_;  // by ascending key
};

}  // namespace tendril::contact
