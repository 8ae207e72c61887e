#include <tendril/bind/import.h>

#include "cursor.h"
#include "import_values.h"
#include "ply_header.h"

namespace tendril::bind {
namespace {

/// TextCursor with the interface of ByteCursor, so that one body reader serves both.
class TextValues {
 public:
  explicit TextValues(TextCursor in) : in_(std::move(in)) {}

  void at(std::string_view kind, std::size_t id) { in_.at(kind, id); }
  void at(std::string_view kind) { in_.at(kind); }
  double number(Scalar) { return in_.number(); }
  void skip(std::uint64_t count, std::size_t) {
    for (std::uint64_t k = 0; k < count; ++k) in_.token("a value");
  }
  void require(std::uint64_t, std::size_t) const {}
  void end_record() {
    if (in_.line_done()) return;
    in_.token_in_line();
    in_.fail("the value " + in_.found() + " is one too many in its line",
             "as many values as the header declares");
  }
  void end_file() {
    if (in_.done()) return;
    in_.token("");
    in_.fail(in_.found() + " is left over", "the end of the file");
  }
  /// Fewest bytes a value can take: a digit and a blank.
  static std::size_t least(Scalar) { return 2; }
  std::size_t remaining() const { return in_.remaining(); }
  std::string found() const { return in_.found(); }
  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const {
    in_.fail(reason, expected);
  }

 private:
  TextCursor in_;
};

class ByteValues : public ByteCursor {
 public:
  using ByteCursor::ByteCursor;
  void end_record() const {}
  void end_file() {
    if (!done()) fail_here(std::to_string(remaining()) + " bytes are left over", "the end of the file");
  }
  static std::size_t least(Scalar type) { return size_of(type); }
};

/// What the value of a property is used for.
enum Slot : std::size_t { x, y, z, nx, ny, nz, red, green, blue, alpha, slot_count, indices, unused };
constexpr std::array<std::string_view, slot_count> slot_names{"x",  "y",   "z",     "nx",   "ny",
                                                              "nz", "red", "green", "blue", "alpha"};

/// Which slot each property of an element fills.
struct Plan {
  std::vector<Slot> slots;
  std::array<bool, slot_count> has{};
  bool has_indices = false;

  bool normals() const { return has[nx] && has[ny] && has[nz]; }
  bool colors() const { return has[red] && has[green] && has[blue]; }
};

using Record = std::array<double, slot_count>;

Slot slot_of(const PlyProperty& property, bool face) {
  if (property.count_type) {
    const bool index_list = property.name == "vertex_indices" || property.name == "vertex_index";
    return face && index_list ? indices : unused;
  }
  const auto* const name = std::find(slot_names.begin(), slot_names.end(), property.name);
  const auto slot = static_cast<Slot>(name - slot_names.begin());
  return slot == slot_count || (face && slot < red) ? unused : slot;
}

Plan make_plan(const PlyElement& element, bool face) {
  Plan plan;
  for (const PlyProperty& property : element.properties) {
    const Slot slot = slot_of(property, face);
    plan.slots.push_back(slot);
    plan.has_indices |= slot == indices;
    if (slot >= slot_count) continue;
    plan.has[slot] = true;
  }
  for (Slot& slot : plan.slots) {  // a part of a normal or color is of no use
    if (slot >= slot_count) continue;
    if ((slot >= red && !plan.colors()) || (slot >= nx && slot <= nz && !plan.normals())) slot = unused;
  }
  return plan;
}

template <class Values>
class BodyReader {
 public:
  BodyReader(Values in, const PlyHeader& header) : in_(std::move(in)), header_(header) {
    const PlyElement* const vertices = header.find("vertex");
    points_ = vertices == nullptr ? 0 : vertices->count;
  }

