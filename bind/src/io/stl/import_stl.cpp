#include <tendril/bind/import.h>

#include "io/values/import_values.h"
#include "point_table.h"
#include "stl_kind.h"

namespace tendril::bind {
namespace {

using Facet = std::array<Vec3, 3>;

/// By hand, since the C library's depends on the locale.
char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Writers disagree on capitals.
bool is_word(std::string_view token, std::string_view word) {
  return std::equal(token.begin(), token.end(), word.begin(), word.end(),
                    [](char a, char b) { return lower(a) == b; });
}

/// Little-endian, as the format has it whatever the machine is.
std::uint32_t count_in(std::string_view bytes) {
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < 4; ++k)
    count |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[kStlCount + k])) << 8 * k;
  return count;
}

/// Something of some facets, told once: what one exporter does wrong it does a million times.
struct Odd {
  std::size_t count = 0, first = 0;
  void see(std::size_t facet) {
    if (count++ == 0) first = facet;
  }
  void tell(const Notes& notes, const std::string& name, const char* what) const {
    if (count > 0)
      notes.mention(name + ": facet " + std::to_string(first) + ": " + what +
                    (count > 1 ? " (and " + std::to_string(count - 1) + " more)" : ""));
  }
};

/// Puts facets together to a mesh: corners at one place are one point. Exactly at one: exporters write a
/// point the same way in each of its facets, and a tolerance would glue sheets that only come near each
/// other. Facets without area stay, so that facets keep their numbers, and `check` and `repair` see them.
class StlMesh {
 public:
  StlMesh(const std::string& name, const Notes& notes) : name_(name), notes_(notes) {}

  void reserve(std::size_t facets) {
    mesh_.corners.reserve(3 * facets);
    mesh_.face_begin.reserve(facets + 1);
  }
  std::size_t facets() const { return mesh_.face_count(); }

  void add(const Facet& facet, const Vec3& normal) {
    std::array<std::uint32_t, 3> id{};
    std::transform(facet.begin(), facet.end(), id.begin(), [&](const Vec3& p) { return table_.id(p); });
    if (id[0] == id[1] || id[1] == id[2] || id[2] == id[0]) degenerate_.see(facets());
    look_at(facet, normal);
    mesh_.corners.insert(mesh_.corners.end(), id.begin(), id.end());
    mesh_.face_begin.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
  }
  void see_attribute() { attributes_.see(facets()); }

  PolygonMesh finish() {
    degenerate_.tell(notes_, name_, "two corners at one place");
    no_normal_.tell(notes_, name_, "a normal that is not finite; it is not used");
    turned_.tell(notes_, name_, "its normal points against the order of its corners, which counts");
    attributes_.tell(notes_, name_, "attribute bytes, a color perhaps, not read");
    mesh_.points = table_.take();
    return std::move(mesh_);
  }

 private:
  /// By more than 120 degrees: the normals of slivers are no better than rounding.
  void look_at(const Facet& facet, const Vec3& normal) {
    if (!is_finite(normal)) return no_normal_.see(facets());
    const Vec3 area = (facet[1] - facet[0]).cross(facet[2] - facet[0]);
    if (area.dot(normal) < -0.5 * area.norm() * normal.norm()) turned_.see(facets());
  }

  std::string name_;
  Notes notes_;
  PolygonMesh mesh_;
  PointTable table_;
  Odd degenerate_, no_normal_, turned_, attributes_;
};

