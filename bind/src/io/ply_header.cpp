#include "ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <utility>

namespace tendril::bind {
namespace {

constexpr std::array<std::pair<std::string_view, Scalar>, 18> scalar_names{{
    {"char", Scalar::int8},
    {"int8", Scalar::int8},
    {"uchar", Scalar::uint8},
    {"uint8", Scalar::uint8},
    {"short", Scalar::int16},
    {"int16", Scalar::int16},
    {"ushort", Scalar::uint16},
    {"uint16", Scalar::uint16},
    {"int", Scalar::int32},
    {"int32", Scalar::int32},
    {"uint", Scalar::uint32},
    {"uint32", Scalar::uint32},
    {"int64", Scalar::int64},
    {"uint64", Scalar::uint64},
    {"float", Scalar::float32},
    {"float32", Scalar::float32},
    {"double", Scalar::float64},
    {"float64", Scalar::float64},
}};

/// Reads the header line by line, and knows the names already taken.
class HeaderReader {
 public:
  HeaderReader(TextCursor& in, const Notes& notes) : in_(in), notes_(notes) {}

  PlyHeader read() {
    in_.at("header");
    if (in_.token("ply") != "ply") in_.fail("the first word is " + in_.found(), "ply");
    end_line();
    for (;;) {
      const std::string_view keyword = in_.token("end_header");
      if (keyword == "end_header") break;
      if (keyword == "comment" || keyword == "obj_info") {
        in_.rest_of_line();
        continue;
      }
      if (notes_.tolerant() && !is_keyword(keyword)) {
        notes_.add(in_.place() + "a line that begins with " + in_.found() + ", taken for a comment");
        in_.rest_of_line();
        continue;
      }
      read_line(keyword);
      end_line();
    }
    if (!has_format_) in_.fail("no line 'format'", "format ascii, binary_little_endian or binary_big_endian");
    const std::string_view rest = in_.rest_of_line();
    if (rest.find_first_not_of(" \t") != rest.npos)
      in_.fail(quoted(rest) + " after end_header", "the end of the line");
    return std::move(header_);
  }

 private:
  /// Numbers are no forgotten comments: there the header's end is missing.
  static bool is_keyword(std::string_view word) {
    const bool letter = (word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z');
    return word == "format" || word == "element" || word == "property" || !letter;
  }

  void read_line(std::string_view keyword) {
    if (keyword == "format") {
      read_format();
    } else if (keyword == "element") {
      read_element();
    } else if (keyword == "property") {
      read_property();
    } else {
      in_.fail("unknown keyword " + in_.found(),
               "format, element, property, comment, obj_info or end_header");
    }
  }

  std::string_view word(const char* expected) {
    const std::string_view token = in_.token_in_line();
    if (token.empty()) in_.fail("the line ends after " + in_.found(), expected);
    return token;
  }

  void end_line() {
    if (in_.line_done()) return;
    in_.token_in_line();
    in_.fail("the word " + in_.found() + " is one too many", "the end of the line");
  }

  void read_format() {
    constexpr std::array<std::string_view, 3> names{"ascii", "binary_little_endian", "binary_big_endian"};
    if (has_format_) in_.fail("a second line 'format'", "one");
    has_format_ = true;
    const auto* const name = std::find(names.begin(), names.end(), word("the format's name"));
    if (name == names.end())
      in_.fail("format " + in_.found(), "ascii, binary_little_endian or binary_big_endian");
    header_.format = static_cast<PlyFormat>(name - names.begin());
    if (word("version 1.0") != "1.0") in_.fail("version " + in_.found(), "1.0");
  }

  void read_element() {
    PlyElement element;
    element.name = word("the element's name");
    if (!elements_.insert(element.name).second)
      in_.fail("a second element " + in_.found(), "each element once");
    const std::string_view count = word("the number of elements");
    const auto [stop, code] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (code != std::errc() || stop != count.data() + count.size()) {
      in_.fail("the number of elements is " + in_.found(), "a whole number");
    }
    properties_.clear();
    header_.elements.push_back(std::move(element));
  }

  Scalar scalar(std::string_view name) {
    const auto* const found = std::find_if(scalar_names.begin(), scalar_names.end(),
                                           [name](const auto& entry) { return entry.first == name; });
    if (found == scalar_names.end())
      in_.fail("unknown type " + in_.found(), "a type such as uchar, int or float");
    return found->second;
  }

  void read_property() {
    if (header_.elements.empty()) in_.fail("a property before any element", "a line 'element' first");
    PlyProperty property{};
    std::string_view type = word("a type");
    if (type == "list") {
      property.count_type = scalar(word("the type of the list's length"));
      if (is_floating(*property.count_type))
        in_.fail("a list's length of type " + in_.found(), "an integer type");
      type = word("the type of the list's entries");
    }
    property.type = scalar(type);
    property.name = word("the property's name");
    if (!properties_.insert(property.name).second)
      in_.fail("a second property " + in_.found(), "each property once");
    header_.elements.back().properties.push_back(property);
  }

  TextCursor& in_;
  Notes notes_;
  PlyHeader header_;
  bool has_format_ = false;
  std::set<std::string_view> elements_, properties_;
};

}  // namespace

const PlyElement* PlyHeader::find(std::string_view name) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [name](const auto& e) { return e.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader read_ply_header(TextCursor& in, const Notes& notes) {
  return HeaderReader(in, notes).read();
}

}  // namespace tendril::bind
