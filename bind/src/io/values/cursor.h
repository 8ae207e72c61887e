#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
  /// The same; false when it is no number.
  bool take_number(double& value);
  /// The next token of this line, or empty when the line has none left.
  std::string_view token_in_line();
  /// True when nothing but blanks and comments is left in this line.
  bool line_done();
  /// Takes a backslash that stands alone at the end of this line, with the line's end; false when there is
  /// none.
  bool take_continuation();
  /// True when nothing but blanks, comments and line ends is left.
  bool done();
  /// Takes the rest of the line with its end, and returns it without. The line end's own form is kept for the
  /// caller: in a binary file what follows it is data.
  std::string_view rest_of_line();

  std::size_t offset() const { return next_; }
  /// Where the next token stands, once done() has looked for it.
  std::string next_place() const { return name_ + ":" + std::to_string(line_); }
  std::size_t remaining() const { return bytes_.size() - next_; }
  /// The last value taken, as it stands in the file.
  std::string found() const { return quoted(last_); }
  std::string_view last() const { return last_; }
  bool last_has_fraction() const { return last_.find_first_of(".eE") != std::string_view::npos; }

  /// "name:line: item: ", to begin a note with.
  std::string place() const { return name_ + ":" + std::to_string(last_line_) + ": " + prefix(); }
  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const;

 private:
  enum Kind : std::uint8_t { word, blank, line_end, hash };
  static constexpr std::array<Kind, 256> make_kinds() {
    std::array<Kind, 256> kinds{};
    for (const char c : {' ', '\t', '\v', '\f'}) kinds[static_cast<unsigned char>(c)] = blank;
    kinds['\n'] = kinds['\r'] = line_end;
    kinds['#'] = hash;
    return kinds;
  }
  static Kind kind_of(char c) {
    static constexpr std::array<Kind, 256> kinds = make_kinds();
    return kinds[static_cast<unsigned char>(c)];
  }
  Kind kind() const { return kind_of(bytes_[next_]); }
  void skip_blanks();
  void skip_to_token();
  void take_line_end();
  std::string_view take_token();
  /// Whether the byte at `at`, not the first of its token, belongs to it. A '#' begins a comment there, too
  /// ("0#red"), but in the spellings that old C libraries have for numbers that are none: "-1.#IND",
  /// "1.#QNAN".
  bool in_token(std::size_t at) const {
    const Kind kind = kind_of(bytes_[at]);
    if (kind != hash || !comments_) return kind == word || kind == hash;
    return bytes_[at - 1] == '.' && at + 1 < bytes_.size() &&
           std::string_view("IQS").find(bytes_[at + 1]) != std::string_view::npos;
  }
  bool take_short_number(double& value);

  std::string_view bytes_, last_;
  std::string name_;
  bool comments_, rounds_to_nearest_;
  std::size_t next_ = 0, line_ = 1, last_line_ = 1;
};

/// A finite or infinite double from a whole token, independent of the locale; a plus sign is allowed, and
/// what is nearer to 0 than any double is 0. False when the token is no number or exceeds the range of
/// double.
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

  /// "name:byte N: item: ", to begin a note with.
  std::string place() const { return name_ + ":byte " + std::to_string(last_begin_) + ": " + prefix(); }
  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const;
  /// The same, at the cursor instead of the last value.
  [[noreturn]] void fail_here(const std::string& reason, const std::string& expected) const;

 private:
  template <class T>
  double take();
  [[noreturn]] void fail_short(std::uint64_t count, std::size_t size) const;

  std::string_view bytes_;
  std::string name_;
  bool big_endian_;
  std::size_t next_, last_begin_;
  double last_ = 0.0;
};

// What is called for every value stands here, to be inlined.

inline void TextCursor::skip_blanks() {
  while (next_ < bytes_.size() && kind() == blank) ++next_;
  if (comments_ && next_ < bytes_.size() && kind() == hash) {
    while (next_ < bytes_.size() && kind() != line_end) ++next_;
  }
}

