#include <tendril/bind/import.h>

#include <charconv>

#include "io/values/color_list.h"
#include "obj_attributes.h"
#include "obj_line.h"

namespace tendril::bind {
namespace {

/// How many entries each list of a file has. Unknown while it is read the first time.
struct Counts {
  std::size_t points = 0xffffffff, textures = 0xffffffff, normals = 0xffffffff;
};

/// What a corner says: entries of the three lists, from 1 on, or from -1 backwards; 0 for none.
struct CornerText {
  std::int64_t point = 0, texture = 0, normal = 0;
};

/// "v", "v/t", "v//n", "v/t/n"; what is behind a slash may be missing.
bool parse_corner(std::string_view token, CornerText& corner) {
  const char *at = token.data(), *const end = at + token.size();
  const auto take = [&](std::int64_t& value) {
    const auto [stop, code] = std::from_chars(at, end, value);
    if (code != std::errc()) return false;
    at = stop;
    return true;
  };
  if (!take(corner.point)) return false;
  for (std::int64_t* const value : {&corner.texture, &corner.normal}) {
    if (at == end) return true;
    if (*at++ != '/') return false;
    if (at == end || *at == '/') continue;
    if (!take(*value) || *value == 0) return false;
  }
  return at == end;
}

/// Lines of one kind that are not read: the first, and how many.
struct Passed {
  std::string place, first;
  std::size_t count = 0;

  void see(const ObjLines& in) {
    if (count++ > 0) return;
    place = in.place();
    first = in.found();
  }
  void tell(const Notes& notes, const std::string& what) const {
    if (count > 0) notes.mention(place + std::to_string(count) + " " + what + ", the first " + first);
  }
};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& name, const Counts& counts, const Notes& notes)
      : in_(TextCursor(bytes, name, true)),
        name_(name),
        counts_(counts),
        notes_(notes),
        colors_("vertex colors", notes),
        normals_("normals", notes),
        textures_("texture coordinates", notes) {}

  void read() {
    for (std::string_view word = in_.next(); !word.empty(); word = in_.next()) read_line(word);
    in_.at("the end");
    if (mesh_.points.empty()) in_.fail("no vertex", "a line that begins with v");
  }

  Counts counts() const {
    return {mesh_.points.size(), attributes_.textures.size(), attributes_.normals.size()};
  }
  /// Whether corners named entries that stood in no line before them, nor in any after.
  bool missing() const {
    const Counts have = counts();
    return most_.points > have.points || most_.textures > have.textures || most_.normals > have.normals;
  }

  PolygonMesh finish() {
    unknown_.tell(notes_, "lines that begin with an unknown word, not read");
    skipped_.tell(notes_, "lines of points, lines, curves or free-form surfaces, not read");
    if (normals_.dropped()) attributes_.normal_of_corner.clear();
    if (textures_.dropped()) attributes_.texture_of_corner.clear();
    attributes_.give(mesh_, name_, notes_);
    if (!colors_.dropped()) mesh_.point_colors = colors_.finish();
    return std::move(mesh_);
  }

 private:
  void read_line(std::string_view word) {
    switch (obj_keyword(word)) {
      case ObjKeyword::vertex:
        return read_vertex();
      case ObjKeyword::normal:
        return read_normal();
      case ObjKeyword::texture:
        return read_texture();
      case ObjKeyword::face:
        return read_face();
      case ObjKeyword::passed:
        break;
      case ObjKeyword::skipped:
        in_.at("");
        skipped_.see(in_);
        break;
      case ObjKeyword::unknown:
        in_.at("");
        if (!notes_.tolerant()) in_.fail("the unknown keyword " + in_.found(), "one of the OBJ format");
        unknown_.see(in_);
    }
    in_.pass_line();
  }

  double coordinate() {
    if (in_.line_done()) in_.fail("fewer than three coordinates", "x, y and z");
    return finite(in_, in_.number(), "coordinate");
  }

  void read_vertex() {
    in_.at("vertex", mesh_.points.size());
    if (static_cast<double>(mesh_.points.size()) >= id_limit)
      in_.fail("too many vertices", "fewer than 2^32");
    Vec3 p;
    for (double& c : p) c = coordinate();
    mesh_.points.push_back(p);
    if (in_.line_done()) return colors_.add_none();  // the most frequent by far
    std::array<double, 4> rest{};
    constexpr std::array<bool, 4> fraction{true, true, true, true};  // "1 0 0" is red, not nearly black
    std::size_t count = 0;
    for (; !in_.line_done(); ++count) {
      double value = 0;
      if (!in_.take_number(value) || !std::isfinite(value)) return refuse_rest(in_.found() + " is no number");
      if (count == 4) return refuse_rest("the value " + in_.found() + " is one too many in its line");
      rest[count] = value;
    }
    if (count == 1) return colors_.add_none();  // a weight, which curves alone have a use for
    if (count == 2) return refuse_rest("5 values in a vertex' line");
    colors_.add(in_, std::span(rest).first(count), std::span(fraction).first(count));
  }

