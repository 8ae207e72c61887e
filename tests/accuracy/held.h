#pragma once

#include <gtest/gtest.h>

#include <cstdio>

#include "accuracy/case.h"

namespace tendril::accuracy {

inline void PrintTo(const Entry& entry, std::ostream* out) {
  *out << entry.name;
}

/// Prints a case, and fails where it does not hold what it is held to.
inline void expect_to_hold(const Case& one) {
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

}  // namespace tendril::accuracy
