#include <tendril/base/error.h>

#include <optional>

#include "io/values/color_list.h"
#include "off_header.h"

namespace tendril::bind {
namespace {

/// How a file's numbers stand. The first is Geomview's.
struct Dialect {
  bool big_endian, color_counts;
  const char* name;
};
constexpr Dialect kDialects[] = {
    {true, true, ""},
    {true, false, "without a count of color values behind each face"},
    {false, true, "little-endian"},
    {false, false, "little-endian, without a count of color values behind each face"}};

std::size_t read_count(ByteCursor& in, const char* what) {
  const double count = in.number(Scalar::int32);
  if (count < 0)
    in.fail("the number of " + std::string(what) + " is " + in.found(), "a number of at least 0");
  return static_cast<std::size_t>(count);
}

/// Reads one item after the other, without a look ahead: nothing but the bytes before says where one begins.
class BinaryBody {
 public:
  BinaryBody(ByteCursor in, const OffHeader& header, bool color_counts, const Notes& notes)
      : in_(std::move(in)), header_(header), color_counts_(color_counts), notes_(notes), attributes_(notes) {}

  PolygonMesh read() {
    in_.at("header");
    header_.vertices = read_count(in_, "vertices");
    header_.faces = read_count(in_, "faces");
    in_.number(Scalar::int32);  // edges, not used by any reader
    reserve(mesh_, header_, in_.remaining(), 12, 16, 4);
    for (std::size_t v = 0; v < header_.vertices; ++v) read_vertex(v);
    for (std::size_t f = 0; f < header_.faces; ++f) read_face(f);
    in_.at("after the last face");
    attributes_.finish(mesh_);
    return std::move(mesh_);
  }
  const ByteCursor& in() const { return in_; }

 private:
  void read_vertex(std::size_t v) {
    in_.at("vertex", v);
    Vec3 point, normal;
    for (double& c : point) c = finite(in_, in_.number(Scalar::float32), "coordinate");
    mesh_.points.push_back(point);
    for (std::size_t k = 0; header_.normals && k < 3; ++k) {
      normal[static_cast<Eigen::Index>(k)] = in_.number(Scalar::float32);
      if (!std::isfinite(normal[static_cast<Eigen::Index>(k)]))
        attributes_.normals.refuse(in_, "normal " + in_.found() + " is not finite", "a finite number");
    }
    if (header_.normals) mesh_.point_normals.push_back(normal);
    if (header_.colors) read_color(4, attributes_.point_colors);
    if (header_.texture) read_texture();
  }

  void read_texture() {
    TextureCoordinate at;
    for (double& c : at) {
      c = in_.number(Scalar::float32);
      if (!std::isfinite(c))
        attributes_.texture.refuse(in_, "texture coordinate " + in_.found() + " is not finite",
                                   "a finite number");
    }
    mesh_.point_texture.push_back(at);
  }

  void read_color(std::size_t count, ColorList& colors) {
    constexpr std::array<bool, 4> fractions{true, true, true, true};
    std::array<double, 4> values{};
    for (std::size_t k = 0; k < count; ++k) {
      values[k] = in_.number(Scalar::float32);
      // The rest is still to be read: what follows begins behind it.
      if (!std::isfinite(values[k]))
        colors.refuse(in_, "color " + in_.found() + " is not finite", "a finite number");
    }
    if (count < 3) return colors.add_none();
    colors.add(in_, std::span(values).first(count), std::span(fractions).first(count));
  }

  void read_face(std::size_t f) {
    in_.at("face", f);
    const double degree = in_.number(Scalar::int32);
    add_face(in_, mesh_, degree);
    in_.require(static_cast<std::uint64_t>(degree), 4);
    const std::size_t end = mesh_.face_begin.back();
    while (mesh_.corners.size() < end) add_corner(in_, mesh_, in_.number(Scalar::int32), header_.vertices);
    if (!color_counts_) return;
    const std::size_t components = read_count(in_, "color values");
    if (components == 0) return attributes_.face_colors.add_none();  // the most frequent by far
    if (components == 2 || components > 4) in_.fail(in_.found() + " color values", "0, 1, 3 or 4");
    read_color(components, attributes_.face_colors);
  }

  ByteCursor in_;
  OffHeader header_;
  bool color_counts_;
  Notes notes_;
  Attributes<ColorList> attributes_;
  PolygonMesh mesh_;
};

/// The mesh when it takes all bytes up to the last: in another dialect counts and ids are so large, or small
/// fractions so odd, that some check fails or bytes are left. A wrong guess costs no more than the file's own
/// size, since counts reserve no more than the bytes can fill.
std::optional<PolygonMesh> read_whole(std::string_view bytes, std::size_t begin, const std::string& name,
                                      const OffHeader& header, const Dialect& dialect,
                                      std::vector<std::string>& told) {
  try {
    BinaryBody body(ByteCursor(bytes, begin, name, dialect.big_endian), header, dialect.color_counts,
                    Notes(&told));
    PolygonMesh mesh = body.read();
    if (body.in().remaining() == 0) return mesh;
  } catch (const InvalidInput&) {
    // The reason is of no interest: if no dialect fits, Geomview's is read once more for its error.
  }
  return {};
}

}  // namespace

PolygonMesh read_off_binary(std::string_view bytes, std::size_t begin, const std::string& name,
                            const OffHeader& header, const Notes& notes) {
  for (const Dialect& dialect : kDialects) {
    if (!notes.tolerant()) break;
    std::vector<std::string> told;
    std::optional<PolygonMesh> mesh = read_whole(bytes, begin, name, header, dialect, told);
    if (!mesh) continue;
    if (*dialect.name != '\0') notes.add(name + ": binary OFF, " + dialect.name);
    for (std::string& note : told) notes.add(std::move(note));
    return std::move(*mesh);
  }
  // As Geomview has it, for the error's place.
  BinaryBody body(ByteCursor(bytes, begin, name, true), header, true, notes);
  PolygonMesh mesh = body.read();
  const std::string left = std::to_string(body.in().remaining()) + " bytes are left over";
  if (body.in().remaining() == 0) return mesh;
  if (!notes.tolerant()) body.in().fail_here(left, "the end of the file");
  notes.add(name + ": " + left + ", not read");
  return mesh;
}

}  // namespace tendril::bind
