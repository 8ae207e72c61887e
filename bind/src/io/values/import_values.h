#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

/// Notes, checks on single values and the building of a mesh, shared by all readers. `Cursor` is
/// TextCursor, ByteCursor or anything else with found() and fail(): errors are placed at the value it took
/// last.
namespace tendril::bind {

/// Where a reader tells what it read in a way of its own or left out. Without a list nobody would be told, so
/// it refuses instead.
class Notes {
 public:
  explicit Notes(std::vector<std::string>* list) : list_(list) {}

  bool tolerant() const { return list_ != nullptr; }
  void add(std::string note) const { list_->push_back(std::move(note)); }
  /// Of what is well-formed and documented to be left out: nobody need be told.
  void mention(std::string note) const {
    if (tolerant()) add(std::move(note));
  }

 private:
  std::vector<std::string>* list_;
};

/// Normals or colors: worth having, but no reason to refuse a surface. The first bad value drops them all,
/// with a note; where nobody would be told it is an error.
class Decoration {
 public:
  Decoration(const char* name, const Notes& notes) : name_(name), notes_(notes) {}

  bool dropped() const { return dropped_; }

  /// Without a word: the reason was told already.
  void drop() { dropped_ = true; }

  template <class Cursor>
  void refuse(const Cursor& in, const std::string& reason, const std::string& expected) {
    if (!notes_.tolerant()) in.fail(reason, expected);
    if (!dropped_) notes_.add(in.place() + reason + ": " + name_ + " dropped");
    dropped_ = true;
  }

 private:
  const char* name_;
  Notes notes_;
  bool dropped_ = false;
};

/// Ids are 32-bit, and so are the offsets into the list of corners.
inline constexpr double id_limit = 4294967295.0;

/// std::floor is a call where the machine may lack the instruction.
inline bool is_whole(double value) {
  constexpr double kSmall = 4503599627370496.0;  // 2^52
  return value > -kSmall && value < kSmall ? static_cast<double>(static_cast<std::int64_t>(value)) == value
                                           : value == std::floor(value);
}

// Refusals stand apart, so that the checks can be inlined.

template <class Cursor>
[[noreturn, gnu::noinline]] void refuse_number(const Cursor& in, const char* what) {
  in.fail(std::string(what) + " " + in.found() + " is not finite", "a finite number");
}
template <class Cursor>
[[noreturn, gnu::noinline]] void refuse_degree(const Cursor& in) {
  in.fail("a face of " + in.found() + " corners", "a whole number of at least 3 corners");
}
template <class Cursor>
[[noreturn, gnu::noinline]] void refuse_size(const Cursor& in) {
  in.fail("more than 2^32 - 1 corners in all", "a smaller mesh");
}
template <class Cursor>
[[noreturn, gnu::noinline]] void refuse_corner(const Cursor& in, std::size_t points) {
  in.fail("vertex index " + in.found(), "a whole number in [0, " + std::to_string(points) + ")");
}

template <class Cursor>
double finite(const Cursor& in, double value, const char* what) {
  if (!std::isfinite(value)) refuse_number(in, what);
  return value;
}

template <class Cursor>
[[gnu::always_inline]] inline void add_face(const Cursor& in, PolygonMesh& mesh, double degree) {
  if (!(degree >= 3 && is_whole(degree))) refuse_degree(in);
  const double corners = static_cast<double>(mesh.corners.size()) + degree;
  if (corners > id_limit) refuse_size(in);
  mesh.face_begin.push_back(static_cast<std::uint32_t>(corners));
}

/// \param points  number of points the header promises; the readers fail later when they are not all there
template <class Cursor>
void add_corner(const Cursor& in, PolygonMesh& mesh, double index, std::size_t points) {
  if (!(index >= 0 && index < static_cast<double>(points) && is_whole(index))) refuse_corner(in, points);
  mesh.corners.push_back(static_cast<std::uint32_t>(index));
}

/// Reserves room for `count` entries, but no more than `bytes` of input can fill at `least` bytes each.
template <class T>
void reserve_within(std::vector<T>& list, std::size_t count, std::size_t bytes, std::size_t least) {
  list.reserve(std::min(count, bytes / least + 1));
}

inline std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(value));
}

/// parse_off and the like with notes, as read_mesh has them.
PolygonMesh read_off(std::string_view bytes, const std::string& name, std::vector<std::string>* notes);
PolygonMesh read_ply(std::string_view bytes, const std::string& name, std::vector<std::string>* notes);
PolygonMesh read_obj(std::string_view bytes, const std::string& name, std::vector<std::string>* notes);
PolygonMesh read_stl(std::string_view bytes, const std::string& name, std::vector<std::string>* notes);

}  // namespace tendril::bind
