#pragma once

#include <tendril/base/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tendril::runner {

/// Kinds of cells, with VTK's numbers.
enum class VtkCell : std::uint8_t { vertex = 1, line = 4 /* VTK_POLY_LINE */, polygon = 7 };

/// A VTK unstructured grid: points, cells, and fields on the points or on the whole. All data is
/// little-endian and lies behind the XML, raw ("appended"); positions are doubles, so what is read back has
/// the same bits.
class VtkGrid {
 public:
  explicit VtkGrid(Points points) : points_(points.begin(), points.end()) {}

  /// \param corners  indices into the points
  void add_cell(VtkCell kind, const std::vector<std::uint32_t>& corners);
  /// One value a point; as many as there are, else InvalidInput.
  void add_points_field(const std::string& name, const std::vector<double>& values);
  void add_points_field(const std::string& name, const std::vector<Vec3>& values);
  void add_points_field(const std::string& name, const std::vector<std::int32_t>& values);
  /// One value for the whole grid.
  void add_field(const std::string& name, double value);

  /// The file.
  std::string bytes() const;

 private:
  struct Array {
    std::string name, type;
    int components;
    std::string data;
  };
  void add_points_array(Array array, std::size_t count);

  std::vector<Vec3> points_;
  std::vector<std::int64_t> corners_, ends_;
  std::vector<std::uint8_t> kinds_;
  std::vector<Array> point_fields_, fields_;
};

/// A file of a time series.
struct PvdEntry {
  double time;
  int part;
  std::string file;  ///< relative to the series' file
};

/// ParaView's collection of a time series.
std::string pvd_text(const std::vector<PvdEntry>& entries);

}  // namespace tendril::runner
