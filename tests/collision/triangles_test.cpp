#include <gtest/gtest.h>
#include <tendril/exact/shape.h>

#include <cstdlib>

#include "collision/minkowski.h"
#include "collision/triangle_pairs.h"

namespace tendril::exact {
namespace {

using test::Random;
using test::TrianglePair;

/// Pairs a family: the long program defines another number.
#ifdef TENDRIL_MANY_PAIRS
constexpr int kPairs = TENDRIL_MANY_PAIRS;
#else
constexpr int kPairs = 12000;
#endif

const char* name(Relation r) {
  constexpr const char* names[] = {"free", "touching", "hit", "undecidable"};
  return names[static_cast<int>(r)];
}

struct Tally {
  int wrong = 0, touching = 0, hit = 0;
};

Tally count_wrong(const test::PairFamily& family, std::uint64_t seed) {
  Random random(seed);
  Tally tally;
  for (int i = 0; i < kPairs; ++i) {
    const TrianglePair p = family.next(random);
    const Relation truth = test::minkowski_relation(p.a, p.b);
    tally.touching += truth == Relation::touching;
    tally.hit += truth == Relation::hit;
    for (const Answer answer : {relation(p.a, p.b), relation(p.b, p.a)})
      if (answer != Answer{truth} && ++tally.wrong <= 3)
        ADD_FAILURE() << family.name << " pair " << i << ": " << name(answer.relation) << ", truly "
                      << name(truth);
  }
  return tally;
}

class Triangles : public testing::TestWithParam<test::PairFamily> {};

TEST_P(Triangles, LieToEachOtherAsTheirMinkowskiDifferenceLiesToZero) {
  const Tally tally = count_wrong(GetParam(), 1);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.touching + tally.hit, kPairs / 20);
  RecordProperty("touching", tally.touching);
  RecordProperty("hit", tally.hit);
}

INSTANTIATE_TEST_SUITE_P(Families, Triangles, testing::ValuesIn(test::pair_families()),
                         [](const auto& family) {
                           std::string word = family.param.name;
                           std::erase_if(
                               word, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
                           return word;
                         });

}  // namespace
}  // namespace tendril::exact
