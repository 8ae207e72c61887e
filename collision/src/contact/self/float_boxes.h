#pragma once

#include <tendril/collision/box_tree.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tendril::contact {

/// Boxes in single precision, rounded outwards, one coordinate after the other, so that a loop over them is
/// vector code. They stay, or go straight from one place to another, and then meet where on each side they do
/// at the beginning or the end.
class FloatBoxes {
 public:
  /// So many, of which none is known so far.
  /// \param ends  1 where they stay, 2 where they go
  void resize(std::size_t count, std::size_t ends);
  void take(std::size_t index, std::size_t end, const collision::Box& box);
  /// Some of others.
  void take(const FloatBoxes& from, const std::vector<std::uint32_t>& which);

  /// Of the boxes [begin, end), those that meet one.
  /// \param box  at as many ends
  void meeting(const std::vector<collision::Box>& box, std::uint32_t begin, std::uint32_t end,
               std::vector<std::uint32_t>& which) const;
  /// Those that meet the box of others with that index.
  void meeting(const FloatBoxes& others, std::uint32_t index, std::vector<std::uint32_t>& which) const;

 private:
  using One = std::array<float, 12>;  ///< least coordinates, the negative of the largest; then at the end
  static void round(const collision::Box& box, std::size_t end, One& one);
  void meeting(const One& box, std::uint32_t begin, std::uint32_t end,
               std::vector<std::uint32_t>& which) const;

  std::size_t ends_ = 1;
  std::array<std::vector<float>, 12> side_;
};

}  // namespace tendril::contact
