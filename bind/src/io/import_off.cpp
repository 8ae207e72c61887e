#include <tendril/bind/import.h>

#include <charconv>

#include "cursor.h"
#include "import_values.h"

namespace tendril::bind {
namespace {

struct OffHeader {
  bool normals = false, colors = false, texture = false, binary = false;
  std::size_t vertices = 0, faces = 0;
};

/// Collects colors whose range (0..1 or 0..255) shows only in the course of the file.
class ColorList {
 public:
  /// \param fraction  whether one of the values is written with a point or exponent, so that the range is
  /// 0..1
  template <class Cursor>
  void add(const Cursor& in, std::span<const double> rgba, bool fraction) {
    fractions_ |= fraction;
    for (const double value : rgba) {
      if (!(value >= 0 && value <= 255)) in.fail("a color outside its range", "0..255, or 0..1 with a point");
      above_one_ |= value > 1;
    }
    if (fractions_ && above_one_)
      in.fail("colors of both ranges in one list", "all in 0..255 or all in 0..1");
    if (!any_) entries_.assign(before_first_, {none, none, none, none});
    any_ = true;
    Entry entry{0, 0, 0, opaque};
    std::transform(rgba.begin(), rgba.end(), entry.begin(), [](double v) { return static_cast<float>(v); });
    entries_.push_back(entry);
  }
  void add_none() {
    if (any_)
      entries_.push_back({none, none, none, none});
    else
      ++before_first_;  // most files have no color at all
  }

  /// One color per entry, or nothing when no entry has one.
  std::vector<Color> finish() const {
    std::vector<Color> colors(entries_.size());
    for (std::size_t i = 0; i < colors.size(); ++i) colors[i] = finished(entries_[i]);
    return colors;
  }

 private:
  using Entry = std::array<float, 4>;
  static constexpr float none = -1, opaque = -2;

  Color finished(const Entry& entry) const {
    if (entry[0] == none) return {170, 170, 170, 255};
    const double scale = fractions_ ? 255 : 1;
    Color color{0, 0, 0, 255};
    for (std::size_t k = 0; k < (entry[3] == opaque ? 3U : 4U); ++k) {
      color[k] = to_byte(scale * static_cast<double>(entry[k]));
    }
    return color;
  }

  std::vector<Entry> entries_;
  std::size_t before_first_ = 0;
  bool fractions_ = false, above_one_ = false, any_ = false;
};

/// Numbers left in a line, for the parts of OFF that end with it.
struct LineRest {
  std::array<double, 6> values{};
  std::array<bool, 6> written_as_fraction{};
  std::size_t count = 0;

