#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace tendril::bench {

using OrderedJson = nlohmann::ordered_json;

/// A printf-like number: text("%.3g", x).
std::string text(const char* format, double value);

/// Seconds in readable units, three digits.
std::string duration(double seconds);

/// Rows of text under headings, the columns as wide as they need to be: the first to the left, the others to
/// the right.
class Table {
 public:
  explicit Table(std::vector<std::string> headings) : rows_{std::move(headings)} {}
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  void print() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// "== name ==" and a sentence on what follows.
void heading(const std::string& name, const std::string& about);

}  // namespace tendril::bench
