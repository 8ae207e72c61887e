#include <tendril/dynamics/forces.h>

#include "support/soundness.h"

// Scenes at the edge of what can be asked. Each ends right to its tolerance, by a reference that two
// tolerances certify, or is refused by name. References of motions in a plane are held to equations, and
// where that ends to an integration, that share no code with the library.
namespace tendril {
namespace {

using test::Trial;

#ifdef TENDRIL_LONG
constexpr bool kLong = true;
#else
constexpr bool kLong = false;
#endif

std::shared_ptr<const Force> gravity() {
  return std::make_shared<Gravity>(Vec3(0, 0, -9.81));
}

/// The clamped rod of radius 5 mm and length 1 m, let go under gravity.
Scene swing(int nodes, double young) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(nodes - 1, young, 5e-3));
  scene.rods[0].mass_damping = 0.5;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(gravity());
  return scene;
}

using test::PlanarRod;
using test::Vec2;

/// The same by equations of its own.
PlanarRod undamped_rod(const std::vector<Vec2>& rest, double young) {
  PlanarRod rod = test::planar_rod(rest, young, 5e-3, 1000);
  rod.gravity = {0.0, -9.81};
  return rod;
}
PlanarRod planar_swing(int nodes, double young) {
  std::vector<Vec2> rest;
  for (int i = 0; i < nodes; ++i) rest.emplace_back(static_cast<double>(i) / (nodes - 1), 0.0);
  PlanarRod rod = undamped_rod(rest, young);
  rod.damping = 0.5;
  return rod;
}
std::vector<Vec2> in_plane(const std::vector<Vec3>& p) {
  std::vector<Vec2> out;
  for (const Vec3& at : p) out.emplace_back(at.x(), at.z());
  return out;
}

/// Of its rod.
template <class Change>
Scene changed(Scene scene, const Change& change) {
  change(scene.rods[0]);
  return scene;
}
template <class Change>
PlanarRod changed(PlanarRod rod, const Change& change) {
  change(rod);
  return rod;
}

/// Springs of every second edge, and of the node before it, times a factor.
void stiffen_every_second(Rod& rod, double factor) {
  for (std::size_t i = 1; i < rod.stretch.size(); i += 2) {
    rod.stretch[i] *= factor;
    rod.twist[i] *= factor;
    rod.bend_l[i] *= factor;
    rod.bend_m[i] *= factor;
  }
}
void stiffen_every_second(PlanarRod& rod, double factor) {
  for (std::size_t i = 1; i < rod.stretch.size(); i += 2) {
    rod.stretch[i] *= factor;
    rod.bend[i] *= factor;
  }
}

template <class AnyRod>
void lighten_every_second(AnyRod& rod, double factor) {
  for (std::size_t i = 1; i < rod.mass.size(); i += 2) rod.mass[i] /= factor;
}

/// Between the nodes `node` and `node + 1` an edge that is far shorter than the others.
std::vector<Vec3> with_short_edge(double length) {
  std::vector<Vec3> p = test::straight(15, 1.0);
  p.insert(p.begin() + 8, p[7] + length * Vec3::UnitX());
  return p;
}

/// Spacings in ratio up to 1000, growing along the rod or in turn.
std::vector<Vec3> unevenly_spaced(bool in_turn) {
  std::vector<Vec3> p{Vec3::Zero()};
  const int edges = 24;
  for (int i = 0; i < edges; ++i) {
    const double share = in_turn ? (i % 2) : static_cast<double>(i) / (edges - 1);
    p.push_back(p.back() + std::pow(1000.0, share) * Vec3::UnitX());
  }
  const double length = p.back().x();
  for (Vec3& at : p) at /= length;
  return p;
}

/// Let go as swing() is, undamped.
Scene swing_of(const std::vector<Vec3>& p) {
  Scene scene = swing(4, 1e6);
  scene.rods[0] =
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e6, 3e5, 1000}, circular_section(5e-3));
  return scene;
}

