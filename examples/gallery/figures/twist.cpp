#include <tendril/dynamics/forces.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "figures.h"
#include "moved.h"
#include "page/chart.h"
#include "page/sketch.h"
#include "rivals/lattice.h"
#include "shapes/ribbed_bar.h"
#include "spared.h"

namespace tendril::gallery {
namespace {

constexpr double kTwistRamp = 1.0, kTwistDuration = 3.0, kTwistDamping = 20.0, kTwistYoung = 2e5,
                 kDensity = 1000.0;
constexpr int kLayers = 4;

/// The bar, and what tells whether a map of space keeps it.
struct Object {
  RibbedBar bar;
  bind::PolygonMesh mesh = ribbed_bar(bar);
  std::vector<Vec3> axis = axis_points(mesh);
  double rest = volume(mesh, mesh.points);

  /// Both kinds of points, to be mapped together.
  std::vector<Vec3> all() const {
    std::vector<Vec3> out = mesh.points;
    out.insert(out.end(), axis.begin(), axis.end());
    return out;
  }
  double mass() const { return kDensity * rest; }
};

struct Twisted {
  std::vector<Vec3> points;
  double volume_kept = 0.0;  ///< of that at rest
  double thinnest = 1.0;     ///< section of all, its area over that at rest
  double turn = 0.0;         ///< that the sections turn by along the bar, all in all [rad]
  long inverted = 0;
  long evaluations = 0;
};

/// A ring's area, as a vector across it.
Vec3 area_of(Points ring) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < ring.size(); ++k) sum += 0.5 * ring[k].cross(ring[(k + 1) % ring.size()]);
  return sum;
}

/// Angle about x from one ring to the next, by their corners.
double turn_between(Points ring, Points next) {
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k)
    sum += std::complex(next[k].y(), next[k].z()) * std::conj(std::complex(ring[k].y(), ring[k].z()));
  return std::arg(sum);
}

void judge_sections(const Object& object, Twisted& twisted) {
  const std::size_t n = ring_size(object.bar);
  const auto ring = [&](std::span<const Vec3> points, std::size_t r) { return points.subspan(r * n, n); };
  for (std::size_t r = 0; r < ring_count(object.bar); ++r) {
    const double rest = area_of(ring(object.mesh.points, r)).norm();
    twisted.thinnest = std::min(twisted.thinnest, area_of(ring(twisted.points, r)).norm() / rest);
    if (r > 0) twisted.turn += turn_between(ring(twisted.points, r - 1), ring(twisted.points, r));
  }
}

Twisted judged(const Object& object, std::vector<Vec3> all) {
  const auto n = static_cast<std::ptrdiff_t>(object.mesh.points.size());
  const std::vector<Vec3> axis(all.begin() + n, all.end());
  all.resize(static_cast<std::size_t>(n));
  Twisted out{.points = std::move(all)};
  out.volume_kept = volume(object.mesh, out.points) / object.rest;
  out.inverted = inverted(object.mesh, out.points, axis);
  judge_sections(object, out);
  return out;
}

/// How far the far end is turned at a time, and how fast: smoothly up to `turn`, then it stays.
double turned(double turn, double time) {
  return time < kTwistRamp ? turn * 0.5 * (1 - std::cos(std::numbers::pi * time / kTwistRamp)) : turn;
}
double turning(double turn, double time) {
  return time < kTwistRamp
             ? turn * 0.5 * std::numbers::pi / kTwistRamp * std::sin(std::numbers::pi * time / kTwistRamp)
             : 0.0;
}

Lattice lattice_of(const Object& object, int cells) {
  const Vec3 half(0.0, object.bar.rib, object.bar.rib);
  return {Eigen::AlignedBox3d(Vec3(-half), Vec3(half + object.bar.length * Vec3::UnitX())), {cells, 1, 1}};
}

/// A lattice whose layers are turned by hand, each by its share.
Twisted by_hand(const Object& object, int cells, double turn) {
  const Lattice lattice = lattice_of(object, cells);
  std::vector<Vec3> p = lattice.rest();
  for (std::uint32_t i = 0; i < p.size(); ++i)
    p[i] = rotate_about(Vec3::UnitX(), turn * lattice.layer(i) / cells, p[i]);
  return judged(object, lattice.map(p, object.all()));
}

/// A lattice of springs, its first layer held, its last one turned.
SpringNet driven_net(const Object& object, const Lattice& lattice, double turn) {
  const double section = 4 * object.bar.half * object.bar.half;
  SpringNet net = lattice.net(object.mass(), kTwistYoung * section / 4);
  net.damping = kTwistDamping;
  const int last = lattice.cells()[0];
  for (std::uint32_t i = 0; i < net.rest.size(); ++i)
    if (const int layer = lattice.layer(i); layer == 0 || layer == last) net.held.push_back(i);
  net.driven = [rest = net.rest, last, turn, lattice](std::uint32_t i, double time) -> Vec3 {
    if (lattice.layer(i) != last) return Vec3::Zero();
    const Vec3 now = rotate_about(Vec3::UnitX(), turned(turn, time), rest[i]);
    return turning(turn, time) * Vec3::UnitX().cross(now);
  };
  return net;
}

