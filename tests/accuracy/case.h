#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The validation book: cases with a closed form (or a reference that another method certifies), each run
/// once and then both held to its figures by a test and printed on a page.
namespace tendril::accuracy {

/// One result: `n` edges, or steps.
struct Row {
  int n;
  double value, error;
  std::optional<double> extrapolated = {};  ///< error left by Richardson's extrapolation from the row before
};

/// What the error at n must not exceed.
struct Limit {
  int n;
  double error;
};

/// Order of the error in 1 / n between neighbouring rows, from the first n on.
struct Order {
  double expected, within;
  int from;
};

/// One number of a case, at several n, and what it is held to.
struct Quantity {
  std::string name;
  double reference;
  std::string error_is;  ///< "of the length", "relative", "absolute"
  std::vector<Row> rows = {};
  std::vector<Limit> limits = {};
  std::optional<Order> order = {};
  std::optional<Limit> extrapolated = {};  ///< of every row from this n on
};

/// Points of one line of a figure. References are grey and lie below; without a name it is not in the legend.
struct Curve {
  enum class Kind { line, marks, reference };
  std::string name;
  std::vector<std::pair<double, double>> points;
  Kind kind = Kind::line;
};

struct Figure {
  std::string title, x, y;
  std::vector<Curve> curves = {};
  bool same_scale = false;  ///< of both axes
};

/// A case of the book with its results.
struct Case {
  std::string id;         ///< short, "C1"
  std::string title;      ///< in words
  std::string formula;    ///< the closed form, and where it stands in the literature
  std::string goal = "";  ///< the line of the table of goals it answers, "A1", or empty
  std::string count = "edges";
  std::vector<Quantity> quantities = {};
  std::vector<Figure> figures = {};
  std::vector<std::string> notes = {};
};

/// A case that can be run.
struct Entry {
  const char* name;  ///< of the test, in letters and digits
  Case (*run)();
};
const std::vector<Entry>& entries();

/// One thing a quantity is held to, and whether it holds.
struct Verdict {
  std::string what;
  Row row;  ///< the value and error it is about
  std::string limit, order;
  bool holds;
};
std::vector<Verdict> judge(const Quantity& quantity);

/// Order between two rows.
double order_between(const Row& coarse, const Row& fine);

/// One line a verdict, under a heading; plain text.
std::string table_heading();
std::string to_table(const Case& one);

std::string to_svg(const Figure& figure);
/// Errors of a case's quantities over n, both logarithmic; empty where no quantity has two rows with an
/// error.
std::string errors_svg(const Case& one);

/// The page: HTML that needs no other file.
std::string to_html(const std::vector<Case>& cases);

}  // namespace tendril::accuracy
