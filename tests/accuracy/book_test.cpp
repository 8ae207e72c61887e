#include <gtest/gtest.h>

#include <cmath>

#include "accuracy/case.h"

namespace tendril::accuracy {

void PrintTo(const Entry& entry, std::ostream* out) {
  *out << entry.name;
}

namespace {

class Book : public testing::TestWithParam<Entry> {};

TEST_P(Book, Holds) {
  const Case one = GetParam().run();
  std::printf("%s%s", table_heading().c_str(), to_table(one).c_str());
  ASSERT_FALSE(one.quantities.empty());
  for (const Quantity& quantity : one.quantities) {
    const std::vector<Verdict> verdicts = judge(quantity);
    EXPECT_FALSE(verdicts.empty()) << quantity.name << " is held to nothing";
    for (const Verdict& verdict : verdicts)
      EXPECT_TRUE(verdict.holds) << verdict.what << " at " << verdict.row.n << ": error " << verdict.row.error
                                 << ", order " << verdict.order << ", limit " << verdict.limit;
  }
}

INSTANTIATE_TEST_SUITE_P(Validation, Book, testing::ValuesIn(entries()),
                         [](const auto& one) { return std::string(one.param.name); });

Quantity second_order() {
  return {"q",
          1.0,
          "absolute",
          {{8, 1.04, 4e-2}, {16, 1.01, 1e-2, 1e-4}},
          {{16, 1e-2}},
          Order{2, 0.05, 16},
          Limit{16, 1e-3}};
}

bool holds(const Quantity& quantity) {
  bool all = true;
  for (const Verdict& verdict : judge(quantity)) all = all && verdict.holds;
  return all;
}

// A judge that accepts everything would let every case pass.
TEST(Judge, SeesWhatDoesNotHold) {
  EXPECT_EQ(judge(second_order()).size(), 3u);
  EXPECT_TRUE(holds(second_order()));
  const auto spoilt = [](void (*spoil)(Quantity&)) {
    Quantity quantity = second_order();
    spoil(quantity);
    return holds(quantity);
  };
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows[1].error = 1.01e-2; }));
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows[1].error = std::nan(""); }));
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows[0].error = 5e-2; }));
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows[1].extrapolated = -2e-3; }));
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows[1].extrapolated = std::nan(""); }));
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows[1].extrapolated.reset(); }));
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows[1].n = 17; }));
  EXPECT_FALSE(spoilt([](Quantity& q) { q.rows.pop_back(); }));
}

}  // namespace
}  // namespace tendril::accuracy
