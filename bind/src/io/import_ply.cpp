#include <tendril/bind/import.h>

#include "io/values/color_list.h"
#include "io/values/import_values.h"
#include "ply_plan.h"
#include "ply_values.h"

namespace tendril::bind {
namespace {

using namespace ply;
using Record = std::array<double, slot_count>;

template <class Values>
class BodyReader {
 public:
  BodyReader(Values in, const PlyHeader& header, const Notes& notes)
      : in_(std::move(in)), header_(header), notes_(notes), attributes_(notes) {
    const PlyElement* const vertices = header.find("vertex");
    points_ = vertices == nullptr ? 0 : vertices->count;
  }

  PolygonMesh read() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        read_strips(element);
      } else {
        skip_element(element);
      }
    }
    in_.at("after the last element");
    in_.end_file(notes_);
    attributes_.finish(mesh_);
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

  /// A normal's component or a color's, which refuse no mesh.
  double take_decoration(const PlyProperty& property, Slot slot, Decoration& decoration) {
    double value = 0;
    if (!in_.take_number(property.type, value)) {
      decoration.refuse(in_, in_.found() + " is not a number of double precision", "a number");
    } else if (!std::isfinite(value)) {
      decoration.refuse(in_, "value " + in_.found() + " is not finite", "a finite number");
    } else if (!is_floating(property.type) && !is_whole(value)) {
      decoration.refuse(in_, in_.found() + " for an integer property", "a whole number");
    } else {
      return slot >= red && slot <= alpha ? color_value(property, value, decoration) : value;
    }
    return 0;
  }

  /// In 0..255. What lies a rounding outside is taken to the end of the range.
  double color_value(const PlyProperty& property, double value, Decoration& decoration) {
    const bool fraction = is_floating(property.type);
    const double top = fraction ? 1 : 255;
    if (!(value >= -kColorSlack * top && value <= (1 + kColorSlack) * top))
      decoration.refuse(in_, "color " + in_.found(), fraction ? "0..1" : "0..255");
    return 255 / top * std::clamp(value, 0.0, top);
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

  void read_record(const PlyElement& element, const Plan& plan, Decoration& colors, Record& record) {
    for (std::size_t p = 0; p < plan.slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const Slot slot = plan.slots[p];
      if (slot == unused) {
        skip_property(property);
      } else if (slot == indices) {
        take_face(property);
      } else if (slot == texcoord) {
        take_texcoord(property);
      } else if (slot >= nx) {
        record[slot] = take_decoration(property, slot, decoration_of(slot, colors));
      } else {
        record[slot] = take(property);
      }
    }
    if (!in_.end_record()) pass_surplus(colors, &element == header_.find("vertex"));
  }

  Decoration& decoration_of(Slot slot, Decoration& colors) {
    return slot >= tex_s ? attributes_.texture : slot >= red ? colors : attributes_.normals;
  }

  /// A pair for each corner of a face. It may stand before them, so that its length is looked at in the end.
  void take_texcoord(const PlyProperty& list) {
    texcoord_.clear();
    for (std::uint64_t left = list_length(list); left > 0; --left)
      texcoord_.push_back(take_decoration(list, tex_s, attributes_.texture));
  }

  void add_texcoord() {
    const std::size_t corners = mesh_.corners.size() - mesh_.corner_texture.size();
    if (texcoord_.size() != 2 * corners) {
      attributes_.texture.refuse(in_,
                                 std::to_string(texcoord_.size()) + " texture coordinates for " +
                                     std::to_string(corners) + " corners",
                                 "two a corner");
      texcoord_.assign(2 * corners, 0.0);
    }
    for (std::size_t k = 0; k < corners; ++k)
      mesh_.corner_texture.push_back({texcoord_[2 * k], texcoord_[2 * k + 1]});
  }

  /// More values in a line than the header declares: what follows the coordinates or corners is not what it
  /// says, so none of that is kept.
  void pass_surplus(Decoration& colors, bool vertex) {
    const std::string reason = "the value " + in_.found() + " is one too many in its line";
    const char* const expected = "as many values as the header declares";
    if (!notes_.tolerant()) in_.fail(reason, expected);
    if (!surplus_) notes_.add(in_.place() + reason + ": no colors or normals of such lines are kept");
    surplus_ = true;
    colors.drop();
    attributes_.texture.drop();
    if (vertex) attributes_.normals.drop();
    in_.pass_line();
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
    if (plan.texture()) reserve_within(mesh_.point_texture, element.count, bytes, least);
    Record record{};
    record[alpha] = 255;
    for (std::size_t v = 0; v < element.count; ++v) {
      in_.at("vertex", v);
      read_record(element, plan, attributes_.point_colors, record);
      mesh_.points.emplace_back(record[x], record[y], record[z]);
      if (plan.normals()) mesh_.point_normals.emplace_back(record[nx], record[ny], record[nz]);
      if (plan.colors()) mesh_.point_colors.push_back(color_of(record));
      if (plan.texture()) mesh_.point_texture.push_back({record[tex_s], record[tex_t]});
    }
  }

  void read_faces(const PlyElement& element) {
    const Plan plan = make_plan(element, true);
    if (!plan.has_indices) return skip_element(element);  // the header check saw that it is empty
    const std::size_t least = least_bytes(element) + 3, bytes = in_.remaining() + 1;
    reserve_within(mesh_.face_begin, element.count + 1, bytes, least);
    reserve_within(mesh_.corners, 3 * element.count, bytes, least_of_corner(element));
    if (plan.colors()) reserve_within(mesh_.face_colors, element.count, bytes, least);
    const bool with_texture = std::find(plan.slots.begin(), plan.slots.end(), texcoord) != plan.slots.end();
    Record record{};
    record[alpha] = 255;
    for (std::size_t f = 0; f < element.count; ++f) {
      in_.at("face", f);
      read_record(element, plan, attributes_.face_colors, record);
      if (plan.colors()) mesh_.face_colors.push_back(color_of(record));
      if (with_texture) add_texcoord();
    }
  }

  void skip_element(const PlyElement& element) {
    if (element.properties.empty()) return;  // takes no bytes, however many there are
    for (std::size_t i = 0; i < element.count; ++i) {
      in_.at(element.name, i);
      for (const PlyProperty& property : element.properties) skip_property(property);
      if (!in_.end_record()) pass_surplus(attributes_.face_colors, false);
    }
  }

  /// Each list is a row of strips, one from each -1 to the next.
  void read_strips(const PlyElement& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      in_.at("tristrips", i);
      for (const PlyProperty& property : element.properties)
        slot_of(property, true) == indices ? take_strips(property) : skip_property(property);
      if (!in_.end_record()) pass_surplus(attributes_.face_colors, false);
    }
  }

