#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// The two ways to take values from the bytes of a mesh file. Both know where they are, so that each error
/// can name its place, and which item is being read, so that it can name that too.
namespace tendril::bind {

/// Bytes of the input made fit for a message: printable, quoted, cut at 40.
std::string quoted(std::string_view bytes);

/// What both cursors share: the item being read.
class ItemName {
 public:
  void at(std::string_view kind, std::size_t id) {
    kind_ = kind;
    id_ = id;
  }
  void at(std::string_view kind) {
    kind_ = kind;
    id_ = no_id;
  }
  /// "vertex 3: ", "header: " or nothing.
  std::string prefix() const;

 private:
  static constexpr std::size_t no_id = static_cast<std::size_t>(-1);
  std::string_view kind_;
  std::size_t id_ = no_id;
};

/// Text: tokens between blanks, lines ended by LF, CR LF or CR. Errors are placed at the line of the last
/// token taken.
class TextCursor : public ItemName {
 public:
  /// \param comments  whether '#' starts a comment that ends with the line (OFF)
  TextCursor(std::string_view bytes, const std::string& name, bool comments);

  /// The next token, on this or a later line; fails at the end of the input.
  std::string_view token(std::string_view expected);
  /// Takes the next token, which must be a number. May be infinite or NaN if it is spelled so.
  double number();
  /// The next token of this line, or empty when the line has none left.
  std::string_view token_in_line();
  /// True when nothing but blanks and comments is left in this line.
  bool line_done();
  /// True when nothing but blanks, comments and line ends is left.
  bool done();
  /// Takes the rest of the line with its end, and returns it without. The line end's own form is kept for the
  /// caller: in a binary file what follows it is data.
  std::string_view rest_of_line();

  std::size_t offset() const { return next_; }
  std::size_t remaining() const { return bytes_.size() - next_; }
  /// The last value taken, as it stands in the file.
  std::string found() const { return quoted(last_); }
  std::string_view last() const { return last_; }
  bool last_has_fraction() const { return last_.find_first_of(".eE") != std::string_view::npos; }

  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const;

 private:
  void skip_blanks();
  void skip_to_token();
  void take_line_end();
  std::string_view take_token();

  std::string_view bytes_, last_;
  std::string name_;
  bool comments_;
  std::size_t next_ = 0, line_ = 1, last_line_ = 1;
};

/// A finite or infinite double from a whole token, independent of the locale; a plus sign is allowed.
/// False when the token is no number or exceeds the range of double.
bool parse_number(std::string_view token, double& value);

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
std::size_t size_of(Scalar type);
bool is_floating(Scalar type);

/// Binary: fixed-size scalars in a given byte order. Errors are placed at the first byte of the last value
/// taken.
class ByteCursor : public ItemName {
 public:
  ByteCursor(std::string_view bytes, std::size_t begin, const std::string& name, bool big_endian);

  /// The next scalar as a double; 64-bit integers are rounded.
  double number(Scalar type);
  /// Passes over `count` values of `size` bytes.
  void skip(std::uint64_t count, std::size_t size);
  /// Fails unless `count` values of `size` bytes follow.
  void require(std::uint64_t count, std::size_t size) const;

  std::size_t remaining() const { return bytes_.size() - next_; }
  bool done() { return next_ == bytes_.size(); }
  std::string found() const;

  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const;
  /// The same, at the cursor instead of the last value.
  [[noreturn]] void fail_here(const std::string& reason, const std::string& expected) const;

 private:
  template <class T>
  double take();

  std::string_view bytes_;
  std::string name_;
  bool big_endian_;
  std::size_t next_, last_begin_;
  double last_ = 0.0;
};

}  // namespace tendril::bind
