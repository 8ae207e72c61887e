#pragma once

#include <tendril/collision/box_tree.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tendril::contact {

/// Boxes in single precision, rounded outwards, one coordinate after the other, so that a loop over them is
/// vector code.
class FloatBoxes {
 public:
  void take(const std::vector<collision::Box>& boxes);
  /// Some of others.
  void take(const FloatBoxes& from, const std::vector<std::uint32_t>& which);

  /// Of the boxes [begin, end), those that meet one.
  void meeting(const collision::Box& box, std::uint32_t begin, std::uint32_t end,
               std::vector<std::uint32_t>& which) const;
  /// Those that meet the box of others with that index.
  void meeting(const FloatBoxes& others, std::uint32_t index, std::vector<std::uint32_t>& which) const;

 private:
  using One = std::array<float, 6>;  ///< least coordinates, then the negative of the largest
  static One rounded(const collision::Box& box);
  void meeting(const One& box, std::uint32_t begin, std::uint32_t end,
               std::vector<std::uint32_t>& which) const;

  std::array<std::vector<float>, 6> side_;
};

}  // namespace tendril::contact
