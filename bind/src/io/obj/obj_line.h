#pragma once

#include "io/values/cursor.h"

namespace tendril::bind {

/// The lines of a Wavefront OBJ file: a keyword and what belongs to it, up to the line's end. A backslash
/// that stands alone before the end continues the line on the next one.
class ObjLines {
 public:
  explicit ObjLines(TextCursor in) : in_(std::move(in)) {}

  /// The keyword of the next line that has one; empty at the end of the file.
  std::string_view next() { return in_.done() ? std::string_view() : in_.token(""); }
  bool line_done() {
    while (in_.take_continuation()) {
    }
    return in_.line_done();
  }
  /// Only where the line is not done.
  std::string_view token() { return in_.token_in_line(); }
  /// The same, as a number; false when it is none.
  bool take_number(double& value) { return in_.take_number(value); }
  double number() { return in_.number(); }
  void pass_line() {
    while (!line_done()) token();
  }

  void at(std::string_view kind, std::size_t id) { in_.at(kind, id); }
  void at(std::string_view kind) { in_.at(kind); }
  std::string found() const { return in_.found(); }
  std::string place() const { return in_.place(); }
  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const {
    in_.fail(reason, expected);
  }

 private:
  TextCursor in_;
};

/// What a line with a keyword of the OBJ format is to a mesh.
enum class ObjKeyword {
  vertex,
  normal,
  texture,
  face,
  passed,   ///< names, materials, groups and the like
  skipped,  ///< points, lines, free-form curves and surfaces: geometry that is no mesh
  unknown
};
ObjKeyword obj_keyword(std::string_view word);

}  // namespace tendril::bind
