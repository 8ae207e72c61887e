#include "scene/json/line_of.h"

#include "scene/json/json_node.h"

#include <algorithm>
#include <iterator>

namespace tendril::scene {
namespace {

/// Reads a text and notes how far the parser has come.
class Reading {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Reading(const char* at, const char** come) : at_(at), come_(come) {}
  reference operator*() const { return *at_; }
  Reading& operator++() {
    *come_ = ++at_;
    return *this;
  }
  Reading operator++(int) {
    Reading before = *this;
    ++*this;
    return before;
  }
  bool operator==(const Reading& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  const char** come_;
};

/// Walks along with the parser, whose events come as soon as it has read what they are about; after a number,
/// one character later. Stops at the value asked for.
class Search : public nlohmann::json_sax<Json> {
 public:
  Search(std::string_view text, const std::string& wanted, const char* const& come)
      : text_(text), wanted_(wanted), come_(come) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& key) override {
    levels_.back().key = key;
    return note();
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    line_ = 0;
    return false;
  }

  std::size_t line() const { return line_; }

 private:
  struct Level {
    bool is_array;
    std::size_t index = 0;
    std::string key{};
  };

  std::string pointer() const {
    std::string out;
    for (const Level& level : levels_)
      out += "/" + (level.is_array ? std::to_string(level.index) : escape(level.key));
    return out;
  }

  /// Where what has just been read lies on the way to what is wanted, its line is the best known so far.
  bool note() {
    const std::string here = pointer();
    if (wanted_.compare(0, here.size(), here) != 0) return true;
    if (wanted_.size() > here.size() && wanted_[here.size()] != '/') return true;
    const char* last = come_ - (come_ == text_.data() ? 0 : 1);
    line_ = static_cast<std::size_t>(1 + std::count(text_.data(), last, '\n'));
    return here != wanted_;
  }
  bool value() {
    if (levels_.empty() || !levels_.back().is_array) return true;
    const bool go_on = note();
    ++levels_.back().index;
    return go_on;
  }
  bool open(bool is_array) {
    if ((levels_.empty() || levels_.back().is_array) && !note()) return false;
    levels_.push_back({is_array});
    return true;
  }
  bool close() {
    levels_.pop_back();
    if (!levels_.empty() && levels_.back().is_array) ++levels_.back().index;
    return true;
  }

  std::string_view text_;
  const std::string& wanted_;
  const char* const& come_;
  std::vector<Level> levels_;
  std::size_t line_ = 0;
};

}  // namespace

std::size_t line_of(std::string_view text, const std::string& pointer) {
  const char* come = text.data();
  Search search(text, pointer, come);
  const Reading begin(text.data(), &come), end(text.data() + text.size(), &come);
  Json::sax_parse(begin, end, &search, Json::input_format_t::json, true, true);
  return search.line();
}

SceneError with_line(const SceneError& error, std::string_view text) {
  FilePlace at = error.at();
  if (at.line == 0) at.line = line_of(text, at.pointer);
  return {at, error.reason(), error.expected()};
}

}  // namespace tendril::scene
