#include <gtest/gtest.h>

#include <cmath>

#include "page/figure.h"

namespace tendril::gallery {

void PrintTo(const Entry& entry, std::ostream* out) {
  *out << entry.name;
}

namespace {

class Gallery : public testing::TestWithParam<Entry> {};

TEST_P(Gallery, HoldsItsNumbers) {
  const Figure figure = GetParam().run();
  EXPECT_EQ(figure.id, GetParam().id);
  EXPECT_FALSE(figure.claims.empty());
  EXPECT_FALSE(figure.pictures.empty());
  EXPECT_NE(figure.left_out, "");
  int held = 0;
  for (const Number& number : figure.numbers) {
    held += number.within.has_value();
    EXPECT_TRUE(number.holds()) << number.name << " is " << number.value;
  }
  EXPECT_GT(held, 2) << "held to next to nothing";
}

INSTANTIATE_TEST_SUITE_P(Thesis, Gallery, testing::ValuesIn(entries()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Page, SaysWhatDoesNotHold) {
  const Number outside{"a", 2.0, Bounds{0, 1}}, none{"b", std::nan(""), Bounds{0, 1}}, free{"c", 2.0};
  EXPECT_FALSE(outside.holds());
  EXPECT_FALSE(none.holds());
  EXPECT_TRUE(free.holds());
  Figure figure{"9.9", "a <b>", "what"};
  figure.numbers = {outside};
  figure.claims = {{"claimed & said", "measured", Verdict::fails, "because"}};
  const std::string page = to_html({figure});
  EXPECT_NE(page.find("class=\"out\""), std::string::npos);
  EXPECT_NE(page.find("claimed &amp; said"), std::string::npos);
  EXPECT_NE(page.find("a &lt;b&gt;"), std::string::npos);
  EXPECT_NE(to_json({figure}).find("\"holds\": false"), std::string::npos);
}

}  // namespace
}  // namespace tendril::gallery
