#include "read/csv_reader.h"

#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <algorithm>
#include <array>
#include <cctype>
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

/// At commas, or at blanks where there is none.
std::vector<std::string_view> split(std::string_view line) {
  const bool comma = line.find(',') != line.npos;
  const std::string_view separators = comma ? "," : " \t";
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = line.find_first_of(separators);
    const std::string_view field = trim(line.substr(0, end));
    if (comma || !field.empty()) fields.push_back(field);
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number(std::string_view field) {
  if (field.starts_with('+') && !field.starts_with("+-")) field.remove_prefix(1);
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

/// Where a line's coordinates stand.
struct Columns {
  std::size_t count = 3;
  std::array<std::size_t, 3> at{0, 1, 2};
};

Vec3 point_of(const std::vector<std::string_view>& fields, const Columns& columns, const std::string& place) {
  const std::string expected = "three finite numbers x,y,z";
  if (fields.size() != columns.count)
    throw InvalidInput(place, std::to_string(fields.size()) + " fields", expected);
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string_view field = fields[columns.at[k]];
    const auto value = number(field);
    if (!value)
      throw InvalidInput(
          place, "'" + std::string(field.substr(0, 40)) + "' in field " + std::to_string(columns.at[k] + 1),
          expected);
    point[static_cast<Eigen::Index>(k)] = *value;
  }
  return point;
}

bool is_header(const std::vector<std::string_view>& fields) {
  return fields.size() >= 3 && std::all_of(fields.begin(), fields.end(), names_a_column);
}

/// The columns x, y and z of a header, or the three there are.
Columns columns_of_header(const std::vector<std::string_view>& fields, const std::string& place) {
  Columns columns{fields.size(), {0, 1, 2}};
  std::size_t found = 0;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const char name = static_cast<char>(std::tolower(static_cast<unsigned char>(fields[k][0])));
    if (fields[k].size() != 1 || name < 'x' || name > 'z') continue;
    columns.at[static_cast<std::size_t>(name - 'x')] = k;
    ++found;
  }
  if (found != 3 && fields.size() != 3)
    throw InvalidInput(place, std::to_string(fields.size()) + " columns",
                       "three, or columns named x, y and z");
  return found == 3 ? columns : Columns{};
}

/// Without a header, four fields are a whole number, the point's id, and its coordinates.
Columns columns_of_first(const std::vector<std::string_view>& fields) {
  const auto id = fields.size() == 4 ? number(fields[0]) : std::nullopt;
  return id && *id == std::floor(*id) ? Columns{4, {1, 2, 3}} : Columns{};
}

}  // namespace

std::vector<Vec3> read_points_csv(const std::string& path) {
  const std::string bytes = read_file(path);
  std::string_view rest = bytes;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // a byte order mark
  std::vector<Vec3> points;
  std::optional<Columns> columns;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    const std::string_view raw = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::string_view text = trim(raw.substr(0, raw.find('#')));
    if (text.empty()) continue;
    const auto fields = split(text);
    const std::string place = path + ":" + std::to_string(line);
    if (!columns && is_header(fields)) {
      columns = columns_of_header(fields, place);
      continue;
    }
    if (!columns) columns = columns_of_first(fields);
    points.push_back(point_of(fields, *columns, place));
  }
  if (points.empty()) throw InvalidInput(path, "no points", "at least one line x,y,z");
  return points;
}

}  // namespace tendril::runner
