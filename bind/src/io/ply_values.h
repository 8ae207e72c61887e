#pragma once

#include "io/values/cursor.h"
#include "io/values/import_values.h"

/// The two ways to take a PLY file's values, with one interface, so that one body reader serves both.
namespace tendril::bind {

/// TextCursor with the interface of ByteCursor.
class TextValues {
 public:
  explicit TextValues(TextCursor in) : in_(std::move(in)) {}

  void at(std::string_view kind, std::size_t id) { in_.at(kind, id); }
  void at(std::string_view kind) { in_.at(kind); }
  double number(Scalar) { return in_.number(); }
  bool take_number(Scalar, double& value) { return in_.take_number(value); }
  void skip(std::uint64_t count, std::size_t) {
    for (std::uint64_t k = 0; k < count; ++k) in_.token("a value");
  }
  void require(std::uint64_t, std::size_t) const {}
  /// False when there is more in the line; the first of it is then taken, for its place.
  bool end_record() {
    if (in_.line_done()) return true;
    in_.token_in_line();
    return false;
  }
  void pass_line() {
    while (!in_.line_done()) in_.token_in_line();
  }
  void end_file(const Notes&) {
    if (in_.done()) return;
    in_.token("");
    in_.fail(in_.found() + " is left over", "the end of the file");
  }
  /// Fewest bytes a value can take: a digit and a blank.
  static std::size_t least(Scalar) { return 2; }
  std::size_t remaining() const { return in_.remaining(); }
  std::string found() const { return in_.found(); }
  std::string place() const { return in_.place(); }
  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const {
    in_.fail(reason, expected);
  }

 private:
  TextCursor in_;
};

class ByteValues : public ByteCursor {
 public:
  using ByteCursor::ByteCursor;
  bool take_number(Scalar type, double& value) {
    value = number(type);
    return true;
  }
  bool end_record() const { return true; }
  void pass_line() const {}
  void end_file(const Notes& notes) {
    if (done()) return;
    const std::string left = std::to_string(remaining()) + " bytes are left over";
    if (!notes.tolerant()) fail_here(left, "the end of the file");
    notes.add(place() + left + ", not read");
  }
  static std::size_t least(Scalar type) { return size_of(type); }
};

}  // namespace tendril::bind
