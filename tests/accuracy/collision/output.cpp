#include <cstdio>
#include <nlohmann/json.hpp>

#include "accuracy/collision/suite.h"

namespace tendril::suite {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson to_json(const Row& row) {
  return {{"section", row.section},
          {"family", row.family},
          {"library", row.peer},
          {"queries", row.queries},
          {"positive", row.positive},
          {"false_negatives", row.missed},
          {"false_positives", row.invented},
          {"undecided", row.undecided},
          {"wrong", row.wrong},
          {"us", row.us},
          {"error", row.error ? OrderedJson(*row.error) : OrderedJson()}};
}

std::string line_of(const Row& row) {
  char text[256];
  std::snprintf(text, sizeof text, "  %-33s %-22s %9ld %9ld %8ld %8ld %9ld %7ld %10.3f", row.family.c_str(),
                row.peer.c_str(), row.queries, row.positive, row.missed, row.invented, row.undecided,
                row.wrong, row.us);
  std::string out = text;
  if (row.error) {
    std::snprintf(text, sizeof text, " %9.1e", *row.error);
    out += text;
  }
  return out + "\n";
}

}  // namespace

std::string to_table(const std::vector<Row>& rows) {
  char text[256];
  std::snprintf(text, sizeof text, "  %-33s %-22s %9s %9s %8s %8s %9s %7s %10s %9s\n", "family", "library",
                "queries", "positive", "missed", "invented", "undecided", "wrong", "us", "error");
  std::string out;
  for (const Row& row : rows) {
    if (&row == &rows.front() || row.section != (&row - 1)->section) out += row.section + "\n" + text;
    out += line_of(row);
  }
  return out;
}

long own_errors(const std::vector<Row>& rows) {
  long out = 0;
  for (const Row& row : rows)
    if (row.own()) out += row.missed + row.invented + row.wrong;
  return out;
}

std::string to_json(const Settings& settings, const std::vector<Row>& rows) {
  OrderedJson out{{"version", 1}, {"count", settings.count}, {"seed", settings.seed}};
  out["own_errors"] = own_errors(rows);
  out["rows"] = OrderedJson::array();
  for (const Row& row : rows) out["rows"].push_back(to_json(row));
  return out.dump(2) + "\n";
}

}  // namespace tendril::suite
