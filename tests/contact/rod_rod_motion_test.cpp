#include <gtest/gtest.h>

#include "crossing.h"
#include "shown.h"

namespace tendril::contact {
namespace {

using test::Random;
using test::Shown;
using test::shown;

std::size_t refused(const RodRodContact& contact, const Shown& s, bool remembered, std::vector<Vec3>& force) {
  std::vector<Vec3> torque(s.p.size(), Vec3::Zero());
  std::size_t result = Loads::kNone;
  StateView view = s.view();
  if (!remembered) view.memory = nullptr;
  force.assign(s.p.size(), Vec3::Zero());
  contact.add(view, {force, torque, &result});
  return result;
}

/// What comes out on the other side within one step has passed through, though nothing is near any more.
TEST(RodRodContact, RefusesAWayThroughAnotherRod) {
  const Rod low = test::straight_rod(4, 1e7, 0.01), high = crossing(4, 1e7, 0.01, 0.2, 1.0);
  const RodRodContact contact({{0, 0.01, low.p}, {1, 0.01, high.p}}, {}, {.range = 0.005});
  Random random(1);
  std::vector<Vec3> all = low.p, force;
  all.insert(all.end(), high.p.begin(), high.p.end());
  Shown s = shown(random, all, 0.0);
  s.rods = {{0, 5}, {5, 5}};
  s.memory = contact.remember(s.view(), nullptr);
  for (std::size_t i = 5; i < 10; ++i) s.p[i].z() -= 0.4;
  EXPECT_NE(refused(contact, s, true, force), Loads::kNone);
  EXPECT_EQ(refused(contact, s, false, force), Loads::kNone);
  // Both together have passed through nothing.
  for (std::size_t i = 0; i < 10; ++i) s.p[i].z() = all[i].z() - 0.4;
  EXPECT_EQ(refused(contact, s, true, force), Loads::kNone);
}

/// Two edges that share a node close like scissors: their far points meet, as the ledger sees.
TEST(RodRodContact, FollowsEdgesThatShareANode) {
  const std::vector<Vec3> rest{Vec3(-1, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  const RodRodContact contact({{0, 0.05, rest}}, {}, {.stiffness = 10.0, .range = 0.02});
  Random random(2);
  Shown s = shown(random, rest, 0.0);
  std::vector<Vec3> with, without;
  int touched = 0;
  for (double angle = 1.6; angle > 0.5; angle -= 0.01) {
    s.p[0] = Vec3(std::cos(angle), std::sin(angle), 0);
    s.memory = contact.remember(s.view(), s.memory);
    s.p[0] = Vec3(std::cos(angle - 0.01), std::sin(angle - 0.01), 0);
    if (refused(contact, s, false, without) != Loads::kNone) break;
    EXPECT_EQ(refused(contact, s, true, with), Loads::kNone);
    EXPECT_EQ(with, without);
    touched += without[0].norm() > 0.0;
  }
  EXPECT_GT(touched, 0);
}

}  // namespace
}  // namespace tendril::contact
