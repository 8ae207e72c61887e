#include "scene/json/line_of.h"

#include "scene/json/json_walk.h"

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
class Search : public JsonWalk {
 public:
  Search(std::string_view text, const std::string& wanted, const char* const& come)
      : text_(text), wanted_(wanted), come_(come) {}

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    line_ = 0;
    return false;
  }

  std::size_t line() const { return line_; }

 private:
  /// Where what has just been read lies on the way to what is wanted, its line is the best known so far.
  bool at_key() override {
    const std::string here = pointer();
    if (wanted_.compare(0, here.size(), here) != 0) return true;
    if (wanted_.size() > here.size() && wanted_[here.size()] != '/') return true;
    const char* last = come_ - (come_ == text_.data() ? 0 : 1);
    line_ = static_cast<std::size_t>(1 + std::count(text_.data(), last, '\n'));
    return here != wanted_;
  }
  /// A value in an object stands at its key.
  bool at_scalar() override { return levels().empty() || !levels().back().is_array || at_key(); }
  bool at_open() override { return at_scalar(); }

  std::string_view text_;
  const std::string& wanted_;
  const char* const& come_;
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
