#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "import_values.h"

namespace tendril::bind {

/// How far outside its range a color may be by rounding, in shares of the range; it is taken to the end.
inline constexpr double kColorSlack = 1e-3;

/// Collects colors whose range (0..1 or 0..255) shows only in the course of the file: 0..255 where a value
/// exceeds 1, or where all are whole numbers; else 0..1. Alpha has a range of its own, for some exporters
/// write 0..255 beside an alpha of 1.0.
class ColorList {
 public:
  ColorList(const char* name, const Notes& notes) : decoration_(name, notes) {}

  /// \param fraction  whether the values are written with a point or exponent
  template <class Cursor>
  void add(const Cursor& in, std::span<const double> rgba, std::span<const bool> fraction) {
    if (decoration_.dropped()) return;
    for (std::size_t k = 0; k < rgba.size(); ++k) {
      if (!(rgba[k] >= -kColorSlack && rgba[k] <= 255 * (1 + kColorSlack)))
        return refuse(in, "a color outside its range", "0..255, or 0..1 with a point");
      (k < 3 ? color_ : alpha_).see(rgba[k], fraction[k]);
    }
    if (color_.both()) return refuse(in, "colors of both ranges in one list", "all in 0..255 or all in 0..1");
    put(rgba);
  }
  void add_none() {
    if (any_)
      entries_.push_back({kNone, kNone, kNone, kNone});
    else
      ++before_first_;  // most files have no color at all
  }
  template <class Cursor>
  void refuse(const Cursor& in, const std::string& reason, const std::string& expected) {
    decoration_.refuse(in, reason, expected);
    entries_.clear();
  }
  bool dropped() const { return decoration_.dropped(); }

  /// One color per entry, or nothing when no entry has one.
  std::vector<Color> finish() const;

 private:
  using Entry = std::array<float, 4>;
  static constexpr float kNone = -1, kOpaque = -2;

  struct Range {
    bool above_one = false, written_as_fraction = false, below_one = false;
    void see(double value, bool fraction) {
      above_one |= value > 1 + kColorSlack;
      written_as_fraction |= fraction;
      below_one |= value > 0 && value < 1;
    }
    bool both() const { return above_one && below_one; }
    bool is_fraction() const { return !above_one && written_as_fraction; }
  };

  void put(std::span<const double> rgba);
  Color finished(const Entry& entry) const;

  Decoration decoration_;
  std::vector<Entry> entries_;
  std::size_t before_first_ = 0;
  Range color_, alpha_;
  bool any_ = false;
};

/// What a reader collects beside the surface, and what of it is kept in the end: normals, and colors by
/// Colors, a ColorList, or a Decoration where they are put into the mesh as they are read.
template <class Colors>
struct Attributes {
  explicit Attributes(const Notes& notes)
      : normals("normals", notes),
        texture("texture coordinates", notes),
        point_colors("vertex colors", notes),
        face_colors("face colors", notes) {}

  void finish(PolygonMesh& mesh) const {
    if (normals.dropped()) mesh.point_normals.clear();
    if (texture.dropped()) mesh.point_texture.clear(), mesh.corner_texture.clear();
    finish(point_colors, mesh.point_colors);
    finish(face_colors, mesh.face_colors);
  }

  Decoration normals, texture;
  Colors point_colors, face_colors;

 private:
  static void finish(const Decoration& colors, std::vector<Color>& out) {
    if (colors.dropped()) out.clear();
  }
  static void finish(const ColorList& colors, std::vector<Color>& out) {
    if (!colors.dropped()) out = colors.finish();
  }
};

}  // namespace tendril::bind
