#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tendril::gallery {

struct Bounds {
  double low, high;
};

/// One number of an experiment, and what a test holds it to.
struct Number {
  std::string name;
  double value;
  std::optional<Bounds> within = {};  ///< none: a time, which no test can hold
  bool holds() const { return !within || (value >= within->low && value <= within->high); }
};

enum class Verdict { holds, partly, fails };
const char* to_string(Verdict verdict);

/// A line of the table: what the thesis says, what was measured, and whether that bears it out.
struct Claim {
  std::string claimed, measured;
  Verdict verdict;
  std::string because = {};  ///< in how far, or why not
};

struct Picture {
  std::string svg, caption;
};

/// An experiment of the thesis, run.
struct Figure {
  std::string id;     ///< of the thesis, "4.1"
  std::string title;  ///< in words
  std::string what;   ///< what the thesis shows, and how it is run here
  std::vector<Picture> pictures = {};
  std::vector<Claim> claims = {};
  std::vector<Number> numbers = {};
  std::vector<std::string> notes = {};
  std::string left_out = {};  ///< of the scene and the program, and what that saved

  /// The number of that name; throws std::out_of_range.
  double number(const std::string& name) const;
};

/// An experiment that can be run.
struct Entry {
  const char* name;  ///< of the test, in letters and digits
  const char* id;    ///< of the figure
  Figure (*run)();
};
/// In the order of the thesis.
const std::vector<Entry>& entries();

/// "%.3g" and the like.
std::string text(const char* format, double value);

/// The page, which needs no other file; and the same numbers for machines.
std::string to_html(const std::vector<Figure>& figures);
std::string to_json(const std::vector<Figure>& figures);

}  // namespace tendril::gallery