  /// Every corner after a strip's second makes a triangle with the two before it, turned round each second
  /// time. Those that name a point twice only lead on to the next, and are no faces.
  void take_strips(const PlyProperty& list) {
    std::array<std::uint32_t, 2> before{};
    std::size_t length = 0;
    for (std::uint64_t left = list_length(list); left > 0; --left) {
      const double index = in_.number(list.type);
      if (index == -1) {
        length = 0;
        continue;
      }
      if (!(index >= 0 && index < static_cast<double>(points_) && is_whole(index)))
        refuse_corner(in_, points_);
      const auto corner = static_cast<std::uint32_t>(index);
      if (length >= 2 && before[0] != before[1] && before[0] != corner && before[1] != corner)
        add_triangle(length % 2 == 0 ? before : std::array{before[1], before[0]}, corner);
      before = {before[1], corner};
      ++length;
    }
  }

  void add_triangle(const std::array<std::uint32_t, 2>& edge, std::uint32_t corner) {
    add_face(in_, mesh_, 3);
    mesh_.corners.insert(mesh_.corners.end(), {edge[0], edge[1], corner});
  }

  Values in_;
  const PlyHeader& header_;
  Notes notes_;
  Attributes<Decoration> attributes_;
  std::vector<double> texcoord_;  ///< of the face being read
  bool surplus_ = false;
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

void check_faces(const TextCursor& in, const PlyElement* faces, const char* what) {
  const auto is_index_list = [](const PlyProperty& p) { return slot_of(p, true) == indices; };
  const auto lists = std::count_if(faces->properties.begin(), faces->properties.end(), is_index_list);
  if (lists > 1) in.fail(std::string(what) + " with both vertex_indices and vertex_index", "one of them");
  if (lists == 0 && faces->count > 0)
    in.fail(std::string(what) + " without corners", "a list property vertex_indices");
}

/// Colors of strips are not read: no one says which of their triangles they are of.
void check_strips(const TextCursor& in, const PlyHeader& header) {
  const PlyElement *const strips = header.find("tristrips"), *const faces = header.find("face");
  if (strips == nullptr || strips->count == 0) return;
  check_faces(in, strips, "triangle strips");
  if (faces != nullptr && faces->count > 0) in.fail("both faces and triangle strips", "one of them");
}

/// What the whole header must fulfil. Errors are placed at its last line.
void check_header(const TextCursor& in, const PlyHeader& header) {
  check_vertices(in, header.find("vertex"));
  if (const PlyElement* faces = header.find("face")) check_faces(in, faces, "faces");
  check_strips(in, header);
}

/// Where the binary data begins. After a lone CR a LF is data, so the form of the first line's end decides;
/// and so it does where LF CR ends the lines, as a text mode on the wrong machine makes them.
std::size_t data_begin(std::string_view bytes, const TextCursor& in, const Notes& notes) {
  const std::size_t first = bytes.find_first_of("\r\n");
  const std::string_view form = first == bytes.npos ? std::string_view() : bytes.substr(first, 2);
  const std::size_t end = in.offset();
  if (form.starts_with('\r') && form != "\r\n" && bytes.substr(end - 2, 2) == "\r\n") return end - 1;
  if (form != "\n\r" || !bytes.substr(end).starts_with('\r') || !notes.tolerant()) return end;
  notes.add(in.place() + "lines that end with LF CR");
  return end + 1;
}

}  // namespace

PolygonMesh parse_ply(std::string_view bytes, const std::string& name) {
  return read_ply(bytes, name, nullptr);
}

PolygonMesh read_ply(std::string_view bytes, const std::string& name, std::vector<std::string>* list) {
  const Notes notes(list);
  TextCursor in(bytes, name, false);
  const PlyHeader header = read_ply_header(in, notes);
  check_header(in, header);
  if (header.format == PlyFormat::ascii) return BodyReader(TextValues(in), header, notes).read();
  const bool big_endian = header.format == PlyFormat::big_endian;
  ByteValues values(bytes, data_begin(bytes, in, notes), name, big_endian);
  return BodyReader(std::move(values), header, notes).read();
}

}  // namespace tendril::bind