  void refuse_rest(const std::string& reason) {
    colors_.refuse(in_, reason, "3, 4, 6 or 7 numbers");
    in_.pass_line();
  }

  /// Numbers to the line's end, `least` to 3 of them.
  std::array<double, 3> read_decoration(std::size_t least, Decoration& decoration, const char* expected) {
    std::array<double, 3> values{};
    std::size_t count = 0;
    for (; !in_.line_done(); ++count) {
      double value = 0;
      if (!in_.take_number(value) || !std::isfinite(value))
        decoration.refuse(in_, in_.found() + " is not a finite number", expected);
      else if (count == 3)
        decoration.refuse(in_, "the value " + in_.found() + " is one too many in its line", expected);
      else if (count < 3)
        values[count] = value;
    }
    if (count < least) decoration.refuse(in_, "only " + std::to_string(count) + " values", expected);
    return values;
  }

  void read_normal() {
    in_.at("normal", attributes_.normals.size());
    const auto [x, y, z] = read_decoration(3, normals_, "three numbers");
    attributes_.normals.emplace_back(x, y, z);
  }

  void read_texture() {
    in_.at("texture coordinate", attributes_.textures.size());
    const auto [s, t, r] = read_decoration(1, textures_, "one to three numbers");
    attributes_.textures.push_back({s, t});
  }

  void read_face() {
    in_.at("face", mesh_.face_count());
    while (!in_.line_done()) {
      CornerText corner;
      if (!parse_corner(in_.token(), corner))
        in_.fail(in_.found() + " is no corner", "v, v/t, v//n or v/t/n, each a whole number");
      const std::uint32_t point = point_of(corner.point);
      const std::uint32_t texture =
          entry_of(corner.texture, attributes_.textures.size(), counts_.textures, most_.textures, textures_);
      const std::uint32_t normal =
          entry_of(corner.normal, attributes_.normals.size(), counts_.normals, most_.normals, normals_);
      attributes_.add_corner(mesh_.corners.size(), texture, normal);
      mesh_.corners.push_back(point);
    }
    const std::size_t degree = mesh_.corners.size() - mesh_.face_begin.back();
    if (degree < 3) in_.fail("a face of " + std::to_string(degree) + " corners", "at least 3 corners");
    if (static_cast<double>(mesh_.corners.size()) > id_limit) refuse_size(in_);
    mesh_.face_begin.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
  }

  /// Of a corner's number, which may name an entry of a line to come.
  /// \param entries  so far
  /// \param limit    how many there will be
  /// \param most     how many have to be there, by what was named so far
  /// \return  none for a number out of range
  static std::uint32_t entry(std::int64_t number, std::size_t entries, std::size_t limit, std::size_t& most) {
    if (number < 0) number += static_cast<std::int64_t>(entries) + 1;
    if (number < 1 || static_cast<std::size_t>(number) > limit) return ObjAttributes::kNone;
    most = std::max(most, static_cast<std::size_t>(number));
    return static_cast<std::uint32_t>(number - 1);
  }

  std::uint32_t point_of(std::int64_t number) {
    const std::size_t points = mesh_.points.size();
    const std::uint32_t point = entry(number, points, counts_.points, most_.points);
    if (point == ObjAttributes::kNone)
      in_.fail("vertex index in " + in_.found(),
               (known() ? "1 to " + std::to_string(counts_.points) : "1 or more") + ", or -1 to -" +
                   std::to_string(points) + " here");
    return point;
  }

  std::uint32_t entry_of(std::int64_t number, std::size_t entries, std::size_t limit, std::size_t& most,
                         Decoration& decoration) {
    if (number == 0 || decoration.dropped()) return ObjAttributes::kNone;
    const std::uint32_t id = entry(number, entries, limit, most);
    if (id == ObjAttributes::kNone)
      decoration.refuse(in_, "the corner " + in_.found() + " names none of " + std::to_string(entries),
                        "an index of those there are");
    return id;
  }

  bool known() const { return counts_.points != Counts{}.points; }

  ObjLines in_;
  std::string name_;
  Counts counts_, most_{0, 0, 0};
  Notes notes_;
  ColorList colors_;
  Decoration normals_, textures_;
  ObjAttributes attributes_;
  Passed skipped_, unknown_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh parse_obj(std::string_view bytes, const std::string& name) {
  return read_obj(bytes, name, nullptr);
}

PolygonMesh read_obj(std::string_view bytes, const std::string& name, std::vector<std::string>* list) {
  std::vector<std::string> told;
  const auto reader = [&](const Counts& counts) {
    told.clear();
    ObjReader out(bytes, name, counts, Notes(list == nullptr ? nullptr : &told));
    out.read();
    return out;
  };
  ObjReader read = reader({});
  // Read once more, knowing how much there is, where the first corner that names what is not there is met.
  if (read.missing()) read = reader(read.counts());
  PolygonMesh mesh = read.finish();
  if (list != nullptr) list->insert(list->end(), told.begin(), told.end());
  return mesh;
}

}  // namespace tendril::bind
