#include <tendril/bind/import.h>

#include <charconv>

#include "io/values/color_list.h"
#include "off_columns.h"

namespace tendril::bind {
namespace {

// ---- header

[[noreturn]] void refuse_keyword(const TextCursor& in) {
  in.fail("the first word is " + in.found(), "OFF with prefixes of ST, C, N");
}

/// Takes "STCNOFF" and the like apart. The letters' order does not matter: that of the data is fixed.
/// \param glued  the first count, where no blank stands before it
OffHeader parse_keyword(TextCursor& in, const Notes& notes, std::string_view& glued) {
  OffHeader header;
  const std::string_view word = in.token("the keyword OFF");
  const std::size_t off = word.find("OFF");
  if (off == word.npos) refuse_keyword(in);
  glued = word.substr(off + 3);
  if (glued.find_first_not_of("0123456789") != glued.npos) refuse_keyword(in);
  if (!glued.empty() && !notes.tolerant()) refuse_keyword(in);
  std::string_view rest = word.substr(0, off);
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
  if (!rest.empty()) refuse_keyword(in);
  if (!glued.empty()) notes.add(in.place() + "no blank between OFF and the number of vertices");
  return header;
}

std::size_t parse_count(const TextCursor& in, std::string_view token, const char* what) {
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

/// Nobody uses it, so a negative one is worth a note and no more.
void pass_edge_count(TextCursor& in, const Notes& notes) {
  next_count_in_line(in);
  std::string_view count = in.last();
  if (notes.tolerant() && count.starts_with('-')) {
    notes.add(in.place() + "the number of edges is " + in.found());
    count.remove_prefix(1);
  }
  parse_count(in, count, "edges");
}

OffHeader read_header(TextCursor& in, const Notes& notes) {
  in.at("header");
  std::string_view count;
  OffHeader header = parse_keyword(in, notes, count);
  if (count.empty()) count = in.token("the number of vertices");
  if (count == "BINARY") {
    header.binary = true;
    const std::string_view rest = in.rest_of_line();
    const auto first = rest.find_first_not_of(" \t");
    if (first != std::string_view::npos && rest[first] != '#')
      in.fail("text after BINARY", "the end of the line");
    return header;
  }
  header.vertices = parse_count(in, count, "vertices");
  next_count_in_line(in);
  header.faces = parse_count(in, in.last(), "faces");
  pass_edge_count(in, notes);
  return header;
}

// ---- body

/// Numbers left in a line, for the parts of OFF that end with it.
struct LineRest {
  std::array<double, 6> values{};
  std::array<bool, 6> fraction{};
  std::size_t count = 0;
  std::string trouble;  ///< why they are none, empty otherwise
};

LineRest take_line(TextCursor& in, std::size_t most) {
  LineRest rest;
  while (!in.line_done()) {
    in.token_in_line();
    if (!rest.trouble.empty()) continue;  // to the line's end, where the next item begins
    double value = 0;
    if (rest.count == most)
      rest.trouble = "the value " + in.found() + " is one too many in its line";
    else if (!parse_number(in.last(), value))
      rest.trouble = in.found() + " is not a number";
    else if (!std::isfinite(value))
      rest.trouble = "value " + in.found() + " is not finite";
    else {
      rest.values[rest.count] = value;
      rest.fraction[rest.count++] = in.last_has_fraction();
    }
  }
  return rest;
}

/// Reads vertices and faces as text into a mesh. Points and faces are free-form, as Geomview reads them;
/// colors end with their line, for only that says whether there are three numbers or four.
class TextBody {
 public:
  TextBody(TextCursor& in, const OffHeader& header, const Notes& notes)
      : in_(in), header_(header), notes_(notes), attributes_(notes) {}

  PolygonMesh read() {
    const std::vector<OffColumn> columns = off_columns(in_, header_, notes_);
    reserve(mesh_, header_, in_.remaining(), 6, 8, 2);
    for (std::size_t v = 0; v < header_.vertices; ++v) {
      in_.at("vertex", v);
      mesh_.points.push_back(read_point());
      if (columns.empty())
        read_as_told();
      else
        for (const OffColumn& column : columns) read_column(column);
    }
    for (std::size_t f = 0; f < header_.faces; ++f) read_face();
    in_.at("after the last face");
    if (notes_.tolerant()) read_surplus();
    if (!in_.done()) {
      in_.token("");
      in_.fail(in_.found() + " is left over", "the end of the file");
    }
    attributes_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  Vec3 read_point() {
    Vec3 p;
    for (double& c : p) c = finite(in_, in_.number(), "coordinate");
    return p;
  }

  /// Takes a token whether it is a number or not, so that what comes behind it is found.
  double read_loosely(Decoration& decoration, const char* what) {
    double value = 0;
    if (!in_.take_number(value))
      decoration.refuse(in_, in_.found() + " is not a number of double precision", "a number");
    else if (!std::isfinite(value))
      decoration.refuse(in_, std::string(what) + " " + in_.found() + " is not finite", "a finite number");
    else
      return value;
    return 0;
  }

  void read_normal() {
    Vec3 normal;
    for (double& c : normal) c = read_loosely(attributes_.normals, "normal");
    mesh_.point_normals.push_back(normal);
  }

  void read_as_told() {
    if (header_.normals) read_normal();
    const std::size_t texture = header_.texture ? 2 : 0;
    if (!header_.colors) return read_texture(texture);
    const char* const expected = texture ? "3 or 4 color and 2 texture values" : "3 or 4 color values";
    LineRest rest = take_line(in_, 4 + texture);
    if (rest.trouble.empty() && rest.count < 3 + texture)
      rest.trouble = "only " + std::to_string(rest.count) + " values after the point";
    if (!rest.trouble.empty()) {
      attributes_.texture.drop();
      return attributes_.point_colors.refuse(in_, rest.trouble, expected);
    }
    add_color(attributes_.point_colors, rest, rest.count - texture);
    if (texture) mesh_.point_texture.push_back({rest.values[rest.count - 2], rest.values[rest.count - 1]});
  }

  void add_color(ColorList& colors, const LineRest& rest, std::size_t components) {
    colors.add(in_, std::span(rest.values).first(components), std::span(rest.fraction).first(components));
  }

  /// \param count  of numbers: none, or two
  void read_texture(std::size_t count) {
    if (count == 0) return;
    TextureCoordinate at;
    for (double& c : at) c = read_loosely(attributes_.texture, "texture coordinate");
    mesh_.point_texture.push_back(at);
  }

  void read_column(const OffColumn& column) {
    if (column.kind == OffColumn::normal) return read_normal();
    if (column.kind == OffColumn::texture) return read_texture(column.count);
    LineRest color;
    for (; color.count < column.count; ++color.count) {
      // What is no number becomes one outside any range, and is refused there with all others.
      if (!in_.take_number(color.values[color.count])) color.values[color.count] = -1;
      color.fraction[color.count] = in_.last_has_fraction();
    }
    add_color(attributes_.point_colors, color, color.count);
  }

  void read_face() {
    in_.at("face", mesh_.face_count());
    // Numbers, not whole numbers, are read: "3.0" is an index to some exporters.
    add_face(in_, mesh_, in_.number());
    const std::size_t end = mesh_.face_begin.back();
    while (mesh_.corners.size() < end) add_corner(in_, mesh_, in_.number(), header_.vertices);
    if (in_.line_done()) return attributes_.face_colors.add_none();  // the most frequent by far
    LineRest rest = take_line(in_, 4);
    if (rest.trouble.empty() && (rest.count == 2 || (rest.count == 1 && rest.fraction[0])))
      rest.trouble = "a color that is none";
    if (!rest.trouble.empty())
      return attributes_.face_colors.refuse(in_, rest.trouble,
                                            "0, 1, 3 or 4 color values to the end of the line");
    if (rest.count < 3) return attributes_.face_colors.add_none();
    add_color(attributes_.face_colors, rest, rest.count);
  }

  /// Faces beyond those the header counts.
  void read_surplus() {
    std::string place;
    for (; !in_.done(); read_face())
      if (place.empty()) place = in_.next_place();
    if (place.empty()) return;
    notes_.add(place + ": " + std::to_string(mesh_.face_count() - header_.faces) +
               " more faces than the header's " + std::to_string(header_.faces) + ", kept");
  }

  TextCursor& in_;
  const OffHeader& header_;
  Notes notes_;
  Attributes<ColorList> attributes_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh parse_off(std::string_view bytes, const std::string& name) {
  return read_off(bytes, name, nullptr);
}

PolygonMesh read_off(std::string_view bytes, const std::string& name, std::vector<std::string>* list) {
  const Notes notes(list);
  TextCursor in(bytes, name, true);
  const OffHeader header = read_header(in, notes);
  if (header.binary) return read_off_binary(bytes, in.offset(), name, header, notes);
  return TextBody(in, header, notes).read();
}

}  // namespace tendril::bind