PolygonMesh read_binary(std::string_view bytes, const std::string& name, const Notes& notes) {
  ByteCursor in(bytes, std::min(kStlCount, bytes.size()), name, false);
  in.at("header");
  const auto facets = static_cast<std::size_t>(in.number(Scalar::uint32));
  // Before anything is made that large: the count is four bytes that anybody may have damaged.
  if (3 * static_cast<double>(facets) > id_limit) refuse_size(in);
  in.require(facets, kStlFacet);
  StlMesh mesh(name, notes);
  mesh.reserve(facets);
  const auto vector = [&] {
    Vec3 v;
    for (double& c : v) c = in.number(Scalar::float32);
    return v;
  };
  for (std::size_t f = 0; f < facets; ++f) {
    in.at("facet", f);
    const Vec3 normal = vector();
    Facet facet;
    for (Vec3& p : facet)
      for (double& c : p) c = finite(in, in.number(Scalar::float32), "coordinate");
    if (in.number(Scalar::uint16) != 0) mesh.see_attribute();
    mesh.add(facet, normal);
  }
  in.at("after the last facet");
  if (!in.done()) {
    const std::string left = std::to_string(in.remaining()) + " bytes are left over";
    if (!notes.tolerant()) in.fail_here(left, "the end of the file");
    notes.add(in.place() + left + ", not read");
  }
  return mesh.finish();
}

class TextReader {
 public:
  TextReader(std::string_view bytes, const std::string& name, const Notes& notes)
      : in_(bytes, name, false), mesh_(name, notes) {}

  PolygonMesh read() {
    // Assemblies are written as one solid after another; they become one mesh.
    do read_solid();
    while (!in_.done());
    return mesh_.finish();
  }

 private:
  std::string_view word(const std::string& expected) { return in_.token("the word " + expected); }
  void expect(std::string_view expected) {
    const std::string name(expected);
    if (!is_word(word(name), expected)) in_.fail("the word " + in_.found(), "the word " + name);
  }

  void read_solid() {
    in_.at("");
    expect("solid");
    in_.rest_of_line();  // a name, of any words
    for (;;) {
      in_.at("facet", mesh_.facets());
      const std::string_view next = word("facet or endsolid");
      if (is_word(next, "endsolid")) break;
      if (!is_word(next, "facet")) in_.fail("the word " + in_.found(), "the word facet or endsolid");
      read_facet();
    }
    in_.at("");
    in_.rest_of_line();  // the name again, or another: nothing hangs on it
  }

  /// Nothing but the orientation is made of it, so that one that is none is no reason to refuse the facet.
  Vec3 read_normal() {
    Vec3 normal;
    for (double& c : normal)
      if (!in_.take_number(c)) c = std::numeric_limits<double>::quiet_NaN();
    return normal;
  }

  void read_facet() {
    if (3 * static_cast<double>(mesh_.facets()) >= id_limit - 3) refuse_size(in_);
    expect("normal");
    const Vec3 normal = read_normal();
    expect("outer");
    expect("loop");
    Facet facet;
    for (Vec3& p : facet) {
      expect("vertex");
      for (double& c : p) c = finite(in_, in_.number(), "coordinate");
    }
    expect("endloop");
    expect("endfacet");
    mesh_.add(facet, normal);
  }

  TextCursor in_;
  StlMesh mesh_;
};

}  // namespace

/// By the size first: many binary files begin with "solid" too. One that is cut short or longer than it
/// says is known by bytes that no text has in its first 84.
StlKind stl_kind(std::string_view bytes) {
  const bool counted = bytes.size() >= kStlBegin;
  if (counted && (bytes.size() - kStlBegin) % kStlFacet == 0 &&
      (bytes.size() - kStlBegin) / kStlFacet == count_in(bytes))
    return StlKind::binary;
  TextCursor start(bytes, "", false);
  if (start.done() || !is_word(start.token(""), "solid")) return StlKind::none;
  const std::string_view head = bytes.substr(0, kStlBegin);
  const auto is_text = [](char c) {
    return static_cast<unsigned char>(c) >= ' ' || (c >= '\t' && c <= '\r');
  };
  return std::all_of(head.begin(), head.end(), is_text) ? StlKind::text : StlKind::binary;
}

PolygonMesh parse_stl(std::string_view bytes, const std::string& name) {
  return read_stl(bytes, name, nullptr);
}

PolygonMesh read_stl(std::string_view bytes, const std::string& name, std::vector<std::string>* list) {
  const Notes notes(list);
  return stl_kind(bytes) == StlKind::text ? TextReader(bytes, name, notes).read()
                                          : read_binary(bytes, name, notes);
}

}  // namespace tendril::bind
