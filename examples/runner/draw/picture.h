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

/// Writes into a picture: digits, letters (capitals, but for those of units), point, dash, underscore and
/// sign; other characters are left blank, and what lies beyond the picture is left out.
/// \param left, top  pixel of the first letter's corner
/// \param scale      pixels a dot; letters are 5 by 7 dots
void draw_text(Picture& picture, const std::string& text, int left, int top, int scale);

/// Pictures of one size side by side in `columns`, row after row, with a caption in each one's corner.
Picture contact_sheet(const std::vector<Picture>& panels, const std::vector<std::string>& captions,
                      int columns);

}  // namespace tendril::runner