inline void TextCursor::take_line_end() {
  const bool pair = bytes_[next_] == '\r' && next_ + 1 < bytes_.size() && bytes_[next_ + 1] == '\n';
  next_ += pair ? 2 : 1;
  ++line_;
}

inline void TextCursor::skip_to_token() {
  skip_blanks();
  while (next_ < bytes_.size() && kind() == line_end) {
    take_line_end();
    skip_blanks();
  }
}

inline std::string_view TextCursor::take_token() {
  const std::size_t begin = next_;
  if (next_ < bytes_.size()) ++next_;
  while (next_ < bytes_.size() && in_token(next_)) ++next_;
  last_ = bytes_.substr(begin, next_ - begin);
  last_line_ = line_;
  return last_;
}

inline std::string_view TextCursor::token(std::string_view expected) {
  skip_to_token();
  if (next_ == bytes_.size()) {
    last_line_ = line_;
    fail("the file ends here", std::string(expected));
  }
  return take_token();
}

inline bool TextCursor::take_number(double& value) {
  skip_to_token();
  return (rounds_to_nearest_ && take_short_number(value)) || parse_number(token("a number"), value);
}

inline double TextCursor::number() {
  double value = 0.0;
  if (!take_number(value)) fail(found() + " is not a number of double precision", "a number");
  return value;
}

inline bool TextCursor::line_done() {
  skip_blanks();
  return next_ == bytes_.size() || kind() == line_end;
}

/// Takes a token of at most 18 digits that make a whole number up to 2^53, with a sign and a point at most:
/// exact, or rounded once [Clinger 1990], where the machine rounds to nearest. Leaves all others.
inline bool TextCursor::take_short_number(double& value) {
  static constexpr std::array<double, 19> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                                 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};
  const char *const begin = bytes_.data() + next_, *const end = bytes_.data() + bytes_.size();
  const char* at = begin;
  const bool negative = at < end && *at == '-';
  if (negative) ++at;
  const char *const first = at, *point = nullptr;
  std::uint64_t digits = 0;  // wraps round where there are more than 18
  for (; at < end; ++at) {
    const auto digit = static_cast<unsigned char>(*at - '0');
    if (digit < 10)
      digits = 10 * digits + digit;
    else if (*at == '.' && point == nullptr)
      point = at;
    else
      break;
  }
  if (at < end && in_token(static_cast<std::size_t>(at - bytes_.data()))) return false;
  const std::ptrdiff_t count = at - first - (point != nullptr);
  if (count == 0 || count > 18 || digits > std::uint64_t{1} << 53) return false;
  const auto decimals = static_cast<std::size_t>(point == nullptr ? 0 : at - point - 1);
  const double size = static_cast<double>(digits) / powers[decimals];
  value = negative ? -size : size;
  last_ = {begin, static_cast<std::size_t>(at - begin)};
  last_line_ = line_;
  next_ += last_.size();
  return true;
}

inline void ByteCursor::require(std::uint64_t count, std::size_t size) const {
  if (size == 0 || count <= remaining() / size) return;
  fail_short(count, size);
}

template <class T>
double ByteCursor::take() {
  if (sizeof(T) > remaining()) fail_short(1, sizeof(T));
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes_.data() + next_, sizeof(T));
  if (big_endian_ != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  last_begin_ = next_;
  next_ += sizeof(T);
  last_ = static_cast<double>(std::bit_cast<T>(raw));
  return last_;
}

inline double ByteCursor::number(Scalar type) {
  switch (type) {
    case Scalar::int8:
      return take<std::int8_t>();
    case Scalar::uint8:
      return take<std::uint8_t>();
    case Scalar::int16:
      return take<std::int16_t>();
    case Scalar::uint16:
      return take<std::uint16_t>();
    case Scalar::int32:
      return take<std::int32_t>();
    case Scalar::uint32:
      return take<std::uint32_t>();
    case Scalar::int64:
      return take<std::int64_t>();
    case Scalar::uint64:
      return take<std::uint64_t>();
    case Scalar::float32:
      return take<float>();
    default:
      return take<double>();
  }
}

}  // namespace tendril::bind
