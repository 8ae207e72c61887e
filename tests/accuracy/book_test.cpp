#include <cmath>

#include "accuracy/held.h"

namespace tendril::accuracy {
namespace {

class Book : public testing::TestWithParam<Entry> {};

TEST_P(Book, Holds) {
  expect_to_hold(GetParam().run());
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