  bool fraction(std::size_t first) const {
    return std::any_of(written_as_fraction.begin(), written_as_fraction.begin() + first,
                       [](bool f) { return f; });
  }
};

LineRest take_line(TextCursor& in, std::size_t most, const char* expected) {
  LineRest rest;
  while (!in.line_done()) {
    in.token_in_line();
    if (rest.count == most) in.fail("the value " + in.found() + " is one too many in its line", expected);
    double& value = rest.values[rest.count];
    if (!parse_number(in.last(), value)) in.fail(in.found() + " is not a number", expected);
    finite(in, value, "value");
    rest.written_as_fraction[rest.count++] = in.last_has_fraction();
  }
  return rest;
}

// ---- header

/// Takes "STCNOFF" and the like apart. The letters' order does not matter: that of the data is fixed.
OffHeader parse_keyword(TextCursor& in) {
  OffHeader header;
  std::string_view rest = in.token("the keyword OFF");
  const auto refuse = [&in] { in.fail("the first word is " + in.found(), "OFF with prefixes of ST, C, N"); };
  if (!rest.ends_with("OFF")) refuse();
  rest.remove_suffix(3);
  const auto take = [&rest](std::string_view letters, bool& flag) {
    if (flag || !rest.starts_with(letters)) return false;
    rest.remove_prefix(letters.size());
    return flag = true;
  };
  while (take("ST", header.texture) || take("C", header.colors) || take("N", header.normals)) {
  }
  if (rest == "4" || rest == "n" || rest == "4n") {
    in.fail("points of " + in.found() + " are not points of space", "OFF without the prefixes 4 and n");
  }
  if (!rest.empty()) refuse();
  return header;
}

std::size_t parse_count(TextCursor& in, const char* what) {
  const std::string_view token = in.last();
  std::uint64_t count = 0;
  const auto [stop, code] = std::from_chars(token.data(), token.data() + token.size(), count);
  if (code != std::errc() || stop != token.data() + token.size() || static_cast<double>(count) > id_limit) {
    in.fail("the number of " + std::string(what) + " is " + in.found(), "a whole number below 2^32");
  }
  return count;
}

void next_count_in_line(TextCursor& in) {
  if (in.token_in_line().empty())
    in.fail("fewer than three counts", "the numbers of vertices, faces and edges");
}

OffHeader read_header(TextCursor& in) {
  in.at("header");
  OffHeader header = parse_keyword(in);
  if (in.token("the number of vertices") == "BINARY") {
    header.binary = true;
    const std::string_view rest = in.rest_of_line();
    const auto first = rest.find_first_not_of(" \t");
    if (first != std::string_view::npos && rest[first] != '#')
      in.fail("text after BINARY", "the end of the line");
    return header;
  }
  header.vertices = parse_count(in, "vertices");
  next_count_in_line(in);
  header.faces = parse_count(in, "faces");
  next_count_in_line(in);
  parse_count(in, "edges");
  return header;
}

void reserve(PolygonMesh& mesh, const OffHeader& header, std::size_t bytes, std::size_t least_vertex,
             std::size_t least_face, std::size_t least_corner) {
  reserve_within(mesh.points, header.vertices, bytes, least_vertex);
  if (header.normals) reserve_within(mesh.point_normals, header.vertices, bytes, 2 * least_vertex);
  reserve_within(mesh.face_begin, header.faces + 1, bytes, least_face);
  reserve_within(mesh.corners, 3 * header.faces, bytes, least_corner);
}

// ---- text

Vec3 read_vector(TextCursor& in, const char* what) {
  Vec3 v;
  for (double& c : v) c = finite(in, in.number(), what);
  return v;
}

void read_vertex(TextCursor& in, const OffHeader& header, PolygonMesh& mesh, ColorList& colors) {
  mesh.points.push_back(read_vector(in, "coordinate"));
  if (header.normals) mesh.point_normals.push_back(read_vector(in, "normal"));
  const std::size_t texture = header.texture ? 2 : 0;
  if (header.colors) {
    const char* const expected = texture ? "3 or 4 color and 2 texture values" : "3 or 4 color values";
    const LineRest rest = take_line(in, 4 + texture, expected);
    if (rest.count < 3 + texture)
      in.fail("only " + std::to_string(rest.count) + " values after the point", expected);
    const std::size_t components = rest.count - texture;
    colors.add(in, std::span(rest.values).first(components), rest.fraction(components));
  } else {
    for (std::size_t k = 0; k < texture; ++k) finite(in, in.number(), "texture coordinate");
  }
}

void read_face(TextCursor& in, std::size_t vertices, PolygonMesh& mesh, ColorList& colors) {
  add_face(in, mesh, in.number());
  const std::size_t end = mesh.face_begin.back();
  while (mesh.corners.size() < end) add_corner(in, mesh, in.number(), vertices);

  if (in.line_done()) return colors.add_none();  // the most frequent by far
  const char* const expected = "0, 1, 3 or 4 color values to the end of the line";
  const LineRest rest = take_line(in, 4, expected);
  if (rest.count == 2 || (rest.count == 1 && rest.fraction(1))) in.fail("a color that is none", expected);
  if (rest.count < 3) {
    colors.add_none();
  } else {
    colors.add(in, std::span(rest.values).first(rest.count), rest.fraction(rest.count));
  }
}

// ---- binary: big-endian 32-bit integers and floats

Vec3 read_vector(ByteCursor& in, const char* what) {
  Vec3 v;
  for (double& c : v) c = finite(in, in.number(Scalar::float32), what);
  return v;
}

void read_color(ByteCursor& in, std::size_t count, ColorList& colors) {
  std::array<double, 4> values{};
  for (std::size_t k = 0; k < count; ++k) values[k] = finite(in, in.number(Scalar::float32), "color");
  if (count < 3) {
    colors.add_none();
  } else {
    colors.add(in, std::span(values).first(count), true);
  }
}

std::size_t read_count(ByteCursor& in, const char* what) {
  const double count = in.number(Scalar::int32);
  if (count < 0)
    in.fail("the number of " + std::string(what) + " is " + in.found(), "a number of at least 0");
  return static_cast<std::size_t>(count);
}

void read_vertex(ByteCursor& in, const OffHeader& header, PolygonMesh& mesh, ColorList& colors) {
  mesh.points.push_back(read_vector(in, "coordinate"));
  if (header.normals) mesh.point_normals.push_back(read_vector(in, "normal"));
  if (header.colors) read_color(in, 4, colors);
  for (int k = 0; header.texture && k < 2; ++k) finite(in, in.number(Scalar::float32), "texture coordinate");
}

void read_face(ByteCursor& in, std::size_t vertices, PolygonMesh& mesh, ColorList& colors) {
  const double degree = in.number(Scalar::int32);
  add_face(in, mesh, degree);
  in.require(static_cast<std::uint64_t>(degree), 4);
  const std::size_t end = mesh.face_begin.back();
  while (mesh.corners.size() < end) add_corner(in, mesh, in.number(Scalar::int32), vertices);
  const std::size_t components = read_count(in, "color values");
  if (components == 2 || components > 4) in.fail(in.found() + " color values", "0, 1, 3 or 4");
  read_color(in, components, colors);
}

/// Vertices and faces, as text or binary: the readers of one item are overloaded by the cursor.
template <class Cursor>
void read_body(Cursor& in, const OffHeader& header, PolygonMesh& mesh, ColorList& point_colors,
               ColorList& face_colors) {
  for (std::size_t v = 0; v < header.vertices; ++v) {
    in.at("vertex", v);
    read_vertex(in, header, mesh, point_colors);
  }
  for (std::size_t f = 0; f < header.faces; ++f) {
    in.at("face", f);
    read_face(in, header.vertices, mesh, face_colors);
  }
  in.at("after the last face");
}

/// Faces beyond those the header counts.
void read_surplus(TextCursor& in, const OffHeader& header, PolygonMesh& mesh, ColorList& colors,
                  std::vector<std::string>& notes) {
  std::string place;
  for (; !in.done(); read_face(in, header.vertices, mesh, colors)) {
    in.at("face", mesh.face_count());
    if (place.empty()) place = in.next_place();
  }
  if (place.empty()) return;
  notes.push_back(place + ": " + std::to_string(mesh.face_count() - header.faces) +
                  " more faces than the header's " + std::to_string(header.faces) + ", kept");
}

PolygonMesh read_text(TextCursor& in, const OffHeader& header, std::vector<std::string>* notes) {
  PolygonMesh mesh;
  reserve(mesh, header, in.remaining(), 6, 8, 2);
  ColorList point_colors, face_colors;
  read_body(in, header, mesh, point_colors, face_colors);
  if (notes) read_surplus(in, header, mesh, face_colors, *notes);
  if (!in.done()) {
    in.token("");
    in.fail(in.found() + " is left over", "the end of the file");
  }
  mesh.point_colors = point_colors.finish();
  mesh.face_colors = face_colors.finish();
  return mesh;
}

PolygonMesh read_binary(ByteCursor in, OffHeader header) {
  in.at("header");
  header.vertices = read_count(in, "vertices");
  header.faces = read_count(in, "faces");
  in.number(Scalar::int32);  // edges, not used by any reader
  PolygonMesh mesh;
  reserve(mesh, header, in.remaining(), 12, 20, 4);
  ColorList point_colors, face_colors;
  read_body(in, header, mesh, point_colors, face_colors);
  if (!in.done())
    in.fail_here(std::to_string(in.remaining()) + " bytes are left over", "the end of the file");
  mesh.point_colors = point_colors.finish();
  mesh.face_colors = face_colors.finish();
  return mesh;
}

}  // namespace

PolygonMesh parse_off(std::string_view bytes, const std::string& name) {
  return read_off(bytes, name, nullptr);
}

PolygonMesh read_off(std::string_view bytes, const std::string& name, std::vector<std::string>* notes) {
  TextCursor in(bytes, name, true);
  const OffHeader header = read_header(in);
  if (header.binary) return read_binary(ByteCursor(bytes, in.offset(), name, true), header);
  return read_text(in, header, notes);
}

}  // namespace tendril::bind
