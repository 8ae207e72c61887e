#include "cursor.h"

#include <tendril/base/error.h>
#include <tendril/base/number.h>

#include <array>
#include <cfenv>
#include <charconv>

namespace tendril::bind {
namespace {

/// Whether a number out of the range of double is below it: its first digit that is not 0 stands at a
/// negative power of ten. An exponent of more digits than a long holds decides by its sign.
bool underflows(std::string_view token) {
  const std::size_t e = token.find_first_of("eE");
  const std::string_view digits = token.substr(0, e);
  const std::size_t first = digits.find_first_of("123456789");
  if (first == digits.npos) return true;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  long exponent = 0;
  if (e != token.npos) {
    std::string_view power = token.substr(e + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    const auto code = std::from_chars(power.data(), power.data() + power.size(), exponent).ec;
    if (code != std::errc()) return power.starts_with('-');
  }
  const auto place = static_cast<long>(point) - static_cast<long>(first);
  return exponent < -place;
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
    : bytes_(bytes), name_(name), comments_(comments), rounds_to_nearest_(std::fegetround() == FE_TONEAREST) {
  if (bytes_.starts_with("\xEF\xBB\xBF")) next_ = 3;  // some editors put a UTF-8 byte order mark in front
}

void TextCursor::fail(const std::string& reason, const std::string& expected) const {
  throw InvalidInput(name_ + ":" + std::to_string(last_line_), prefix() + reason, expected);
}

std::string_view TextCursor::token_in_line() {
  if (line_done()) return {};
  return take_token();
}

bool TextCursor::take_continuation() {
  skip_blanks();
  if (next_ == bytes_.size() || bytes_[next_] != '\\') return false;
  std::size_t end = next_ + 1;
  while (end < bytes_.size() && kind_of(bytes_[end]) == blank) ++end;
  if (end < bytes_.size() && kind_of(bytes_[end]) != line_end) return false;
  next_ = end;
  if (end < bytes_.size()) take_line_end();
  return true;
}

bool TextCursor::done() {
  skip_to_token();
  return next_ == bytes_.size();
}

std::string_view TextCursor::rest_of_line() {
  const std::size_t begin = next_;
  last_line_ = line_;
  while (next_ < bytes_.size() && kind() != line_end) ++next_;
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
  if (code == std::errc::result_out_of_range && stop == end && underflows(token)) {
    value = token.starts_with('-') ? -0.0 : 0.0;
    return true;
  }
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

void ByteCursor::fail_short(std::uint64_t count, std::size_t size) const {
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

}  // namespace tendril::bind
