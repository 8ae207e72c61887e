// The collision accuracy suite: tendril_accuracy [options], or `tendril accuracy`, which calls it.
// collision/ACCURACY.md says what it asks and what its output means. Exit codes: 0 done; 1 tendril gave a
// wrong answer; 2 bad input.
#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "accuracy/collision/suite.h"

namespace tendril::suite {
namespace {

struct Options {
  Settings settings;
  std::string out;
  std::vector<std::string> only;
  bool json = false, csv = false;
};

std::vector<Section> chosen(const Options& options) {
  if (options.only.empty()) return sections();
  std::vector<Section> out;
  for (const std::string& name : options.only) {
    const std::vector<Section> all = sections();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Section& s) { return s.name == name; });
    std::string known;
    for (const Section& s : all) known += (known.empty() ? "" : ", ") + s.name;
    if (found == all.end()) throw InvalidInput("--only", name, "some of " + known);
    out.push_back(*found);
  }
  return out;
}

void check(const Options& options) {
  if (options.settings.count < 1 || options.settings.count > 100'000'000)
    throw InvalidInput("--count", std::to_string(options.settings.count), "1 to 100000000");
  if (!options.settings.data.empty() && !std::filesystem::is_directory(options.settings.data))
    throw InvalidInput("--data", "'" + options.settings.data + "' is no folder", "a folder of CSV files");
  if (options.csv && options.out.empty())
    throw InvalidInput("--csv", "without --out", "a folder for the files");
}

void make_folder(const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw FileError(folder, error ? error.message() : "it is not a folder");
}

int carry_out(Options options) {
  check(options);
  const std::vector<Section> asked = chosen(options);
  make_folder(options.out);
  if (options.csv) options.settings.csv = options.out;
  std::vector<Row> rows;
  for (const Section& section : asked) {
    std::vector<Row> its;
    section.run(options.settings, its);
    if (!options.json) std::cout << section.about << "; " << to_table(its) << std::flush;
    rows.insert(rows.end(), its.begin(), its.end());
  }
  const std::string json = to_json(options.settings, rows);
  if (options.json) std::cout << json;
  if (!options.out.empty()) {
    write_file_whole(options.out + "/accuracy.json", json);
    write_file_whole(options.out + "/accuracy.svg", to_svg(rows));
  }
  const long wrong = own_errors(rows);
  if (wrong > 0) std::cerr << "tendril: accuracy: " << wrong << " wrong answers of its own\n";
  return wrong > 0 ? 1 : 0;
}

int run(int argc, char** argv) {
  CLI::App app{
      "Holds collision tests, tendril's and others', against exact arithmetic: errors and run times"};
  Options options;
  app.add_option("--out", options.out,
                 "folder for accuracy.json and accuracy.svg; made when it is not there");
  app.add_option("--count", options.settings.count, "queries of each family")->capture_default_str();
  app.add_option("--seed", options.settings.seed, "of the made queries")->capture_default_str();
  app.add_option("--data", options.settings.data,
                 "folder of public continuous queries (CSV, 8 rows a query), looked through");
  app.add_option("--only", options.only, "sections to run, by commas")->delimiter(',');
  app.add_flag("--csv", options.csv, "write the made continuous queries with their truth to --out, too");
  app.add_flag("--json", options.json, "print JSON");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return carry_out(options);
  } catch (const Error& error) {
    std::cerr << "tendril: accuracy: " << error.what() << '\n';
    return 2;
  }
}

}  // namespace
}  // namespace tendril::suite

int main(int argc, char** argv) {
  return tendril::suite::run(argc, argv);
}
