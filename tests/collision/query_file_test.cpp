#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/collision/query_file.h>

#include <cmath>
#include <limits>

#include "collision/ccd_data.h"
#include "support/random.h"

namespace tendril::collision {
namespace {

const std::string kRow = "1,2,-3,4,0,1,1\n";

std::string rows(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += kRow;
  return text;
}

/// A finite double of any size.
double any_double(test::Random& random) {
  const double x = std::ldexp(random.uniform(-1, 1), random.integer(2140) - 1090);
  return std::isfinite(x) ? x : 0.0;
}

TEST(QueryFile, ReadsTheRowsOfAQuery) {
  std::string text;
  for (int row = 0; row < 8; ++row) text += std::to_string(row) + ",1,-1,4,1,1125899906842624,0\n";
  const auto queries = read_queries<1>(text, "q.csv");
  ASSERT_EQ(queries.size(), 1u);
  EXPECT_FALSE(queries[0].meets);
  for (int vertex = 0; vertex < 4; ++vertex)
    for (int i = 0; i < 2; ++i)
      EXPECT_EQ(queries[0].paths[vertex][i], Vec3(4 * i + vertex, -0.25, 0x1p-50)) << vertex << ' ' << i;
}

TEST(QueryFile, GivesDoublesOfAllSizesBack) {
  test::Random random(1);
  std::vector<KnownQuery<3>> queries(60);
  for (auto& query : queries) {
    for (auto& path : query.paths)
      for (Vec3& p : path)
        for (double& x : p) x = any_double(random);
    query.meets = random.integer(2) == 1;
    query.from = random.uniform();
  }
  const double extremes[] = {std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::denorm_min(),
                             std::numeric_limits<double>::min(),
                             std::nextafter(1.0, 2.0),
                             0x1p63,
                             0x1p32};
  for (int i = 0; i < 6; ++i) queries[0].paths[0][i / 2][i % 2] = i % 3 == 0 ? -extremes[i] : extremes[i];
  const std::string text = write_queries<3>(queries);
  const auto read = read_queries<3>(text, "q.csv");
  ASSERT_EQ(read.size(), queries.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].paths, queries[i].paths) << i;
    EXPECT_EQ(read[i].meets, queries[i].meets);
    EXPECT_EQ(read[i].from, queries[i].from);
    EXPECT_EQ(read[i].to, queries[i].to);
  }
  EXPECT_EQ(write_queries<3>(read), text);
}

TEST(QueryFile, WritesFractionsInLowestTerms) {
  KnownQuery<1> query;
  for (auto& path : query.paths) path.fill(Vec3(0.375, -6.0, 0.0));
  EXPECT_EQ(write_queries<1>({query}).substr(0, 17), "3,8,-6,1,0,1,0\n3,");
}

struct Refusal {
  std::string text, place, reason;
};

TEST(QueryFile, RefusesWithThePlace) {
  const std::string eight = rows(8);
  const Refusal cases[] = {
      {rows(7), "q.csv:8", "cut short"},
      {rows(3) + "1,2,3\n" + rows(4), "q.csv:4", "3 columns"},
      {rows(7) + "1,2,-3,4,0,1,1,1\n", "q.csv:8", "8 columns"},
      {rows(7) + "1,2,-3,4,0,1,0\n", "q.csv:8", "answer changes"},
      {rows(7) + "1,2,-3,4,0,1,2\n", "q.csv:8", "no answer"},
      {"1,3,-3,4,0,1,1\n" + rows(7), "q.csv:1", "'1,3' is no double"},
      {"1,0,-3,4,0,1,1\n" + rows(7), "q.csv:1", "'1,0' is no double"},
      {"1,-2,-3,4,0,1,1\n" + rows(7), "q.csv:1", "'1,-2' is no double"},
      {"x,2,-3,4,0,1,1\n" + rows(7), "q.csv:1", "'x,2' is no double"},
      {",2,-3,4,0,1,1\n" + rows(7), "q.csv:1", "',2' is no double"},
      {"9007199254740993,1,-3,4,0,1,1\n" + rows(7), "q.csv:1", "is no double"},
      {std::string(400, '9') + ",1,-3,4,0,1,1\n" + rows(7), "q.csv:1", "is no double"},
      {"\n" + eight, "q.csv:1", "1 columns"},
  };
  for (const Refusal& c : cases) {
    try {
      read_queries<1>(c.text, "q.csv");
      ADD_FAILURE() << "read: " << c.reason;
    } catch (const InvalidInput& error) {
      EXPECT_EQ(error.place(), c.place);
      EXPECT_NE(error.reason().find(c.reason), std::string::npos) << error.reason();
    }
  }
  KnownQuery<1> query;
  for (auto& path : query.paths) path.fill(Vec3::Zero());
  query.paths[2][1][0] = std::nan("");
  EXPECT_THROW(write_queries<1>({query}), InvalidInput);
}

TEST(QueryFile, WritesThePublicFilesByteForByte) {
  const auto files = test::query_files(test::ccd_data());
  if (files.empty()) GTEST_SKIP() << test::no_ccd_data();
  for (const auto& file : files) {
    const std::string text = test::text_of(file);
    EXPECT_EQ(write_queries<1>(read_queries<1>(text, file.string())), text) << file;
  }
}

}  // namespace
}  // namespace tendril::collision
