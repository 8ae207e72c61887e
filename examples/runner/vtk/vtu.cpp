#include "vtk/vtu.h"

#include <tendril/base/error.h>
#include <tendril/base/number.h>

#include <bit>
#include <cstring>

namespace tendril::runner {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

template <class T>
std::string raw(const T* values, std::size_t count) {
  std::string out(count * sizeof(T), '\0');
  if (count > 0) std::memcpy(out.data(), values, out.size());
  return out;
}

std::string raw(const std::vector<Vec3>& values) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return raw(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Vec3));
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

}  // namespace

void VtkGrid::add_cell(VtkCell kind, const std::vector<std::uint32_t>& corners) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ends_.push_back(static_cast<std::int64_t>(corners_.size()));
  kinds_.push_back(static_cast<std::uint8_t>(kind));
}

void VtkGrid::add_points_array(Array array, std::size_t count) {
  if (count != points_.size())
    throw InvalidInput("field '" + array.name + "'", std::to_string(count) + " values",
                       std::to_string(points_.size()) + ", one a point");
  point_fields_.push_back(std::move(array));
}

void VtkGrid::add_points_field(const std::string& name, const std::vector<double>& values) {
  add_points_array({name, "Float64", 1, raw(values.data(), values.size())}, values.size());
}

void VtkGrid::add_points_field(const std::string& name, const std::vector<Vec3>& values) {
  add_points_array({name, "Float64", 3, raw(values)}, values.size());
}

void VtkGrid::add_points_field(const std::string& name, const std::vector<std::int32_t>& values) {
  add_points_array({name, "Int32", 1, raw(values.data(), values.size())}, values.size());
}

void VtkGrid::add_field(const std::string& name, double value) {
  fields_.push_back({name, "Float64", 1, raw(&value, 1)});
}

std::string VtkGrid::bytes() const {
  std::string data;
  // Each block begins with its size in bytes, the header_type of the file.
  const auto array = [&](const Array& a, const std::string& more = "") {
    std::string out = "<DataArray type=\"" + a.type + "\" Name=\"" + escaped(a.name) +
                      "\" NumberOfComponents=\"" + std::to_string(a.components) + "\"" + more +
                      " format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>\n";
    const std::uint64_t size = a.data.size();
    data += raw(&size, 1) + a.data;
    return out;
  };
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  xml += "<FieldData>\n";
  for (const Array& a : fields_) xml += array(a, " NumberOfTuples=\"1\"");
  xml += "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(points_.size()) + "\" NumberOfCells=\"" +
         std::to_string(kinds_.size()) + "\">\n<PointData>\n";
  for (const Array& a : point_fields_) xml += array(a);
  xml += "</PointData>\n<Points>\n" + array({"Points", "Float64", 3, raw(points_)}) + "</Points>\n<Cells>\n";
  xml += array({"connectivity", "Int64", 1, raw(corners_.data(), corners_.size())});
  xml += array({"offsets", "Int64", 1, raw(ends_.data(), ends_.size())});
  xml += array({"types", "UInt8", 1, raw(kinds_.data(), kinds_.size())});
  return xml + "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_" + data +
         "\n</AppendedData>\n</VTKFile>\n";
}

std::string pvd_text(const std::vector<PvdEntry>& entries) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  for (const PvdEntry& e : entries)
    out += "<DataSet timestep=\"" + shortest(e.time) + "\" part=\"" + std::to_string(e.part) + "\" file=\"" +
           escaped(e.file) + "\"/>\n";
  return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace tendril::runner
