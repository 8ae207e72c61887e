#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// What an AxialHierarchy is made from and with, and what it says of its work.
namespace tendril::collision {

/// Indices of three points.
using Triangle = std::array<std::uint32_t, 3>;

/// How an AxialHierarchy is made and used.
struct HierarchyOptions {
  /// Slabs: 0.6 times the root of the number of cells, at least 24, at most this; a span has at least one.
  std::size_t most_slabs = 256;
  /// The share of cells in a pose after which all others are deformed and boxed too.
  double refit_share = 0.25;
};

/// What the last pose and the queries since have cost.
struct HierarchyWork {
  std::size_t slabs = 0;     ///< bounded anew, spans among them; the others were kept or not asked for
  std::size_t unframed = 0;  ///< of these, only the length of the frame's axes is known
  std::size_t boxes = 0;     ///< made from slabs
  std::size_t cells = 0;     ///< in all
  std::size_t touched = 0;   ///< cells that queries entered
  std::size_t placed = 0;    ///< cells deformed
  bool refitted = false;     ///< all of them
};

}  // namespace tendril::collision