/// A stem and a branch at its middle that is stiffer and heavier by these factors.
Scene with_branch(double stiffer, double heavier) {
  Scene scene = swing(9, 1e6);
  const Vec3 foot = scene.rods[0].p[4];
  std::vector<Vec3> p;
  for (int i = 0; i < 6; ++i) p.push_back(foot + Vec3(0.02, 0.08, 0.01) * i);
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1),
                                {1e6 * stiffer, 3e5 * stiffer, 1000 * heavier}, circular_section(5e-3)));
  scene.joints.push_back({.parent = 0, .node = 4, .child = 1});
  return scene;
}

/// The clamp is shaken and turned by hand.
Scene shaken(Scene scene) {
  const Frame rest = node_frames(scene.rods[0].p, scene.rods[0].q).frame[0];
  scene.anchors[0].motion = [rest](double t) {
    const double angle = 0.8 * std::sin(9 * t);
    AnchorPose pose;
    pose.position = Vec3(0, 0.1 * std::sin(12 * t), 0);
    pose.velocity = Vec3(0, 1.2 * std::cos(12 * t), 0);
    const auto turned = [&](const Vec3& v) { return rotate_about(Vec3::UnitY(), angle, v); };
    pose.frame = {turned(rest.x), turned(rest.y), turned(rest.z)};
    pose.angular_velocity = 7.2 * std::cos(9 * t) * Vec3::UnitY();
    return pose;
  };
  return scene;
}

Scene in_wind(double young) {
  Scene scene = swing(16, young);
  WindOptions wind;
  wind.mean = Vec3(0, 30, 0);
  wind.gust = 0.3;
  wind.switched = Signal::table({{0.1, 0.0}, {0.1, 1.0}, {0.2, 1.0}, {0.2, 0.0}});
  scene.forces.push_back(std::make_shared<Wind>(wind));
  return scene;
}

/// A wall that pushes back only behind it: its force has a kink, and with `jump` a jump, that it does not
/// announce.
struct Wall : Force {
  explicit Wall(double j) : jump(j) {}
  void add(const StateView& state, const Loads& loads) const override {
    for (std::size_t i = 0; i < state.p.size(); ++i)
      if (state.p[i].z() < -0.05) loads.force[i].z() += jump - 50.0 * (state.p[i].z() + 0.05);
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::within(0); }
  double jump;
};
PlanarRod planar_on_wall(double young, double jump) {
  PlanarRod rod = planar_swing(12, young);
  rod.push = [=](const Vec2& p) { return Vec2(0.0, p.y() < -0.05 ? jump - 50.0 * (p.y() + 0.05) : 0.0); };
  return rod;
}
Scene on_wall(double young, double jump) {
  Scene scene = swing(12, young);
  scene.forces.push_back(std::make_shared<Wall>(jump));
  return scene;
}

std::string with(const char* what, double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%s %.0e", what, value);
  return text;
}

void add_stiffnesses(std::vector<Trial>& to, std::initializer_list<int> all_nodes, double until) {
  for (const int nodes : all_nodes)
    for (const double young : {1e2, 1e4, 1e6, 1e8, 1e10, 1e12}) {
      Trial trial{with((std::to_string(nodes) + " nodes, E").c_str(), young),
                  [=] { return swing(nodes, young); }};
      trial.until = until;
      trial.planar = [=] { return planar_swing(nodes, young); };
      to.push_back(trial);
    }
}

