#include "off_columns.h"

#include <limits>

#include "color_list.h"

namespace tendril::bind {
namespace {

using Columns = std::vector<OffColumn>;
constexpr std::size_t kMost = 10;  // numbers in a vertex' line
using Line = std::array<double, kMost + 1>;

/// What three columns look like, over all lines.
class Triple {
 public:
  explicit Triple(std::size_t first) : first_(first) {}

  void see(const Line& line, const std::array<bool, kMost + 1>& fraction) {
    double squares = 0;
    for (std::size_t k = first_; k < first_ + 3; ++k) {
      squares += line[k] * line[k];
      in_255_ &= line[k] >= 0 && line[k] <= 255;
      above_one_ |= line[k] > 1 + kColorSlack;
      fractions_ |= fraction[k];
    }
    // Exporters write three digits; numbers that are none ("nan") say nothing.
    if (std::isfinite(squares)) unit_ &= std::abs(squares - 1) < 0.02;
    in_255_ |= !std::isfinite(squares);
  }
  bool normal() const { return unit_; }
  bool color() const { return !unit_ && in_255_ && (above_one_ || fractions_); }

 private:
  std::size_t first_;
  bool unit_ = true, in_255_ = true, above_one_ = false, fractions_ = false;
};

/// The lines of the vertices: how many numbers each has, and what those behind the point look like.
struct VertexLines {
  std::size_t numbers = 0;  ///< 0 where the lines differ
  Triple behind_point{3}, seventh{6}, eighth{7};
};

/// Numbers in a line; more than kMost count as kMost + 1.
std::size_t take_line(TextCursor& in, Line& line, std::array<bool, kMost + 1>& fraction) {
  line.fill(0);
  std::size_t count = 0;
  while (!in.line_done()) {
    in.token_in_line();
    if (count > kMost) continue;
    if (!parse_number(in.last(), line[count])) line[count] = std::numeric_limits<double>::quiet_NaN();
    fraction[count++] = in.last_has_fraction();
  }
  return count;
}

VertexLines look_at_vertices(TextCursor& in, std::size_t vertices) {
  VertexLines seen;
  Line line;
  std::array<bool, kMost + 1> fraction{};
  for (std::size_t v = 0; v < vertices; ++v) {
    if (in.done()) return {};
    const std::size_t count = take_line(in, line, fraction);
    if (v > 0 && count != seen.numbers) return {};
    seen.numbers = count;
    for (Triple* triple : {&seen.behind_point, &seen.seventh, &seen.eighth}) triple->see(line, fraction);
  }
  return seen;
}

/// Whether a face stands in each of the lines that are left, as many as the header says.
bool faces_follow(TextCursor& in, std::size_t faces) {
  for (std::size_t f = 0; f < faces; ++f) {
    double degree = 0;
    if (in.done() || !parse_number(in.token_in_line(), degree) || !(degree >= 1)) return false;
    double corners = 0;
    for (; !in.line_done(); ++corners) in.token_in_line();
    if (corners < degree) return false;
  }
  return in.done();
}

Columns columns_of_plain(const VertexLines& seen) {
  const bool normal = seen.behind_point.normal(), color = seen.behind_point.color();
  const auto pair = [&](OffColumn::Kind kind, std::size_t count) { return OffColumn{kind, count}; };
  switch (seen.numbers) {
    case 5:
      return {pair(OffColumn::texture, 2)};
    case 6:
      if (normal) return {pair(OffColumn::normal, 3)};
      if (color) return {pair(OffColumn::color, 3)};
      return {};
    case 7:
      if (color) return {pair(OffColumn::color, 4)};
      return {};
    case 8:
      if (normal) return {pair(OffColumn::normal, 3), pair(OffColumn::texture, 2)};
      return {};
    case 9:
      if (normal && seen.seventh.color()) return {pair(OffColumn::normal, 3), pair(OffColumn::color, 3)};
      if (color && seen.seventh.normal()) return {pair(OffColumn::color, 3), pair(OffColumn::normal, 3)};
      return {};
    case 10:
      if (normal && seen.seventh.color()) return {pair(OffColumn::normal, 3), pair(OffColumn::color, 4)};
      if (color && seen.eighth.normal()) return {pair(OffColumn::color, 4), pair(OffColumn::normal, 3)};
      return {};
    default:
      return {};
  }
}

Columns columns_of_normal_color(const VertexLines& seen) {
  if (seen.behind_point.normal()) return {};
  if (seen.numbers == 9 && seen.seventh.normal()) return {{OffColumn::color, 3}, {OffColumn::normal, 3}};
  if (seen.numbers == 10 && seen.eighth.normal()) return {{OffColumn::color, 4}, {OffColumn::normal, 3}};
  return {};
}

std::string names_of(const Columns& columns) {
  std::string names = "points";
  for (const OffColumn& column : columns)
    names += column.kind == OffColumn::normal  ? ", normals"
             : column.kind == OffColumn::color ? ", colors"
                                               : ", texture coordinates";
  return names;
}

/// Tells what was found, or refuses: always where columns are none.
Columns tell(const TextCursor& in, const std::string& reason, const char* expected, const Columns& columns,
             const Notes& notes) {
  if (columns.empty() || !notes.tolerant()) in.fail(reason, expected);
  notes.add(in.place() + reason + ": read as " + names_of(columns));
  return columns;
}

Columns plain_columns(TextCursor in, const OffHeader& header, const Notes& notes) {
  TextCursor first = in;
  if (first.done()) return {};
  Line line;
  std::array<bool, kMost + 1> fraction{};
  if (take_line(first, line, fraction) <= 3) return {};
  const VertexLines seen = look_at_vertices(in, header.vertices);
  if (seen.numbers == 0 || !faces_follow(in, header.faces)) return {};
  return tell(first, std::to_string(seen.numbers) + " numbers a vertex under OFF",
              "3, or a prefix that says what the others are: COFF or NOFF?", columns_of_plain(seen), notes);
}

}  // namespace

std::vector<OffColumn> off_columns(TextCursor in, const OffHeader& header, const Notes& notes) {
  if (header.vertices == 0 || header.texture) return {};
  in.at("vertex", 0);
  if (!header.normals && !header.colors) return plain_columns(in, header, notes);
  if (!header.normals || !header.colors) return {};
  TextCursor first = in;
  const Columns columns = columns_of_normal_color(look_at_vertices(in, header.vertices));
  if (columns.empty() || first.done()) return {};
  first.token("a number");
  return tell(first, "color before normal under NCOFF", "the normal first", columns, notes);
}

}  // namespace tendril::bind
