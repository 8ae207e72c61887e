#include "draw/picture.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace tendril::runner {
namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7;

struct Glyph {
  char character;
  std::array<std::uint8_t, kGlyphHeight> rows;  ///< five bits a row, the leftmost highest
};

constexpr std::array<Glyph, 14> kGlyphs{{
    {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}},
    {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'2', {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}},
    {'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
    {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}},
    {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}},
    {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}},
    {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}},
    {'s', {0x00, 0x00, 0x0e, 0x10, 0x0e, 0x01, 0x1e}},
    {'t', {0x08, 0x08, 0x1c, 0x08, 0x08, 0x09, 0x06}},
    {'=', {0x00, 0x00, 0x1f, 0x00, 0x1f, 0x00, 0x00}},
}};

void draw_glyph(Picture& picture, const Glyph& glyph, int left, int top, int scale) {
  for (int y = 0; y < kGlyphHeight * scale; ++y) {
    for (int x = 0; x < kGlyphWidth * scale; ++x) {
      const bool ink =
          ((glyph.rows[static_cast<std::size_t>(y / scale)] >> (kGlyphWidth - 1 - x / scale)) & 1) != 0;
      if (!ink || left + x >= picture.width || top + y >= picture.height) continue;
      std::fill_n(picture.pixel(left + x, top + y), 3, std::uint8_t{90});
    }
  }
}

void draw_text(Picture& picture, const std::string& text, int left, int top, int scale) {
  for (const char c : text) {
    const auto* glyph =
        std::find_if(kGlyphs.begin(), kGlyphs.end(), [c](const Glyph& g) { return g.character == c; });
    if (glyph != kGlyphs.end()) draw_glyph(picture, *glyph, left, top, scale);
    left += (kGlyphWidth + 1) * scale;
  }
}

}  // namespace

std::string png_bytes(const Picture& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("PNG: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

Picture contact_sheet(const std::vector<Picture>& panels, const std::vector<std::string>& captions,
                      int columns) {
  constexpr int gap = 4;
  const int count = static_cast<int>(panels.size());
  const int rows = (count + columns - 1) / columns;
  const int width = panels.front().width, height = panels.front().height;
  Picture sheet(columns * (width + gap) - gap, rows * (height + gap) - gap);
  for (int i = 0; i < count; ++i) {
    Picture panel = panels[static_cast<std::size_t>(i)];
    draw_text(panel, captions[static_cast<std::size_t>(i)], 10, 10, std::max(1, height / 140));
    const int left = (i % columns) * (width + gap), top = (i / columns) * (height + gap);
    for (int y = 0; y < height; ++y) std::copy_n(panel.pixel(0, y), 3 * width, sheet.pixel(left, top + y));
  }
  return sheet;
}

}  // namespace tendril::runner
