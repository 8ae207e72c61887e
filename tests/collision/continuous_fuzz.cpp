#include <gtest/gtest.h>
#include <tendril/exact/continuous.h>

#include <cmath>
#include <limits>

#include "support/random.h"

// Continuous tests on values chosen to hurt: whatever comes in, one of the three answers comes out, with the
// reason and the bracket that belong to it. TENDRIL_FUZZED_QUERIES is their number.
namespace tendril {
namespace {

using collision::Features;
using collision::FirstMeeting;
using collision::Meeting;
using collision::Paths;
using collision::Reason;
using Limits = std::numeric_limits<double>;

/// Of all sizes.
double wild(test::Random& random) {
  const double values[] = {
      Limits::denorm_min(), -Limits::min(), Limits::max(), -Limits::max(), 0x1p-1000, 0x1p900, 1.0, 0.0};
  return values[random.integer(8)];
}

double nasty(test::Random& random) {
  const double values[] = {0.0, -0.0, 1.0, -1.0, 1e-12, std::nextafter(1.0, 2.0), 0.1, 0.5};
  const int choice = random.integer(12);
  if (choice < 8) return values[choice];
  return std::ldexp(random.uniform(-1, 1), random.integer(2) * (random.integer(60) - 30));
}

double poison(test::Random& random) {
  const double values[] = {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()};
  return values[random.integer(3)];
}

template <int Degree>
void expect_sound(Features features, const Paths<Degree>& paths) {
  bool finite = true;
  for (const auto& path : paths) finite = finite && all_finite(path);
  const FirstMeeting quick = collision::first_meeting<Degree>(features, paths);
  const FirstMeeting found = exact::first_meeting<Degree>(features, paths);
  ASSERT_EQ(found.meeting == Meeting::undecided, !finite);
  ASSERT_EQ(found.reason, finite ? Reason::none : Reason::not_finite);
  if (!finite) ASSERT_EQ(quick.reason, Reason::not_finite);
  if (quick.meeting == Meeting::undecided)
    ASSERT_NE(quick.reason, Reason::none);
  else
    ASSERT_EQ(quick.meeting, found.meeting);
  if (found.meeting == Meeting::hit) ASSERT_LE(found.to - found.from, 0x1p-40);
  for (const FirstMeeting& f : {quick, found}) {
    ASSERT_GE(f.from, 0.0);
    ASSERT_LE(f.from, f.to);
    ASSERT_LE(f.to, 1.0);
  }
}

template <int Degree>
void fuzz(int count) {
  test::Random random(Degree);
  for (int i = 0; i < count; ++i) {
    Paths<Degree> paths;
    for (auto& path : paths)
      for (Vec3& p : path)
        for (double& x : p) x = i % 50 == 0 ? wild(random) : nasty(random);
    if (i % 9 == 0) paths[random.integer(4)][random.integer(Degree + 1)][random.integer(3)] = poison(random);
    if (i % 5 == 0) paths[random.integer(4)] = paths[random.integer(4)];
    if (i % 7 == 0)
      for (auto& path : paths)
        for (Vec3& p : path) p[2] = 0.0;
    expect_sound<Degree>(i % 2 == 0 ? Features::vertex_face : Features::edge_edge, paths);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(ContinuousFuzz, Straight) {
  fuzz<1>(TENDRIL_FUZZED_QUERIES);
}

TEST(ContinuousFuzz, Cubic) {
  fuzz<3>(TENDRIL_FUZZED_QUERIES / 10);
}

}  // namespace
}  // namespace tendril
