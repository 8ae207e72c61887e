#include "off_columns.h"

#include <limits>

#include "io/values/color_list.h"

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
    for (std::size_t k = first_; k < first_ + 3; ++k) squares += line[k] * line[k];
    // A normal of a flat face is often written as nan: such a line says nothing of what its column is.
    if (!std::isfinite(squares)) return;
    // Exporters write as few as two digits, which leaves a unit vector off by a hundredth.
    unit_ &= std::abs(squares - 1) < 0.02;
    for (std::size_t k = first_; k < first_ + 3; ++k) {
      in_255_ &= line[k] >= 0 && line[k] <= 255;
      above_one_ |= line[k] > 1 + kColorSlack;
      fractions_ |= fraction[k];
    }
  }
  bool normal() const { return unit_; }
  /// Whole numbers up to 1 alone are no evidence of a color: they would be near black, or flags.
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

/// Whether a face stands in each of the lines that are left, as many as the header says. This tells columns
/// from free-form text: lines of two vertices have six numbers, too, but then there are fewer of them.
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

constexpr OffColumn kNormal{OffColumn::normal, 3}, kRgb{OffColumn::color, 3}, kRgba{OffColumn::color, 4},
    kTexture{OffColumn::texture, 2};

/// A color of three or four numbers with the normal behind it, where that is a normal.
Columns color_before_normal(const VertexLines& seen) {
  if (seen.numbers == 9 && seen.seventh.normal()) return {kRgb, kNormal};
  if (seen.numbers == 10 && seen.eighth.normal()) return {kRgba, kNormal};
  return {};
}

Columns columns_of_plain(const VertexLines& seen) {
  const bool normal = seen.behind_point.normal(), color = seen.behind_point.color();
  switch (seen.numbers) {
    case 5:
      return {kTexture};
    case 6:
      return normal ? Columns{kNormal} : color ? Columns{kRgb} : Columns{};
    case 7:
      return color ? Columns{kRgba} : Columns{};
    case 8:
      return normal ? Columns{kNormal, kTexture} : Columns{};
    case 9:
    case 10:
      // Both orders are about; where both could be meant, the one of the specification.
      if (normal && seen.seventh.color()) return {kNormal, seen.numbers == 9 ? kRgb : kRgba};
      return color ? color_before_normal(seen) : Columns{};
    default:
      return {};
  }
}

/// Under NCOFF the specification's order holds unless the values contradict it.
Columns columns_of_normal_color(const VertexLines& seen) {
  return seen.behind_point.normal() ? Columns{} : color_before_normal(seen);
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

/// Costs a look at one line where that has three numbers, as in nearly all files; else a pass over all.
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
