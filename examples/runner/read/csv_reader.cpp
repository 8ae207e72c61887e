#include "read/csv_reader.h"

#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace tendril::runner {
namespace {

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number(std::string_view field) {
  double value = 0.0;
  const char* end = field.data() + field.size();
  const auto result = std::from_chars(field.data(), end, value);
  if (result.ec != std::errc{} || result.ptr != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Letters and digits, beginning with a letter, and none of the words that stand for a number.
bool names_a_column(std::string_view field) {
  double value = 0.0;
  const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
  return !field.empty() && std::isalpha(static_cast<unsigned char>(field.front())) != 0 &&
         result.ec == std::errc::invalid_argument;
}

Vec3 point_of(const std::vector<std::string_view>& fields, const std::string& place) {
  const std::string expected = "three finite numbers x,y,z";
  if (fields.size() != 3) throw InvalidInput(place, std::to_string(fields.size()) + " fields", expected);
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = number(fields[k]);
    if (!value)
      throw InvalidInput(place,
                         "'" + std::string(fields[k].substr(0, 40)) + "' in field " + std::to_string(k + 1),
                         expected);
    point[static_cast<Eigen::Index>(k)] = *value;
  }
  return point;
}

bool is_header(const std::vector<std::string_view>& fields) {
  return fields.size() == 3 && names_a_column(fields[0]) && names_a_column(fields[1]) &&
         names_a_column(fields[2]);
}

}  // namespace

std::vector<Vec3> read_points_csv(const std::string& path) {
  const std::string bytes = read_file(path);
  std::string_view rest = bytes;
  std::vector<Vec3> points;
  bool first = true;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    const std::string_view raw = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::string_view text = trim(raw.substr(0, raw.find('#')));
    if (text.empty()) continue;
    const auto fields = split(text);
    if (!(first && is_header(fields))) points.push_back(point_of(fields, path + ":" + std::to_string(line)));
    first = false;
  }
  if (points.empty()) throw InvalidInput(path, "no points", "at least one line x,y,z");
  return points;
}

}  // namespace tendril::runner
