#include "cursor.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

namespace tendril::bind {
namespace {

bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return std::string(text.data(), end);
}

}  // namespace

std::string quoted(std::string_view bytes) {
  constexpr std::size_t longest = 40;
  std::string text = "'";
  for (const char c : bytes.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (bytes.size() > longest ? "...'" : "'");
}

std::string ItemName::prefix() const {
  if (kind_.empty()) return {};
  std::string text(kind_);
  if (id_ != no_id) text.append(" ").append(std::to_string(id_));
  return text + ": ";
}

TextCursor::TextCursor(std::string_view bytes, const std::string& name, bool comments)
    : bytes_(bytes), name_(name), comments_(comments) {
  if (bytes_.starts_with("\xEF\xBB\xBF")) next_ = 3;  // some editors put a UTF-8 byte order mark in front
}

void TextCursor::fail(const std::string& reason, const std::string& expected) const {
  throw InvalidInput(name_ + ":" + std::to_string(last_line_), prefix() + reason, expected);
}

void TextCursor::skip_blanks() {
  while (next_ < bytes_.size() && is_blank(bytes_[next_])) ++next_;
  if (comments_ && next_ < bytes_.size() && bytes_[next_] == '#') {
    while (next_ < bytes_.size() && !is_line_end(bytes_[next_])) ++next_;
  }
}

void TextCursor::take_line_end() {
  const bool pair = bytes_[next_] == '\r' && next_ + 1 < bytes_.size() && bytes_[next_ + 1] == '\n';
  next_ += pair ? 2 : 1;
  ++line_;
}

void TextCursor::skip_to_token() {
  skip_blanks();
  while (next_ < bytes_.size() && is_line_end(bytes_[next_])) {
    take_line_end();
    skip_blanks();
  }
}

std::string_view TextCursor::take_token() {
  const std::size_t begin = next_;
  const auto ends = [this](char c) { return is_blank(c) || is_line_end(c) || (comments_ && c == '#'); };
  while (next_ < bytes_.size() && !ends(bytes_[next_])) ++next_;
  last_ = bytes_.substr(begin, next_ - begin);
  last_line_ = line_;
  return last_;
}

std::string_view TextCursor::token(std::string_view expected) {
  skip_to_token();
  if (next_ == bytes_.size()) {
    last_line_ = line_;
    fail("the file ends here", std::string(expected));
  }
  return take_token();
}

std::string_view TextCursor::token_in_line() {
  if (line_done()) return {};
  return take_token();
}

double TextCursor::number() {
  double value = 0.0;
  if (!parse_number(token("a number"), value))
    fail(found() + " is not a number of double precision", "a number");
  return value;
}

bool TextCursor::line_done() {
  skip_blanks();
  return next_ == bytes_.size() || is_line_end(bytes_[next_]);
}

bool TextCursor::done() {
  skip_to_token();
  return next_ == bytes_.size();
}

std::string_view TextCursor::rest_of_line() {
  const std::size_t begin = next_;
  last_line_ = line_;
  while (next_ < bytes_.size() && !is_line_end(bytes_[next_])) ++next_;
  const std::string_view line = bytes_.substr(begin, next_ - begin);
  if (next_ < bytes_.size()) take_line_end();
  return line;
}

bool parse_number(std::string_view token, double& value) {
  if (token.starts_with('+')) {
    token.remove_prefix(1);
    if (token.starts_with('-')) return false;
  }
  const char* const end = token.data() + token.size();
  const auto [stop, code] = std::from_chars(token.data(), end, value);
  return code == std::errc() && stop == end;
}

std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 10> sizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

bool is_floating(Scalar type) {
  return type == Scalar::float32 || type == Scalar::float64;
}

ByteCursor::ByteCursor(std::string_view bytes, std::size_t begin, const std::string& name, bool big_endian)
    : bytes_(bytes), name_(name), big_endian_(big_endian), next_(begin), last_begin_(begin) {}

void ByteCursor::fail(const std::string& reason, const std::string& expected) const {
  throw InvalidInput(name_ + ":byte " + std::to_string(last_begin_), prefix() + reason, expected);
}

void ByteCursor::fail_here(const std::string& reason, const std::string& expected) const {
  throw InvalidInput(name_ + ":byte " + std::to_string(next_), prefix() + reason, expected);
}

void ByteCursor::require(std::uint64_t count, std::size_t size) const {
  if (size == 0 || count <= remaining() / size) return;
  const std::string wanted =
      count == 1 ? std::to_string(size) : std::to_string(count) + " x " + std::to_string(size);
  fail_here("the file ends here, " + std::to_string(remaining()) + " bytes are left", wanted + " bytes");
}

void ByteCursor::skip(std::uint64_t count, std::size_t size) {
  require(count, size);
  next_ += static_cast<std::size_t>(count) * size;
}

std::string ByteCursor::found() const {
  return shortest(last_);
}

template <class T>
double ByteCursor::take() {
  require(1, sizeof(T));
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes_.data() + next_, sizeof(T));
  if (big_endian_ != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  last_begin_ = next_;
  next_ += sizeof(T);
  last_ = static_cast<double>(std::bit_cast<T>(raw));
  return last_;
}

double ByteCursor::number(Scalar type) {
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
    case Scalar::float64:
      return take<double>();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tendril::bind
