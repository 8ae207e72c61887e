#include <tendril/base/error.h>
#include <tendril/collision/query_file.h>

#include <cmath>

#include "fraction.h"

namespace tendril::collision {
namespace {

/// Reads rows of columns and knows where it is.
class Rows {
 public:
  Rows(std::string_view text, const std::string& place) : text_(text), place_(place) {}

  bool at_end() const { return text_.empty(); }

  /// \return  the columns of the next row
  std::vector<std::string_view> next(std::size_t columns) {
    ++line_;
    if (text_.empty()) fail("the last query is cut short", "whole queries");
    std::string_view row = text_.substr(0, text_.find('\n'));
    text_.remove_prefix(std::min(text_.size(), row.size() + 1));
    if (row.ends_with('\r')) row.remove_suffix(1);
    std::vector<std::string_view> found;
    for (std::size_t end = 0; end != std::string_view::npos;
         row.remove_prefix(end == row.npos ? 0 : end + 1)) {
      end = row.find(',');
      found.push_back(row.substr(0, end));
    }
    if (found.size() != columns)
      fail(std::to_string(found.size()) + " columns", std::to_string(columns) + " columns");
    return found;
  }

  double fraction(std::string_view numerator, std::string_view denominator) const {
    const auto value = from_fraction(numerator, denominator);
    if (!value)
      fail("'" + std::string(numerator) + "," + std::string(denominator) + "' is no double",
           "an integer and a power of two");
    return *value;
  }

  [[noreturn]] void fail(const std::string& reason, const std::string& expected) const {
    throw InvalidInput(place_ + ":" + std::to_string(line_), reason, expected);
  }

 private:
  std::string_view text_;
  const std::string& place_;
  int line_ = 0;
};

bool answer(const Rows& rows, std::string_view column) {
  if (column != "0" && column != "1") rows.fail("'" + std::string(column) + "' is no answer", "0 or 1");
  return column == "1";
}

template <int Degree>
constexpr std::size_t columns = Degree == 1 ? 7 : 11;

template <int Degree>
KnownQuery<Degree> read_query(Rows& rows) {
  KnownQuery<Degree> query;
  for (int row = 0; row < 4 * (Degree + 1); ++row) {
    const auto cells = rows.next(columns<Degree>);
    for (int axis = 0; axis < 3; ++axis)
      query.paths[row % 4][row / 4][axis] = rows.fraction(cells[2 * axis], cells[2 * axis + 1]);
    const bool meets = answer(rows, cells[6]);
    if (row > 0 && meets != query.meets) rows.fail("the answer changes within a query", "one answer");
    query.meets = meets;
    if constexpr (Degree == 3) {
      query.from = rows.fraction(cells[7], cells[8]);
      query.to = rows.fraction(cells[9], cells[10]);
    }
  }
  return query;
}

void append(std::string& text, double x) {
  if (!std::isfinite(x)) throw InvalidInput("write_queries", "a number is not finite", "finite coordinates");
  text += to_fraction(x) + ',';
}

template <int Degree>
void write_row(std::string& text, const KnownQuery<Degree>& query, const Vec3& point) {
  for (int axis = 0; axis < 3; ++axis) append(text, point[axis]);
  text += query.meets ? "1," : "0,";
  if constexpr (Degree == 3) {
    append(text, query.from);
    append(text, query.to);
  }
  text.back() = '\n';
}

}  // namespace

template <int Degree>
std::vector<KnownQuery<Degree>> read_queries(std::string_view text, const std::string& place) {
  std::vector<KnownQuery<Degree>> queries;
  for (Rows rows(text, place); !rows.at_end();) queries.push_back(read_query<Degree>(rows));
  return queries;
}

template <int Degree>
std::string write_queries(const std::vector<KnownQuery<Degree>>& queries) {
  std::string text;
  for (const KnownQuery<Degree>& query : queries)
    for (int i = 0; i <= Degree; ++i)
      for (const auto& path : query.paths) write_row(text, query, path[i]);
  return text;
}

template std::vector<KnownQuery<1>> read_queries<1>(std::string_view, const std::string&);
template std::vector<KnownQuery<3>> read_queries<3>(std::string_view, const std::string&);
template std::string write_queries<1>(const std::vector<KnownQuery<1>>&);
template std::string write_queries<3>(const std::vector<KnownQuery<3>>&);

}  // namespace tendril::collision
