#include "accuracy/collision/suite.h"

#include <gtest/gtest.h>
#include <tendril/collision/query_file.h>
#include <tendril/exact/continuous.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "runner/program.h"

namespace tendril::suite {
namespace {

using Json = nlohmann::json;
using test::Folder;
using test::Outcome;

TEST(CollisionSuite, CountsWhatIsSaidAgainstTheTruth) {
  const std::vector<int> queries{0, 1, 2, 3, 4, 5, 6};
  const std::vector<char> truth{1, 1, 0, 0, 1, 0, 1}, fit{1, 1, 1, 1, 1, 1, 0};
  const std::vector<Said> said{true, false, false, true, {}, {}, true};
  const Row row = judge({"s", "f", "p"}, queries, truth, fit, [&](int i) { return said[i]; });
  EXPECT_EQ(row.queries, 7);
  EXPECT_EQ(row.positive, 4);
  EXPECT_EQ(row.missed, 1);
  EXPECT_EQ(row.invented, 1);
  EXPECT_EQ(row.undecided, 3);
  EXPECT_GT(row.us, 0.0);
}

TEST(CollisionSuite, HoldsItsOwnErrorsAgainstTendrilAndThoseOfOthersNot) {
  Row own{"s", "f", "tendril"}, doubles{"s", "f", "tendril, doubles alone"}, other{"s", "f", "FCL"};
  other.missed = other.invented = other.wrong = 5;
  EXPECT_EQ(own_errors({own, doubles, other}), 0);
  own.missed = 1;
  doubles.wrong = 2;
  EXPECT_EQ(own_errors({own, doubles, other}), 3);
  doubles.undecided = 7;
  EXPECT_EQ(own_errors({doubles, other}), 2);
  EXPECT_EQ(Json::parse(to_json({}, {own, doubles, other})).at("own_errors"), 3);
}

/// Every section with a few queries: all of tendril's answers are right, and each table has rows.
TEST(CollisionSuite, FindsNothingWrongAndWritesTableJsonAndPicture) {
  const Folder folder;
  const Outcome outcome = folder.run("--count 60 --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  const Json found = Json::parse(test::bytes_of(folder / "out/accuracy.json"));
  EXPECT_EQ(found.at("version"), 1);
  EXPECT_EQ(found.at("count"), 60);
  EXPECT_EQ(found.at("own_errors"), 0);
  std::map<std::string, long> seen;
  for (const Json& row : found.at("rows")) {
    if (row.at("library") == "tendril") seen[row.at("section")] += row.at("queries").get<long>();
    EXPECT_LE(row.at("positive"), row.at("queries"));
  }
  EXPECT_EQ(seen["triangles"], 11 * 60);
  EXPECT_EQ(seen["cubic"], 2 * 60);
  EXPECT_EQ(seen["bound"], 4 * 60);
  for (const Section& section : sections()) {
    EXPECT_EQ(seen.count(section.name), 1U) << section.name;
    EXPECT_NE(outcome.out.find(section.about + "; " + section.name), std::string::npos) << section.name;
  }
  EXPECT_EQ(test::bytes_of(folder / "out/accuracy.svg").substr(0, 4), "<svg");
}

/// A plain solver errs where tendril does not, and doubles alone leave some queries open: both are counted.
TEST(CollisionSuite, TellsErrorsFromAnswersLeftOpen) {
  const Folder folder;
  const Outcome outcome = folder.run("--count 150 --only cubic --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json found = Json::parse(outcome.out);
  long plain = 0, open = 0;
  for (const Json& row : found.at("rows")) {
    if (row.at("library") == "plain solver") plain += row.at("false_negatives").get<long>();
    if (row.at("library") == "tendril, doubles alone") open += row.at("undecided").get<long>();
    if (row.at("library") == "tendril") EXPECT_EQ(row.at("undecided"), 0);
    if (row.at("library") == "tendril") EXPECT_LE(row.at("error").get<double>(), 0x1p-40);
  }
  EXPECT_GT(plain, 0);
  EXPECT_GT(open, 0);
}

/// By default among them are pairs that are all one point, without a size to be off by.
TEST(CollisionSuite, HoldsDistancesToTheTruthByDefault) {
  const Folder folder;
  const Outcome outcome = folder.run("--only distance --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  int rows = 0;
  const Json found = Json::parse(outcome.out);
  for (const Json& row : found.at("rows")) {
    if (row.at("library") != "tendril") continue;
    ++rows;
    EXPECT_EQ(row.at("false_negatives").get<long>() + row.at("false_positives").get<long>(), 0);
  }
  EXPECT_GT(rows, 5);
}

template <int Degree>
void expect_truths(const std::string& path, collision::Features features) {
  int meet = 0;
  const auto list = collision::read_queries<Degree>(test::bytes_of(path), path);
  ASSERT_EQ(list.size(), 100U);
  for (const auto& q : list) {
    const auto found = exact::first_meeting<Degree>(features, q.paths);
    EXPECT_EQ(found.meeting == collision::Meeting::hit, q.meets);
    meet += q.meets;
    if (Degree == 1 || !q.meets) continue;
    EXPECT_LE(q.to - q.from, 0x1p-50);
    EXPECT_LE(found.from, q.to);
    EXPECT_LE(q.from, found.to);
  }
  EXPECT_GT(meet, 10);
}

TEST(CollisionSuite, WritesItsQueriesAndReadsThemBack) {
  const Folder folder;
  ASSERT_EQ(folder.run("--count 100 --only straight,cubic --csv --out out").code, 0);
  using collision::Features;
  expect_truths<1>(folder / "out/straight_vertex-face.csv", Features::vertex_face);
  expect_truths<1>(folder / "out/straight_edge-edge.csv", Features::edge_edge);
  expect_truths<3>(folder / "out/cubic_vertex-face.csv", Features::vertex_face);
  expect_truths<3>(folder / "out/cubic_edge-edge.csv", Features::edge_edge);
  std::filesystem::create_directory(folder / "data");
  for (const char* name : {"straight_vertex-face.csv", "straight_edge-edge.csv"})
    std::filesystem::rename(folder / (std::string("out/") + name), folder / (std::string("data/") + name));
  const Outcome outcome = folder.run("--count 10 --only straight --data data --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::map<std::string, long> families;
  const Json found = Json::parse(outcome.out);
  for (const Json& row : found.at("rows"))
    if (row.at("library") == "tendril") families[row.at("family")] += row.at("queries").get<long>();
  EXPECT_EQ(families["public edge-edge"], 100);
  EXPECT_EQ(families["public vertex-face"], 100);
  EXPECT_EQ(families["generic edge-edge"], 10);
}

/// A file that says what is not so is noticed: exit code 1.
TEST(CollisionSuite, FailsWhereTendrilAndTheTruthDisagree) {
  const Folder folder;
  ASSERT_EQ(folder.run("--count 20 --only straight --csv --out data").code, 0);
  std::string text = test::bytes_of(folder / "data/straight_edge-edge.csv");
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
    text[at - 1] = text[at - 1] == '1' ? '0' : '1';
  folder.write("data/straight_edge-edge.csv", text);
  const Outcome outcome = folder.run("--count 1 --only straight --data data --json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("wrong answers of its own"), std::string::npos) << outcome.err;
  const Json found = Json::parse(outcome.out);
  long wrong = 0;
  for (const Json& row : found.at("rows"))
    if (row.at("library") == "tendril")
      wrong += row.at("false_negatives").get<long>() + row.at("false_positives").get<long>();
  EXPECT_EQ(wrong, 20);
}

TEST(CollisionSuite, RefusesWhatItCannotUse) {
  const Folder folder;
  folder.write("taken", "mine");
  std::filesystem::create_directory(folder / "bad");
  folder.write("bad/edge-edge.csv", "1,2,3\n");
  const std::pair<const char*, const char*> cases[] = {
      {"--count 0", "--count"},
      {"--count many", "--count"},
      {"--only spheres", "some of triangles, segments"},
      {"--data nowhere", "--data"},
      {"--csv", "--csv"},
      {"--only triangles --count 10 --out taken", "taken"},
      {"--only straight --count 1 --data bad --out new", "bad/edge-edge.csv:1"},
      {"--quickly", "--quickly"},
  };
  for (const auto& [arguments, says] : cases) {
    const Outcome outcome = folder.run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "new/accuracy.json"));
  EXPECT_EQ(test::bytes_of(folder / "taken"), "mine");
}

#ifdef TENDRIL_MAIN_PROGRAM
TEST(CollisionSuite, IsCalledByTheProgramTendril) {
  const Folder folder;
  const std::string command = std::string("'") + TENDRIL_MAIN_PROGRAM + "' accuracy ";
  const auto code = [&](const std::string& arguments) {
    const std::string line = command + arguments + " >'" + folder / "out.txt" + "' 2>&1";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  EXPECT_EQ(code("--only triangles --count 20 --json"), 0);
  EXPECT_EQ(Json::parse(test::bytes_of(folder / "out.txt")).at("own_errors"), 0);
  EXPECT_EQ(code("--only nothing"), 2);
  EXPECT_EQ(code("--help"), 0);
  EXPECT_NE(test::bytes_of(folder / "out.txt").find("--data"), std::string::npos);
}
#endif

}  // namespace
}  // namespace tendril::suite
