// bench_compare BOUND OLD NEW: the rows of two builds side by side, from folders with the benches' JSON,
// NAME.json in both; files of one name come from runs one after the other.
//
// For each row two figures: the median over all pairs of new over old, which no change of the machine's speed
// from pair to pair moves, and the fastest new over the fastest old, which no disturbance of single runs
// moves. A row is slower when both exceed BOUND. Rows that time nothing of the library (a plain loop, a peer)
// are controls: how far theirs are from 1 is what the others can be trusted to. A row that no old run has is
// named and not judged. The exit code is 1 when a row is slower or missing, 2 when there is nothing to
// compare.
#include <tendril/base/file.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "bench/output.h"

namespace tendril::bench {
namespace {

/// Members that tell rows apart, those that are times of the library, and those that are times of something
/// else.
const std::set<std::string> kNames{"model",   "rods",   "nodes",    "shape",     "method", "tolerance",
                                   "problem", "solver", "vertices", "precision", "curve",  "file"};
const std::set<std::string> kTimes{
    "ns_per_node", "ns_per_node_step", "seconds", "ns",       "ns_in_points_order",
    "update_ns",   "transpose_ns",     "us",      "us_alone", "ms"};
const std::set<std::string> kControls{"plain_chain_ns", "bytes_ns", "stream_ns", "de_boor_ns", "skinning_ns"};
const std::set<std::string> kOwnSolvers{"Cash-Karp", "RODAS", "automatic", "Nystrom"};

/// A row's times by its name, one a run.
struct Row {
  bool control = false;
  std::vector<double> old_times, new_times;
};
using Rows = std::map<std::string, Row>;

std::string plain(const OrderedJson& value) {
  if (value.is_string()) return value;
  return value.is_number_float() ? text("%g", value) : value.dump();
}

std::string name_of(const OrderedJson& row) {
  std::string name;
  for (const auto& [key, value] : row.items())
    if (kNames.count(key) && (key != "tolerance" || !row.contains("solver"))) name += " " + plain(value);
  return name;
}

/// Adds what is timed in an object or array and below. An object within a row is a peer's.
void collect(const OrderedJson& at, const std::string& name, bool control, bool in_row,
             std::vector<double> Row::*times, Rows& rows) {
  if (at.is_array())
    for (const OrderedJson& row : at)
      if (row.is_object()) {
        const bool peer = row.contains("solver") && !kOwnSolvers.count(row["solver"]);
        collect(row, name + name_of(row), control || peer, true, times, rows);
      }
  if (!at.is_object()) return;
  for (const auto& [key, value] : at.items()) {
    if (value.is_structured())
      collect(value, in_row && value.is_array() ? name : name + " " + key,
              control || (in_row && value.is_object()), in_row, times, rows);
    const bool other = kControls.count(key) > 0;
    if (!value.is_number() || (!other && !kTimes.count(key))) continue;
    Row& row = rows[name.substr(1) + ", " + key];
    row.control = control || other;
    (row.*times).push_back(value);
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

struct Verdict {
  double of_pairs, of_fastest;  ///< new over old
  bool slower(double bound) const { return of_pairs > bound && of_fastest > bound; }
};

Verdict judge(const Row& row) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < row.old_times.size(); ++i)
    ratios.push_back(row.new_times[i] / row.old_times[i]);
  return {median(ratios), *std::min_element(row.new_times.begin(), row.new_times.end()) /
                              *std::min_element(row.old_times.begin(), row.old_times.end())};
}

/// Prints the table.
/// \return  how many rows are slower or missing
int compare(const Rows& rows, double bound) {
  Table table({"row", "pairs", "old", "new", "median of pairs", "fastest", ""});
  int bad = 0, count = 0;
  double off = 0.0;
  for (const auto& [name, row] : rows) {
    if (row.control) continue;
    if (row.old_times.empty()) {
      table.row({name, "", "", "", "", "", "only in the new one"});
      continue;
    }
    ++count;
    if (row.old_times.size() != row.new_times.size()) {
      ++bad;
      table.row({name, "", "", "", "", "", "MISSING in some runs"});
      continue;
    }
    const Verdict verdict = judge(row);
    bad += verdict.slower(bound);
    table.row({name, std::to_string(row.old_times.size()), text("%.4g", median(row.old_times)),
               text("%.4g", median(row.new_times)), text("%.3f", verdict.of_pairs),
               text("%.3f", verdict.of_fastest), verdict.slower(bound) ? "SLOWER" : ""});
  }
  table.print();
  std::vector<double> controls;
  for (const auto& [name, row] : rows)
    if (row.control && row.old_times.size() == row.new_times.size()) {
      const Verdict verdict = judge(row);
      controls.push_back(std::min(verdict.of_pairs, verdict.of_fastest));
      off = std::max(off, controls.back());
    }
  if (!controls.empty())
    std::printf("%zu controls, the same code in both: by the same judgement the median %.3f, the most %.3f\n",
                controls.size(), median(controls), off);
  std::printf("%d rows, %d slower than %.2f or missing\n", count, bad, bound);
  return bad;
}

int run(double bound, const std::filesystem::path& old_folder, const std::filesystem::path& new_folder) {
  Rows rows;
  std::set<std::filesystem::path> names;
  for (const auto& entry : std::filesystem::directory_iterator(old_folder))
    names.insert(entry.path().filename());
  for (const auto& name : names) {
    collect(OrderedJson::parse(read_file(old_folder / name)), "", false, false, &Row::old_times, rows);
    collect(OrderedJson::parse(read_file(new_folder / name)), "", false, false, &Row::new_times, rows);
  }
  if (rows.empty()) {
    std::fprintf(stderr, "no rows in %s\n", old_folder.c_str());
    return 2;
  }
  return compare(rows, bound) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tendril::bench

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "%s BOUND OLD NEW\n", argv[0]);
    return 2;
  }
  try {
    return tendril::bench::run(std::strtod(argv[1], nullptr), argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