void add_rods(std::vector<Trial>& to) {
  const auto rod = [&](const std::string& name, double young, const auto& change) {
    to.push_back({name, [=] { return changed(swing(16, young), change); }});
    to.back().planar = [=] { return changed(planar_swing(16, young), change); };
  };
  for (const double ratio : {1e8, 1e10})
    rod(with("edges apart in stiffness", ratio), 1e4, [=](auto& r) { stiffen_every_second(r, ratio); });
  for (const double ratio : {1e6, 1e8}) {
    rod(with("masses apart", ratio), 1e6, [=](auto& r) { lighten_every_second(r, ratio); });
    rod(with("tip heavier by", ratio), 1e10, [=](auto& r) { r.mass.back() *= ratio; });
  }
  for (const double factor : {1e3, 1e6, 1e9})
    rod(with("inextensible: E A times", factor), 1e6, [=](auto& r) {
      for (double& k : r.stretch) k *= factor;
    });
  for (const double beta : {1e-6, 1e-4, 1e-2, 1.0})
    rod(with("viscosity", beta), 1e6, [=](auto& r) { r.viscosity = beta; });
  for (const double beta : {0.0, 1e-3, 1.0}) {
    rod(with("edges and masses apart, viscosity", beta), 1e6, [=](auto& r) {
      stiffen_every_second(r, 1e10);
      lighten_every_second(r, 1e8);
      r.viscosity = beta;
    });
    to.back().reference = beta > 0.0 ? 1e-6 : 1e-5;
    // At this tolerance the most viscous one does gain energy, more than there is.
    to.back().automatic_finishes = beta < 1.0;
  }
}

std::vector<Trial> long_trials() {
  std::vector<Trial> all;
  add_stiffnesses(all, {128, 512, 4096}, 0.05);
  for (const double beta : {0.0, 1e-6, 1e-3, 1.0}) {
    const auto change = [=](auto& r) { r.viscosity = beta; };
    all.push_back(
        {with("1024 nodes, viscosity", beta), [=] { return changed(swing(1024, 1e6), change); }, 0.05});
    all.back().planar = [=] { return changed(planar_swing(1024, 1e6), change); };
  }
  return all;
}

std::vector<Trial> short_trials() {
  std::vector<Trial> all;
  add_stiffnesses(all, {32}, 0.3);
  add_rods(all);
  for (const double young : {1e6, 1e8, 1e10, 1e12}) {
    Trial frame{with("one frame of 1/24 s, E", young), [=] { return swing(32, young); }};
    frame.until = 1.0 / 24;
    frame.planar = [=] { return planar_swing(32, young); };
    all.push_back(frame);
  }
  const auto swung = [&](const char* name, const std::vector<Vec3>& p) -> Trial& {
    all.push_back({name, [=] { return swing_of(p); }});
    all.back().planar = [=] { return undamped_rod(in_plane(p), 1e6); };
    return all.back();
  };
  // Whose direction the rounding of positions leaves known to 1e-7.
  swung("edge of 1e-9 of the length", with_short_edge(1e-9)).automatic_finishes = false;
  swung("edge of 1e-5 of the length", with_short_edge(1e-5));
  swung("spacing 1 to 1000, growing", unevenly_spaced(false));
  swung("spacing 1 to 1000, in turn", unevenly_spaced(true));
  all.push_back({"branch stiffer by 1e6", [] { return with_branch(1e6, 1.0); }});
  all.push_back({"branch stiffer and heavier", [] { return with_branch(1e6, 1e3); }});
  all.push_back({"tree shaken by hand", [] { return shaken(with_branch(1e6, 1e3)); }});
  all.push_back({"stiff rod shaken by hand", [] { return shaken(swing(16, 1e10)); }});
  for (const double young : {1e5, 1e9})
    all.push_back({with("wind on and off, E", young), [=] { return in_wind(young); }});
  for (const double young : {1e5, 1e9}) {
    all.push_back({with("wall with a kink, E", young), [=] { return on_wall(young, 0.0); }});
    all.back().planar = [=] { return planar_on_wall(young, 0.0); };
    all.push_back({with("wall with a jump, E", young), [=] { return on_wall(young, 0.5); }});
    all.back().planar = [=] { return planar_on_wall(young, 0.5); };
  }
  return all;
}

class Extreme : public testing::TestWithParam<Trial> {};

TEST_P(Extreme, EndsRightOrIsRefused) {
  test::expect_right_or_refused(GetParam());
}

std::string letters(const testing::TestParamInfo<Trial>& one) {
  std::string out;
  for (const char c : one.param.name)
    if (std::isalnum(static_cast<unsigned char>(c))) out += c;
  return out;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Extreme, testing::ValuesIn(kLong ? long_trials() : short_trials()), letters);

}  // namespace
}  // namespace tendril
