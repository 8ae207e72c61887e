#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/contact/surface_self_contact.h>

#include "laws.h"
#include "leaf.h"
#include "shown.h"

namespace tendril::contact {
namespace {

using test::Random;
using test::Sheets;
using test::Shown;
using test::shown_of;

/// What lists and bounds leave out is what has no part in it.
TEST(SelfLedger, IsTheSameWithALedgerAndWithout) {
  const double thick = 0.01, wide = 0.03;
  Random random(3);
  const Sheets sheets = test::crossed(2 * thick + 0.02);
  const SurfaceSelfContact contact(sheets.surface(thick), law_of(Law::Kind::barrier, wide, 0.0, 0.0));
  int touched = 0, untouched = 0;
  for (int round = 0; round < 40; ++round) {
    Shown s = shown_of(sheets.rods, random, 0.004, 0.5);
    for (std::size_t i = 9; i < 18; ++i) s.p[i].z() += round % 2 == 0 ? random.uniform(-0.01, 0.03) : 0.1;
    try {
      s.memory = contact.remember(s.view(), nullptr);
    } catch (const InvalidInput&) {
      continue;
    }
    for (int step = 0; step < 6; ++step) {
      for (Vec3& p : s.p) p += random.in_cube(0.002);
      if (round % 2 == 1)
        for (std::size_t i = 9; i < 18; ++i) s.p[i].z() -= 0.018;
      const test::Felt felt = test::same_without_memory(contact, s);
      if (felt == test::Felt::refusal) break;
      ++(felt == test::Felt::something ? touched : untouched);
      s.memory = contact.remember(s.view(), s.memory);
    }
  }
  EXPECT_GT(touched, 60);
  EXPECT_GT(untouched, 20);
  std::cout << touched << " touched, " << untouched << " not\n";
}

/// Nor over many small steps, with what a ledger has taken over from the one before: a leaf comes down on
/// another, slides over it and goes up again, as a whole or bending, and is looked at between steps too.
/// Where time goes on, it is expected to go on as it does, and does not: it turns about its axis to and fro
/// besides.
void is_the_same_after_many_steps(double time_step) {
  Random random(12);
  const double skin = 0.002, range = 0.004;  // so that lists and what is near are soon used up
  const Sheets sheets = test::crossed(0.02);
  const SurfaceSelfContact contact(sheets.surface(skin), law_of(Law::Kind::barrier, range, 0.0, 0.0));
  int touched = 0, asleep = 0;
  long searches = 0;
  for (int round = 0; round < 6; ++round) {
    Shown s = shown_of(sheets.rods, random, 0.0005, 0.2);
    for (std::size_t i = 9; i < 18; ++i) s.p[i].z() += 0.03;
    s.memory = contact.remember(s.view(), nullptr);
    const Vec3 aside(random.uniform(-0.0015, 0.0015), random.uniform(-0.0015, 0.0015), 0.0);
    for (int step = 0; step < 240; ++step) {
      const Vec3 way = aside + Vec3(0, 0, step < 88 ? -0.0005 : step < 150 ? 0.0 : 0.0005);
      for (int part = 0; part < 2; ++part) {
        for (std::size_t i = 9; i < 18; ++i)
          s.p[i] += (round % 2 == 0 ? 0.5 : 0.0625 * static_cast<double>(i - 9)) * way;
        for (Vec3& p : s.p) p += random.in_cube(2e-6);
        s.time += 0.5 * time_step;
        const double angle = time_step > 0.0 ? 0.02 * std::sin(0.02 * step * (1 + round)) : 0.0;
        for (std::size_t i = 9; i < 18; ++i) s.m[i] = rotate_about(Vec3::UnitX(), angle, Vec3::UnitZ());
        SCOPED_TRACE("round " + std::to_string(round) + " step " + std::to_string(step));
        const test::Felt felt = test::same_without_memory(contact, s);
        ASSERT_NE(felt, test::Felt::refusal);
        ++(felt == test::Felt::something ? touched : asleep);
        if (part == 1) s.memory = contact.remember(s.view(), s.memory);
        if (part == 1 && step % 16 == 0) s.memory = contact.remember(s.view(), s.memory);  // at no later time
      }
    }
    searches += dynamic_cast<const SurfaceSelfMemory&>(*s.memory).searches;
  }
  EXPECT_GT(touched, 200);
  EXPECT_GT(asleep, 200);
  EXPECT_LT(4 * searches, touched + asleep);
  std::cout << touched << " touched, " << asleep << " not, searches " << searches << "\n";
}
TEST(SelfLedger, IsTheSameAfterManyStepsFromLedgerToLedger) {
  is_the_same_after_many_steps(0.0);
}
TEST(SelfLedger, IsTheSameWhereItExpectsALeafToGoOn) {
  is_the_same_after_many_steps(0.01);
}

/// A leaf comes straight from afar, so that a list which is made where it is parted from the other has to say
/// that they meet at its end; and goes on through it and out below, which a barrier would refuse.
TEST(SelfLedger, IsTheSameWhereALeafComesStraightFromAfar) {
  Random random(5);
  const Sheets sheets = test::crossed(0.02);
  const SurfaceSelfContact contact(sheets.surface(0.002), law_of(Law::Kind::penalty, 0.004, 0.0, 0.0));
  const int steps = 240;
  int touched = 0;
  Shown s = shown_of(sheets.rods, random, 1e-6, 0.2);
  for (std::size_t i = 9; i < 18; ++i) s.p[i].z() += 0.28;
  s.memory = contact.remember(s.view(), nullptr);
  for (int step = 0; step < steps; ++step) {
    for (std::size_t i = 9; i < 18; ++i) s.p[i].z() -= 0.0025;
    s.time += 0.01;
    SCOPED_TRACE("step " + std::to_string(step));
    const test::Felt felt = test::same_without_memory(contact, s);
    ASSERT_NE(felt, test::Felt::refusal);
    if (felt == test::Felt::something) ++touched;
    s.memory = contact.remember(s.view(), s.memory);
  }
  const long searches = dynamic_cast<const SurfaceSelfMemory&>(*s.memory).searches;
  EXPECT_GE(touched, 3);
  EXPECT_LT(10 * searches, steps);
  std::cout << touched << " touched, searches " << searches << "\n";
}

}  // namespace
}  // namespace tendril::contact