struct Driven {
  Twisted result;
  std::vector<Vec3> lattice;  ///< its control points
};

Driven by_springs(const Object& object, int cells, double turn) {
  const Lattice lattice = lattice_of(object, cells);
  const SpringNet net = driven_net(object, lattice, turn);
  const Moved moved =
      move_net(net, {1e-4, object.bar.length, kTwistDuration}, std::vector{kTwistRamp, kTwistDuration});
  Driven out{judged(object, lattice.map(moved.frames.back(), object.all())), moved.frames.back()};
  out.result.evaluations = moved.evaluations;
  return out;
}

Scene rod_scene(const Object& object, double turn) {
  Scene scene;
  std::vector<Vec3> p;
  for (int i = 0; i <= kLayers; ++i) p.emplace_back(object.bar.length * i / kLayers, 0, 0);
  const double side = 2 * object.bar.half;
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1),
                                {kTwistYoung, kTwistYoung / 3, kDensity}, rectangular_section(side, side)));
  scene.rods.back().mass_damping = kTwistDamping;
  scene.anchors.push_back({.rod = 0, .node = 0});
  Anchor end{.rod = 0, .node = kLayers};
  end.motion = [turn, at = p.back()](double time) {
    const auto now = [&](const Vec3& v) { return rotate_about(Vec3::UnitX(), turned(turn, time), v); };
    const Frame rest = frame_towards(Vec3::UnitX(), Vec3::UnitZ()).frame;
    return AnchorPose{
        at, {now(rest.x), now(rest.y), rest.z}, Vec3::Zero(), turning(turn, time) * Vec3::UnitX()};
  };
  end.breaks = {kTwistRamp};
  scene.anchors.push_back(end);
  return scene;
}

/// The curve-pair, its far end turned.
Twisted by_curve_pair(const Object& object, double turn) {
  const System system(rod_scene(object, turn));
  const Simulation rest(system, system.rest_state());
  const std::vector<Vec3> all = object.all();
  const bind::Binding binding(rest.pairs()[0], all);
  const Moved moved = move_system(system, {.method = Method::cash_karp, .tolerance = 1e-4},
                                  std::vector{kTwistRamp, kTwistDuration}, &binding);
  Twisted out = judged(object, moved.frames.back());
  out.evaluations = moved.evaluations;
  return out;
}

std::string drawn(const Object& object, const Twisted& twisted, const std::string& title,
                  const std::string& colour, const Lattice* lattice = nullptr,
                  const std::vector<Vec3>* p = nullptr) {
  Sketch sketch(seen_from(Vec3(0.35, -1.0, 0.45)));
  sketch.faces(object.mesh, twisted.points, colour);
  if (lattice)
    for (const Spring& spring : lattice->net(1, 1).springs)
      sketch.edge((*p)[spring.a], (*p)[spring.b], "#555555", 0.8);
  return sketch.svg(330, title);
}

/// The same turn in all ways.
struct Row {
  double degrees;
  Twisted single, four_by_hand, pair;
  Driven four;
};

Row row_of(const Object& object, double degrees) {
  const double turn = degrees * std::numbers::pi / 180;
  return {degrees, by_hand(object, 1, turn), by_hand(object, kLayers, turn), by_curve_pair(object, turn),
          by_springs(object, kLayers, turn)};
}

/// Of n cells turned evenly by hand, in the middle: Bernstein polynomials of e^(i turn k / n).
double thinnest_by_formula(int cells, double degrees) {
  return std::pow(std::cos(0.5 * degrees * std::numbers::pi / 180 / cells), 2 * cells);
}

void add_numbers(const Row& row, Figure& out) {
  const double turn = row.degrees * std::numbers::pi / 180;
  const std::string at = text(", %.0f degrees", row.degrees);
  const auto one = [&](const char* name, const Twisted& of, Bounds volume, Bounds carried) {
    out.numbers.push_back({name + at + ": volume kept", of.volume_kept, volume});
    out.numbers.push_back({name + at + ": share of the turn found in the bar", of.turn / turn, carried});
  };
  const Bounds whole{0.999, 1.001}, none{-0.01, 0.01};
  const bool once = row.degrees > 200;
  const double kept[] = {row.degrees < 100 ? 0.66 : 0.32, row.degrees < 100 ? 0.88 : 0.59};
  const auto about = [](double value) { return Bounds{value - 0.02, value + 0.02}; };
  if (row.degrees < 100)
    one("one lattice", row.single, about(kept[0]), whole);
  else
    out.numbers.push_back(
        {"one lattice" + at + ": volume kept", row.single.volume_kept, about(once ? 1.0 : kept[0])});
  one("four cells with springs", row.four.result, about(once ? 1.0 : kept[1]),
      once ? none : Bounds{0.99, 1.001});
  one("curve-pair", row.pair, {row.degrees > 400 ? 0.95 : 0.985, 1.0}, whole);
  out.numbers.push_back(
      {"curve-pair" + at + ": thinnest section", row.pair.thinnest, Bounds{0.9999, 1.0001}});
  out.numbers.push_back(
      {"curve-pair" + at + ": triangles inside out", double(row.pair.inverted), Bounds{0, 0}});
}

