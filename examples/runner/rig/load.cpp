#include "rig/load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril::runner {
namespace {

using std::numbers::pi;

constexpr double kDrag = 1.2;       // of a rod across the wind
constexpr double kToe = 0.2;        // of the body's height: what is shorter is no leg
constexpr double kLegHeight = 0.4;  // of the body's height: what of a curve is leg

/// A stretch of a curve as a beam.
struct Beam {
  double length = 0.0, volume = 0.0;
  double inertia = 0.0;  ///< integral of the least second moment along it [unit^5]
  double give = 0.0;     ///< integral of one over that

  void add(const RigCurve& curve, const std::vector<RigSection>& sections, std::size_t edge) {
    const double a = 0.5 * (sections[edge].a + sections[edge + 1].a);
    const double b = 0.5 * (sections[edge].b + sections[edge + 1].b);
    const double along = (curve.points[edge + 1] - curve.points[edge]).norm();
    const double least = pi / 4.0 * a * b * std::min(a, b) * std::min(a, b);
    length += along, volume += pi * a * b * along;
    inertia += least * along, give += along / least;
  }
};

Beam beam_of(const RigCurve& curve, const std::vector<RigSection>& sections) {
  Beam out;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) out.add(curve, sections, i);
  return out;
}

/// From a foot up, as far as a leg goes.
/// \param height  above the foot
Beam leg_of(const RigCurve& curve, const std::vector<RigSection>& sections, const CurveEnd& foot,
            const Stance& stance, double height) {
  Beam out;
  const std::size_t n = curve.points.size() - 1;
  const double ground = curve.points[foot.last ? n : 0].dot(stance.up);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t edge = foot.last ? n - 1 - k : k, top = foot.last ? edge : edge + 1;
    out.add(curve, sections, edge);
    if (curve.points[top].dot(stance.up) - ground > height) break;
  }
  return out;
}

/// The part of a curve that swings: a limb that nothing holds as it is; of the first curve, which goes on to
/// both sides of the body, a half.
double free_part(const std::vector<Held>& held, std::size_t curve, std::size_t curves) {
  if (curve == 0) return curves == 1 ? 1.0 : 0.5;
  const bool fixed = std::any_of(held.begin(), held.end(), [&](const Held& h) { return h.curve == curve; });
  return fixed ? 0.0 : 1.0;
}

/// How far the centre of mass of all rods is above the ground.
double height_of_mass(const std::vector<RigCurve>& curves, const Body& body, const Stance& stance) {
  double mass = 0.0, moment = 0.0;
  for (std::size_t k = 0; k < curves.size(); ++k)
    for (std::size_t i = 0; i + 1 < curves[k].points.size(); ++i) {
      Beam edge;
      edge.add(curves[k], body.sections[k], i);
      mass += edge.volume;
      moment += edge.volume *
                (0.5 * (curves[k].points[i] + curves[k].points[i + 1]).dot(stance.up) - stance.ground);
    }
  return moment / mass;
}

/// What it stands on. Several legs hold what is on them upright, and sway with it; one alone carries it at
/// its top, which tilts.
struct Legs {
  std::vector<Beam> beams;
  bool tilts() const { return beams.size() == 1; }
};

Legs legs_of(const std::vector<RigCurve>& curves, const Body& body, const Stance& stance) {
  Legs out;
  std::vector<CurveEnd> feet;
  // Toes share what the leg above them carries.
  for (const CurveEnd& foot : stance.feet)
    if (beam_of(curves[foot.curve], body.sections[foot.curve]).length >= kToe * stance.height)
      feet.push_back(foot);
  const double height = feet.size() == 1 ? height_of_mass(curves, body, stance) : kLegHeight * stance.height;
  for (const CurveEnd& foot : feet)
    out.beams.push_back(leg_of(curves[foot.curve], body.sections[foot.curve], foot, stance, height));
  return out;
}

