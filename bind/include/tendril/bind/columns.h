#pragma once

#include <span>

namespace tendril::bind {

/// Points as three arrays of equal length: what vector units and graphics cards read fastest.
template <class T>
struct Columns {
  std::span<T> x;  ///< first coordinates
  std::span<T> y;  ///< second coordinates
  std::span<T> z;  ///< third coordinates
};

}  // namespace tendril::bind
