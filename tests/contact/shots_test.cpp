#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/exact/surface.h>

#include "laws.h"
#include "leaf.h"
#include "shown.h"

// Balls shot at a leaf, and leaves at balls, step after step, against exact tests of the ways that were let
// pass. TENDRIL_SHOTS is their number.
namespace tendril::contact {
namespace {

using test::Random;
using test::Shown;

constexpr double kSkin = 0.01, kRange = 0.03, kRadius = 0.02;

/// Straight ways at a speed, in steps of so many thicknesses of the leaf.
struct Shot {
  Vec3 from, step;
  int steps;
};

Shot shot_at(const Vec3& target, Random& random) {
  const Vec3 way = random.in_cube(1.0).normalized();
  const double length = 2 * kSkin * std::pow(10.0, random.uniform(0.0, 3.0));
  // Met within the first steps, wherever in them.
  const double before = 0.07 + random.uniform(0.0, 1.0) * std::min(length, 1.0);
  return {target - before * way, length * way, static_cast<int>(std::ceil((before + 0.2) / length))};
}

class Shots {
 public:
  Shots()
      : surface_(test::surface_on(rods_, test::leaf(1.0, 0.2, 16, 4), kSkin)),
        contact_(surface_, {{"ball", ball(kRadius), {}, {}, {}, 0}},
                 law_of(Law::Kind::barrier, kRange, 0.0, 0.0)) {
    std::vector<std::uint32_t> corners;
    for (const auto& t : surface_.triangles) corners.insert(corners.end(), t.begin(), t.end());
    mesh_.emplace(surface_.rest, std::move(corners));
  }

  long tunnelled = 0;  ///< though it meets the mesh, in itself or with its skin
  long needless = 0;   ///< refused, though it does not come into the range
  long refused = 0, passed = 0, left_out = 0;

  /// \param leaf  moves in place of the ball
  void shoot(const Shot& shot, bool leaf, Random& random) {
    Shown s = test::shown_of(rods_, random, 0.0, 0.0);
    s.bodies = {{shot.from, Mat3::Identity(), Vec3::Zero(), Vec3::Zero(), 1.0}};
    try {
      s.memory = contact_.remember(s.view(), nullptr);
    } catch (const InvalidInput&) {
      ++left_out;  // begins within
      return;
    }
    for (int k = 1; k <= shot.steps; ++k) {
      if (leaf)
        for (Vec3& p : s.p) p -= shot.step;
      else
        s.bodies[0].position += shot.step;
      const bool stops = refuses(s);
      if (stops) {
        ++refused;
        needless += !meets(shot, k, kRadius + kSkin + kRange);
        return;
      }
      s.memory = contact_.remember(s.view(), s.memory);
    }
    ++passed;
    tunnelled += meets(shot, shot.steps, kRadius + kSkin);
  }

 private:
  bool refuses(const Shown& s) const {
    std::vector<Vec3> force(s.p.size(), Vec3::Zero()), torque = force;
    std::vector<Wrench> wrench(1);
    std::size_t at = Loads::kNone;
    contact_.add(s.view(), {force, torque, &at, wrench});
    return at != Loads::kNone;
  }
  /// Whether a ball on the way of the first k steps meets the mesh.
  bool meets(const Shot& shot, int k, double radius) const {
    const Vec3 to = shot.from + k * shot.step;
    return mesh_->relation(exact::capsule({shot.from, to}, radius)).relation != exact::Relation::free;
  }

  std::vector<Rod> rods_ = test::stalks();
  ContactSurface surface_;
  SurfaceContact contact_;
  std::optional<exact::Surface> mesh_;
};

TEST(Shots, NoneTunnels) {
  Random random(11);
  Shots shots;
  for (int i = 0; i < TENDRIL_SHOTS; ++i) {
    const Vec3 target(random.uniform(-0.05, 1.05), random.uniform(-0.25, 0.25), 0.0);
    shots.shoot(shot_at(target, random), i % 2 == 1, random);
  }
  std::cout << shots.refused << " stopped, " << shots.passed << " went by, " << shots.left_out
            << " began within\n";
  EXPECT_EQ(shots.tunnelled, 0);
  EXPECT_EQ(shots.needless, 0);
  EXPECT_GT(shots.refused, TENDRIL_SHOTS / 3);
  EXPECT_GT(shots.passed, TENDRIL_SHOTS / 20);
}

}  // namespace
}  // namespace tendril::contact
