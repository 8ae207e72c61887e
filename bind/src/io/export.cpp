#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/bind/export.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace tendril::bind {
namespace {

std::size_t largest_degree(const PolygonMesh& mesh) {
  std::size_t largest = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) largest = std::max(largest, mesh.face(f).size());
  return largest;
}

/// Little-endian values, whatever the machine's own order.
class ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : out_(out) {}

  template <class T>
  void put(T value) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    out_.append(raw.data(), raw.size());
  }

  void put_length(std::uint32_t length, bool is_long) {
    is_long ? put(length) : put(static_cast<std::uint8_t>(length));
  }

  void put(const Vec3& v, bool float32) {
    for (const double c : v) float32 ? put(static_cast<float>(c)) : put(c);
  }

  void put(const TextureCoordinate& at, bool float32) {
    for (const double c : at) float32 ? put(static_cast<float>(c)) : put(c);
  }

  void put(const Color& color) {
    for (const std::uint8_t c : color) put(c);
  }

 private:
  std::string& out_;
};

/// Lists of at most 255 entries have their length in a byte, as most readers expect.
const char* list_of(bool is_long) {
  return is_long ? "property list uint " : "property list uchar ";
}

std::string ply_header(const PolygonMesh& mesh, bool float32, std::size_t degree) {
  const std::string real = float32 ? "property float " : "property double ";
  const std::string color =
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text += "element vertex " + std::to_string(mesh.points.size()) + "\n";
  for (const char* name : {"x\n", "y\n", "z\n"}) text += real + name;
  if (!mesh.point_normals.empty()) {
    for (const char* name : {"nx\n", "ny\n", "nz\n"}) text += real + name;
  }
  if (!mesh.point_colors.empty()) text += color;
  if (!mesh.point_texture.empty()) text += real + "s\n" + real + "t\n";
  text += "element face " + std::to_string(mesh.face_count()) + "\n";
  // int as most readers expect, uint only where ids need it
  text += list_of(degree > 255) + std::string(mesh.points.size() > 0x80000000U ? "uint" : "int") +
          " vertex_indices\n";
  if (!mesh.corner_texture.empty())
    text += list_of(2 * degree > 255) + std::string(float32 ? "float" : "double") + " texcoord\n";
  if (!mesh.face_colors.empty()) text += color;
  return text + "end_header\n";
}

double largest_of(const Vec3& v) {
  return v.cwiseAbs().maxCoeff();
}

double largest_of(const TextureCoordinate& at) {
  return std::max(std::abs(at[0]), std::abs(at[1]));
}

template <class Vector>
void require_single_precision(const std::vector<Vector>& vectors, const char* array) {
  constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (largest_of(vectors[i]) <= largest) continue;
    throw InvalidInput("PolygonMesh: " + std::string(array) + "[" + std::to_string(i) + "]",
                       "a value beyond the range of single precision",
                       "magnitudes up to 3.4e38, or float32 off");
  }
}

template <class T>
void append_number(std::string& out, T value) {
  std::array<char, 32> text{};
  out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
}

template <class Vector>
void append_numbers(std::string& out, const Vector& v) {
  for (const double c : v) {
    append_number(out, c);
    out += ' ';
  }
}

void append(std::string& out, const Vec3& v) {
  append_numbers(out, v);
}

void append(std::string& out, const TextureCoordinate& at) {
  append_numbers(out, at);
}

void append(std::string& out, const Color& color) {
  for (const std::uint8_t c : color) {
    append_number(out, static_cast<unsigned>(c));
    out += ' ';
  }
}

/// Turns the blank after a line's last value into its end.
void end_line(std::string& out) {
  out.back() = '\n';
}

}  // namespace

bool single_precision_serves(Points points) {
  double largest = 0.0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  // Half a spacing of floats is at most 2^-24 of the number.
  return largest * 0x1p-24 <= 1e-5 * bounding_diagonal(points) && largest < 3e38;
}

std::string ply_bytes(const PolygonMesh& mesh, const PlyOptions& options) {
  require_valid(mesh);
  if (options.float32) {
    require_single_precision(mesh.points, "points");
    require_single_precision(mesh.point_normals, "point_normals");
    require_single_precision(mesh.point_texture, "point_texture");
    require_single_precision(mesh.corner_texture, "corner_texture");
  }
  const std::size_t largest = largest_degree(mesh);
  std::string out = ply_header(mesh, options.float32, largest);
  out.reserve(out.size() + 52 * mesh.points.size() + 8 * mesh.face_count() + 4 * mesh.corners.size());
  ByteWriter writer(out);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    writer.put(mesh.points[v], options.float32);
    if (!mesh.point_normals.empty()) writer.put(mesh.point_normals[v], options.float32);
    if (!mesh.point_colors.empty()) writer.put(mesh.point_colors[v]);
    if (!mesh.point_texture.empty()) writer.put(mesh.point_texture[v], options.float32);
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const auto degree = static_cast<std::uint32_t>(face.size());
    writer.put_length(degree, largest > 255);
    for (const std::uint32_t corner : face) writer.put(corner);
    if (!mesh.corner_texture.empty()) {
      writer.put_length(2 * degree, 2 * largest > 255);
      for (std::size_t c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        writer.put(mesh.corner_texture[c], options.float32);
    }
    if (!mesh.face_colors.empty()) writer.put(mesh.face_colors[f]);
  }
  return out;
}

std::string off_text(const PolygonMesh& mesh) {
  require_valid(mesh);
  std::string out = mesh.point_texture.empty() ? "" : "ST";
  if (!mesh.point_colors.empty()) out += 'C';
  out += mesh.point_normals.empty() ? "OFF\n" : "NOFF\n";
  out += std::to_string(mesh.points.size()) + " " + std::to_string(mesh.face_count()) + " 0\n";
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    append(out, mesh.points[v]);
    if (!mesh.point_normals.empty()) append(out, mesh.point_normals[v]);
    if (!mesh.point_colors.empty()) append(out, mesh.point_colors[v]);
    if (!mesh.point_texture.empty()) append(out, mesh.point_texture[v]);
    end_line(out);
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    append_number(out, face.size());
    out += ' ';
    for (const std::uint32_t corner : face) {
      append_number(out, corner);
      out += ' ';
    }
    if (!mesh.face_colors.empty()) append(out, mesh.face_colors[f]);
    end_line(out);
  }
  return out;
}

void write_mesh(const std::string& path, const PolygonMesh& mesh) {
  if (path.ends_with(".ply")) return write_file_whole(path, ply_bytes(mesh));
  if (path.ends_with(".off")) return write_file_whole(path, off_text(mesh));
  throw InvalidInput(path, "no format has this ending", ".ply or .off");
}

}  // namespace tendril::bind