std::string percent(double part) {
  return text("%.1f %%", 100 * part);
}

void add_pictures(const Object& object, const Row& row, Figure& out) {
  const std::string at = text(", %.0f degrees", row.degrees);
  const auto add = [&](std::string svg, const Twisted& twisted) {
    out.pictures.push_back({std::move(svg), "volume kept: " + percent(twisted.volume_kept)});
  };
  if (row.degrees < 200) add(drawn(object, row.single, "one lattice" + at, "#d55e00"), row.single);
  const Lattice four = lattice_of(object, kLayers);
  add(drawn(object, row.four.result, "four cells with springs" + at, "#d55e00", &four, &row.four.lattice),
      row.four.result);
  add(drawn(object, row.pair, "curve-pair" + at, "#56b4e9"), row.pair);
}

}  // namespace

Figure twist_of_a_bar() {
  const Object object;
  Figure out{
      "3.10", "A bar twisted: lattices of free-form deformation and the curve-pair (also 4.2)",
      "The thesis twists one lattice by 90 degrees and says that it collapses. Here a ribbed bar is twisted "
      "by one "
      "lattice whose end is turned, by a lattice of four cells with a mass at each control point and 18 "
      "springs a "
      "cell, whose end is driven round in a second and which then settles, and by a curve-pair of four edges "
      "driven in the same way."};
  std::vector<Row> rows;
  for (const double degrees : {90.0, 180.0, 360.0, 1080.0}) rows.push_back(row_of(object, degrees));
  for (const Row& row : rows) {
    add_numbers(row, out);
    if (row.degrees < 400) add_pictures(object, row, out);
  }
  const Row &quarter = rows[0], &half = rows[1], &full = rows[2], &thrice = rows[3];
  out.numbers.push_back(
      {"one lattice, 180 degrees: thinnest section", half.single.thinnest, Bounds{0, 1e-3}});
  for (const int cells : {1, 2, 4})
    out.numbers.push_back(
        {text("%.0f cells by hand, 90 degrees: thinnest section over the formula's", cells),
         by_hand(object, cells, std::numbers::pi / 2).thinnest / thinnest_by_formula(cells, 90),
         Bounds{0.999, 1.01}});
  out.claims = {
      {"twisted by 90 degrees, the lattice of dynamic free-form deformation collapses and the object loses "
       "its features",
       "at 90 degrees one lattice keeps " + percent(quarter.single.volume_kept) +
           " of the volume and half the section in its middle, nothing is "
           "turned inside out; at 180 the middle is a point and " +
           percent(half.single.volume_kept) + " is left. Four cells with springs keep " +
           percent(quarter.four.result.volume_kept) + " and " + percent(half.four.result.volume_kept) +
           "; driven round by 360 they flip back and carry " +
           percent(std::abs(full.four.result.turn) / (2 * std::numbers::pi)) + " of the turn",
       Verdict::partly, "features shrink at 90 degrees; it collapses at 180, and later with more cells"},
      {"the curve-pair maintains the features in a twist",
       "sections keep their area to 1e-4, no triangle turns inside out; volume kept at 90, 180, 360 "
       "degrees: " +
           percent(quarter.pair.volume_kept) + ", " + percent(half.pair.volume_kept) + ", " +
           percent(full.pair.volume_kept) + " (the rest are the facets' chords)",
       quarter.pair.inverted + half.pair.inverted + full.pair.inverted == 0 && full.pair.volume_kept > 0.985
           ? Verdict::holds
           : Verdict::fails},
      {"the twist cannot exceed 360 degrees, nor 180 in a step",
       "three turns over four edges, 270 degrees each: the bar carries " +
           percent(thrice.pair.turn / (6 * std::numbers::pi)) + " of the turn, " +
           percent(thrice.pair.volume_kept) + " of the volume, nothing inside out",
       thrice.pair.inverted == 0 && std::abs(thrice.pair.turn / (6 * std::numbers::pi) - 1) < 1e-3
           ? Verdict::fails
           : Verdict::holds,
       "the twist of an edge is unwrapped as it grows, so that the limit is gone"}};
  out.notes = {"Share of the turn found in the bar: the angles between neighbouring sections, added up."};
  say_left_out(rod_scene(object, std::numbers::pi / 2), Parts::mesh, out);
  return out;
}

}  // namespace tendril::gallery
