#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/collision/adapter.h"
#include "bench/clock.h"

namespace tendril::suite {

/// What a run was asked for.
struct Settings {
  long count = 2000;  ///< queries of a family
  std::uint64_t seed = 1;
  std::string data;  ///< folder of public continuous queries; empty for none
  std::string csv;   ///< folder for the continuous queries made, with their truth; empty for none
};

/// What one library made of one family of queries. Undecided is no error, and no answer.
struct Row {
  std::string section, family, peer;
  long queries = 0;
  long positive = 0;  ///< where the sets truly meet
  long missed = 0;    ///< of these said to be apart
  long invented = 0;  ///< of the others said to meet
  long undecided = 0;
  long wrong = 0;                    ///< in any other respect, which the section says
  double us = 0.0;                   ///< CPU time a query
  std::optional<double> error = {};  ///< largest, of distances relative to the size, of brackets of times

  bool own() const { return peer.starts_with("tendril"); }
};

/// A part of the suite, by the name that --only knows it by.
struct Section {
  std::string name, about;
  std::function<void(const Settings&, std::vector<Row>&)> run;
};
std::vector<Section> sections();

void triangles_section(const Settings& settings, std::vector<Row>& rows);
void segments_section(const Settings& settings, std::vector<Row>& rows);
void distance_section(const Settings& settings, std::vector<Row>& rows);
void inside_section(const Settings& settings, std::vector<Row>& rows);
void balls_section(const Settings& settings, std::vector<Row>& rows);
void straight_section(const Settings& settings, std::vector<Row>& rows);
void cubic_section(const Settings& settings, std::vector<Row>& rows);
void bound_section(const Settings& settings, std::vector<Row>& rows);
void posed_section(const Settings& settings, std::vector<Row>& rows);
void hostile_section(const Settings& settings, std::vector<Row>& rows);

/// As a table under headings; the JSON that collision/ACCURACY.md describes; the picture.
std::string to_table(const std::vector<Row>& rows);
std::string to_json(const Settings& settings, const std::vector<Row>& rows);
std::string to_svg(const std::vector<Row>& rows);
/// Wrong answers of tendril's own.
long own_errors(const std::vector<Row>& rows);

/// Asks all queries, a few times over where they are few, and counts. Nothing is asked where `fit` is 0.
template <class Query, class Ask>
Row judge(Row row, const std::vector<Query>& queries, const std::vector<char>& truth,
          const std::vector<char>& fit, const Ask& ask) {
  std::vector<Said> said(queries.size());
  const int rounds = queries.size() < 20000 ? 5 : 1;
  const double seconds = bench::fastest(rounds, [&] {
    for (std::size_t i = 0; i < queries.size(); ++i)
      if (fit[i]) said[i] = ask(queries[i]);
  });
  long asked = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    asked += fit[i];
    row.positive += truth[i];
    row.undecided += !said[i];
    row.missed += said[i] && !*said[i] && truth[i];
    row.invented += said[i] && *said[i] && !truth[i];
  }
  row.queries = static_cast<long>(queries.size());
  row.us = asked > 0 ? 1e6 * seconds / static_cast<double>(asked) : 0.0;
  return row;
}

}  // namespace tendril::suite