/// Euler's load of a leg over its share of the weight: pi^2 E I / L^2 where it is clamped at both ends and
/// free to sway, a quarter of that where its top tilts; by the mean of 1 / I, as the thinnest part gives
/// way.
double least_carried(const Legs& legs, double young, double weight) {
  double least = std::numeric_limits<double>::infinity();
  const double share = (legs.tilts() ? 0.25 : 1.0) * static_cast<double>(legs.beams.size());
  for (const Beam& leg : legs.beams)
    least = std::min(least, pi * pi * young / (leg.give * leg.length) * share / weight);
  return least;
}

/// Against a force aside on them: each leg is as stiff as 12 E I / L^3, one that tilts as 3 E I / L^3.
double stiffness_aside(const Legs& legs, double young) {
  double sum = 0.0;
  for (const Beam& leg : legs.beams)
    sum += (legs.tilts() ? 3.0 : 12.0) * young / (leg.give * leg.length * leg.length);
  return sum;
}

/// Of all rods, seen from the side: the mean projected width of an ellipse is the sum of its semi-axes.
double area_in_wind(const std::vector<RigCurve>& curves, const Body& body) {
  double sum = 0.0;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const std::vector<RigSection>& s = body.sections[k];
    for (std::size_t i = 0; i + 1 < s.size(); ++i)
      sum += 0.5 * (s[i].a + s[i].b + s[i + 1].a + s[i + 1].b) *
             (curves[k].points[i + 1] - curves[k].points[i]).norm();
  }
  return sum;
}

}  // namespace

// A cantilever of mass m: first frequency 3.516 sqrt(E I / (m L^3)), end deflection m g L^3 / (8 E I).
LoadEstimate estimate_load(const std::vector<RigCurve>& curves, const Body& body, const Stance& stance,
                           const std::vector<Held>& held, const NamedMaterial& material, double unit) {
  const double young = material.young * unit, g = kGravity / unit,
               density = material.density * std::pow(unit, 3);
  LoadEstimate out;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const double part = free_part(held, k, curves.size());
    if (part == 0.0) continue;
    const Beam limb = beam_of(curves[k], body.sections[k]);
    const double mass = density * limb.volume * part, length = limb.length * part;
    const double compliance = mass * std::pow(length, 3) * limb.length / (young * limb.inertia);
    const double period = 2.0 * pi / 3.516 * std::sqrt(compliance);
    if (period > out.period) out.period = period, out.slowest = curves[k].name;
    // Only what lies across gravity bends.
    const Vec3 chord = (curves[k].points.back() - curves[k].points.front()).normalized();
    out.sag = std::max(out.sag, chord.cross(stance.up).norm() * compliance * g / (8.0 * length));
  }
  const double volume = body.volume > 0.0 ? body.volume : volume_of_rods(curves, body);
  const Legs legs = legs_of(curves, body, stance);
  const double aside = stiffness_aside(legs, young), weight = density * volume * g;
  out.carries = least_carried(legs, young, weight);
  // All of it on its legs; a weight that they only just carry swings ever more slowly.
  if (legs.tilts() && out.carries > 1.0) {
    const double period = 2.0 * pi * std::sqrt(density * volume / (aside * (1.0 - 1.0 / out.carries)));
    if (period > out.period) out.period = period, out.slowest = "all on its leg";
  }
  // Drag 1/2 rho C A v^2 at 1 m/s, in newtons; over the unit it is in kg unit / s^2.
  const double drag = 0.5 * kAirDensity * kDrag * area_in_wind(curves, body) * unit * unit;
  out.sway = aside > 0.0 ? drag / unit / aside / stance.height : 0.0;
  return out;
}

double volume_of_rods(const std::vector<RigCurve>& curves, const Body& body) {
  double sum = 0.0;
  for (std::size_t k = 0; k < curves.size(); ++k) sum += beam_of(curves[k], body.sections[k]).volume;
  return sum;
}

double slenderness(const std::vector<RigCurve>& curves, const Body& body) {
  const Beam first = beam_of(curves[0], body.sections[0]);
  return first.length / (2.0 * std::sqrt(first.volume / (pi * first.length)));
}

}  // namespace tendril::runner
