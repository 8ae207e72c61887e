#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tendril::runner {

/// Rows from the top, 8-bit sRGB, three bytes a pixel.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  Picture(int w, int h)
      : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 255) {}
  std::uint8_t* pixel(int x, int y) {
    return rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// The picture as a PNG file. The same picture gives the same bytes.
std::string png_bytes(const Picture& picture);

/// Pictures of one size side by side in `columns`, row after row, with a caption in each one's corner
/// (digits, letters of units, point and sign; other characters are left blank).
Picture contact_sheet(const std::vector<Picture>& panels, const std::vector<std::string>& captions,
                      int columns);

}  // namespace tendril::runner