  PolygonMesh read() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        skip_element(element);
      }
    }
    in_.at("after the last element");
    in_.end_file();
    return std::move(mesh_);
  }

 private:
  /// Fewest bytes one element can take; lists may be empty.
  std::size_t least_bytes(const PlyElement& element) const {
    std::size_t bytes = 0;
    for (const PlyProperty& p : element.properties) bytes += Values::least(p.count_type.value_or(p.type));
    return std::max<std::size_t>(bytes, 1);
  }

  std::size_t least_of_corner(const PlyElement& element) const {
    for (const PlyProperty& p : element.properties)
      if (slot_of(p, true) == indices) return Values::least(p.type);
    return 1;
  }

  std::uint64_t list_length(const PlyProperty& list) {
    const double length = in_.number(*list.count_type);
    if (!(length >= 0 && length <= id_limit && is_whole(length))) {
      in_.fail("a list of length " + in_.found(), "a whole number in [0, 2^32)");
    }
    in_.require(static_cast<std::uint64_t>(length), size_of(list.type));
    return static_cast<std::uint64_t>(length);
  }

  void skip_property(const PlyProperty& property) {
    in_.skip(property.count_type ? list_length(property) : 1, size_of(property.type));
  }

  double take(const PlyProperty& property) {
    const double value = finite(in_, in_.number(property.type), "value");
    if (!is_floating(property.type) && !is_whole(value)) {
      in_.fail(in_.found() + " for an integer property", "a whole number");
    }
    return value;
  }

  double take_color(const PlyProperty& property) {
    const double value = take(property);
    const bool fraction = is_floating(property.type);
    if (!(value >= 0 && value <= (fraction ? 1 : 255))) {
      in_.fail("color " + in_.found(), fraction ? "0..1" : "0..255");
    }
    return fraction ? 255 * value : value;
  }

  void take_face(const PlyProperty& list) {
    const double degree = in_.number(*list.count_type);
    add_face(in_, mesh_, degree);
    in_.require(static_cast<std::uint64_t>(degree), size_of(list.type));
    const std::size_t end = mesh_.face_begin.back();
    // The usual types apart, so that the loop knows which.
    if (list.type == Scalar::int32)
      while (mesh_.corners.size() < end) add_corner(in_, mesh_, in_.number(Scalar::int32), points_);
    else
      while (mesh_.corners.size() < end) add_corner(in_, mesh_, in_.number(list.type), points_);
  }

  void read_record(const PlyElement& element, const Plan& plan, Record& record) {
    for (std::size_t p = 0; p < plan.slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const Slot slot = plan.slots[p];
      if (slot == unused) {
        skip_property(property);
      } else if (slot == indices) {
        take_face(property);
      } else {
        record[slot] = slot >= red ? take_color(property) : take(property);
      }
    }
    in_.end_record();
  }

  static Color color_of(const Record& record) {
    return {to_byte(record[red]), to_byte(record[green]), to_byte(record[blue]), to_byte(record[alpha])};
  }

  void read_vertices(const PlyElement& element) {
    const Plan plan = make_plan(element, false);
    const std::size_t least = least_bytes(element), bytes = in_.remaining() + 1;
    reserve_within(mesh_.points, element.count, bytes, least);
    if (plan.normals()) reserve_within(mesh_.point_normals, element.count, bytes, least);
    if (plan.colors()) reserve_within(mesh_.point_colors, element.count, bytes, least);
    Record record{};
    record[alpha] = 255;
    for (std::size_t v = 0; v < element.count; ++v) {
      in_.at("vertex", v);
      read_record(element, plan, record);
      mesh_.points.emplace_back(record[x], record[y], record[z]);
      if (plan.normals()) mesh_.point_normals.emplace_back(record[nx], record[ny], record[nz]);
      if (plan.colors()) mesh_.point_colors.push_back(color_of(record));
    }
  }

  void read_faces(const PlyElement& element) {
    const Plan plan = make_plan(element, true);
    if (!plan.has_indices) return skip_element(element);  // the header check saw that it is empty
    const std::size_t least = least_bytes(element) + 3, bytes = in_.remaining() + 1;
    reserve_within(mesh_.face_begin, element.count + 1, bytes, least);
    reserve_within(mesh_.corners, 3 * element.count, bytes, least_of_corner(element));
    if (plan.colors()) reserve_within(mesh_.face_colors, element.count, bytes, least);
    Record record{};
    record[alpha] = 255;
    for (std::size_t f = 0; f < element.count; ++f) {
      in_.at("face", f);
      read_record(element, plan, record);
      if (plan.colors()) mesh_.face_colors.push_back(color_of(record));
    }
  }

  void skip_element(const PlyElement& element) {
    if (element.properties.empty()) return;  // takes no bytes, however many there are
    for (std::size_t i = 0; i < element.count; ++i) {
      in_.at(element.name, i);
      for (const PlyProperty& property : element.properties) skip_property(property);
      in_.end_record();
    }
  }

  Values in_;
  const PlyHeader& header_;
  std::size_t points_ = 0;
  PolygonMesh mesh_;
};

void check_vertices(const TextCursor& in, const PlyElement* vertices) {
  if (vertices == nullptr) in.fail("no element 'vertex'", "an element 'vertex' with x, y and z");
  if (static_cast<double>(vertices->count) > id_limit) in.fail("too many vertices", "fewer than 2^32");
  const Plan plan = make_plan(*vertices, false);
  for (const Slot slot : {x, y, z}) {
    if (!plan.has[slot])
      in.fail("vertices without " + std::string(slot_names[slot]), "properties x, y and z");
  }
}

void check_faces(const TextCursor& in, const PlyElement* faces) {
  const auto is_index_list = [](const PlyProperty& p) { return slot_of(p, true) == indices; };
  const auto lists = std::count_if(faces->properties.begin(), faces->properties.end(), is_index_list);
  if (lists > 1) in.fail("faces with both vertex_indices and vertex_index", "one of them");
  if (lists == 0 && faces->count > 0) in.fail("faces without corners", "a list property vertex_indices");
}

/// What the whole header must fulfil. Errors are placed at its last line.
void check_header(const TextCursor& in, const PlyHeader& header) {
  check_vertices(in, header.find("vertex"));
  if (const PlyElement* faces = header.find("face")) check_faces(in, faces);
  const PlyElement* const strips = header.find("tristrips");
  if (strips != nullptr && strips->count > 0) in.fail("faces given as triangle strips", "an element 'face'");
}

/// Where the binary data begins. After a lone CR a LF is data, so the form of the first line's end decides.
std::size_t data_begin(std::string_view bytes, const TextCursor& in) {
  const std::size_t first = bytes.find_first_of("\r\n");
  const bool lone_cr = first != bytes.npos && bytes.substr(first, 2) != "\r\n" && bytes[first] == '\r';
  const std::size_t end = in.offset();
  return lone_cr && bytes.substr(end - 2, 2) == "\r\n" ? end - 1 : end;
}

}  // namespace

PolygonMesh parse_ply(std::string_view bytes, const std::string& name) {
  TextCursor in(bytes, name, false);
  const PlyHeader header = read_ply_header(in);
  check_header(in, header);
  if (header.format == PlyFormat::ascii) return BodyReader(TextValues(in), header).read();
  const bool big_endian = header.format == PlyFormat::big_endian;
  return BodyReader(ByteValues(bytes, data_begin(bytes, in), name, big_endian), header).read();
}

}  // namespace tendril::bind
