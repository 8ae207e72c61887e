#include "rig/rig.h"

#include "draw/camera.h"

#include <tendril/base/error.h>
#include <tendril/base/number.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tendril::runner {
namespace {

constexpr double kSole = 0.08;                        // of the height: so near to the ground a foot is held
constexpr double kCarried = 3.0, kMostSag = 0.15;     // see RigOptions::size
constexpr double kMostWind = 8.0, kMostSway = 0.02;   // [m/s]; see RigOptions::wind
constexpr double kLeastOfRubber = 0.15;               // [m], see RigOptions::material
constexpr double kSmallest = 1e-60, kLargest = 1e60;  // fourth powers of lengths are numbers
constexpr double kLeastSlender = 3.0;  // length of the first curve over the width of its sections

double extent(const bind::PolygonMesh& mesh) {
  Vec3 low = mesh.points.front(), high = low;
  for (const Vec3& p : mesh.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff();
}

/// An end's last edge, which clamps it; and of a foot all that is as near to the ground, its toes and what is
/// above them.
Held end_nodes(const std::vector<RigCurve>& curves, const CurveEnd& end, const Stance& stance) {
  const RigCurve& curve = curves[end.curve];
  const std::size_t n = curve.points.size() - 1;
  const auto is_low = [&](std::size_t i) {
    return curve.points[i].dot(stance.up) < stance.ground + kSole * stance.height;
  };
  std::size_t count = std::min<std::size_t>(1, n);  // edges
  while (2 * (count + 1) <= n && is_low(end.last ? n - count - 1 : count + 1)) ++count;
  // A child's first node is its parent's.
  const std::size_t first = curve.joint ? 1 : 0;
  if (!end.last) return {end.curve, 0, count};
  return {end.curve, std::max(first, n - count), n};
}

/// The edge at half the first curve's length: limbs sway to both sides of it.
Held middle(const RigCurve& curve) {
  double length = 0.0, along = 0.0;
  for (std::size_t i = 1; i < curve.points.size(); ++i)
    length += (curve.points[i] - curve.points[i - 1]).norm();
  std::size_t last = 1;
  for (; last + 1 < curve.points.size(); ++last) {
    along += (curve.points[last] - curve.points[last - 1]).norm();
    if (2.0 * along >= length) break;
  }
  return {0, last - 1, last};
}

/// The lower end of the first curve.
CurveEnd root(const std::vector<RigCurve>& curves, const Vec3& up) {
  return {0, curves[0].points.back().dot(up) < curves[0].points.front().dot(up)};
}

/// What it stands on: legs, or else ends that lie on the ground, as those of what sits or has wheels.
const std::vector<CurveEnd>& feet_of(const Stance& stance) {
  return stance.feet.empty() ? stance.on_ground : stance.feet;
}

std::vector<CurveEnd> ends_to_hold(const Rig& rig, const std::string& hold) {
  if (hold == "feet") {
    const std::vector<CurveEnd>& feet = feet_of(rig.stance);
    if (feet.empty())
      throw InvalidInput("--hold", "nothing of the mesh stands on the ground",
                         "middle, root, lowest, a curve's name, or another --up");
    return feet;
  }
  if (hold == "root") return {root(rig.curves, rig.stance.up)};
  if (hold == "lowest") return {rig.stance.lowest};
  std::string names;
  for (std::size_t k = 0; k < rig.curves.size(); ++k) {
    if (rig.curves[k].name == hold) return {{k, true}};
    names += ", " + rig.curves[k].name;
  }
  throw InvalidInput("--hold", "'" + hold + "'",
                     "feet, middle, root, lowest, or a curve's name: " + names.substr(2));
}

void require_slender(const Rig& rig) {
  const double ratio = slenderness(rig.curves, rig.body);
  if (ratio >= kLeastSlender) return;
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", ratio);
  throw InvalidInput(
      "mesh", std::string("its longest axis is only ") + text + " times as long as it is thick there",
      "something long, three times and more, or with limbs; --axis takes an axis drawn by hand");
}

LoadEstimate load_at(const Rig& rig, double unit) {
  return estimate_load(rig.curves, rig.body, rig.stance, rig.held, rig.material, unit);
}

double two_digits_below(double x) {
  const double digit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return digit * std::floor(x / digit * (1.0 + 1e-9));
}

/// The largest size of two digits, up to a metre, at which it stands.
double standing_size(const Rig& rig, double extent) {
  const LoadEstimate metre = load_at(rig, 1.0 / extent);
  return std::max(1e-3, two_digits_below(std::min({1.0, metre.carries / kCarried, kMostSag / metre.sag})));
}

/// Level, and across the first curve.
Vec3 wind_direction(const std::vector<RigCurve>& curves, const Vec3& up) {
  Vec3 along = curves[0].points.back() - curves[0].points.front();
  along -= along.dot(up) * up;
  const Vec3 least = up.cwiseAbs().x() < 0.5 ? Vec3::UnitX() : Vec3::UnitZ();
  const double length = along.norm(), whole = (curves[0].points.back() - curves[0].points.front()).norm();
  return length > 0.1 * whole ? Vec3(up.cross(along) / length) : least;
}

void hold(const RigOptions& options, Rig& rig) {
  rig.held_as = !options.hold.empty() ? options.hold : feet_of(rig.stance).empty() ? "middle" : "feet";
  if (rig.held_as == "middle") {
    rig.held.push_back(middle(rig.curves[0]));
    return;
  }
  for (const CurveEnd& end : ends_to_hold(rig, rig.held_as))
    rig.held.push_back(end_nodes(rig.curves, end, rig.stance));
}

/// And the material, which goes with it.
void choose_size(const RigOptions& options, double extent, Rig& rig) {
  rig.material = find_material(options.material.empty() ? "rubber" : options.material);
  rig.size_given = options.size.has_value();
  rig.size = options.size.value_or(standing_size(rig, extent));
  if (options.material.empty() && !rig.size_given && rig.size < kLeastOfRubber) {
    rig.material = find_material("foam");
    rig.size = standing_size(rig, extent);
  }
  rig.unit = rig.size / extent;
  rig.load = load_at(rig, rig.unit);
}

void weigh(Rig& rig) {
  const double rods = volume_of_rods(rig.curves, rig.body);
  const double volume = rig.body.volume > 0.0 ? rig.body.volume : rods;
  const double density = rig.material.density * std::pow(rig.unit, 3);
  rig.overlap = rods / volume;
  rig.mass = density * volume;
  rig.density = density / rig.overlap;
}

void choose_wind(const RigOptions& options, Rig& rig) {
  const double push = std::sqrt(kMostSway / rig.load.sway);
  rig.wind_speed = options.wind.value_or(two_digits_below(std::min(kMostWind, push)));
  rig.wind = rig.wind_speed / rig.unit * wind_direction(rig.curves, rig.stance.up);
}

}  // namespace

void check(const RigOptions& options) {
  if (!options.material.empty()) find_material(options.material);
  if (!options.up.empty()) up_direction(options.up);
  if (options.size && (!(*options.size >= 1e-3) || !(*options.size <= 1e4)))
    throw InvalidInput("--size", std::to_string(*options.size), "metres from 0.001 to 10000");
  if (options.wind && (!(*options.wind >= 0.0) || !(*options.wind <= 100.0)))
    throw InvalidInput("--wind", std::to_string(*options.wind), "metres a second from 0 to 100");
}

Rig make_rig(const bind::PolygonMesh& mesh, std::vector<RigCurve> curves, const RigOptions& options) {
  check(options);
  if (mesh.face_count() == 0) throw InvalidInput("mesh", "no faces", "a surface");
  const double large = extent(mesh);
  if (!(large > kSmallest) || !(large < kLargest))
    throw InvalidInput("mesh", "it is " + shortest(large) + " large", "a largest extent from 1e-60 to 1e60");
  Rig rig;
  rig.curves = std::move(curves);
  rig.body = measure_body(mesh, rig.curves, options.threads);
  require_slender(rig);
  rig.up_guessed = options.up.empty();
  rig.stance = rig.up_guessed ? guess_stance(mesh, rig.curves, rig.body)
                              : stand(mesh, rig.curves, rig.body, up_direction(options.up));
  hold(options, rig);
  choose_size(options, large, rig);
  weigh(rig);
  choose_wind(options, rig);
  return rig;
}

}  // namespace tendril::runner
