#include "rig/stance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril::runner {
namespace {

constexpr double kNearGround = 0.15, kOnGround = 0.05;  ///< of the height
constexpr double kDownward = 0.5;                       ///< sine of the least angle below the horizon
/// Of the height: a limb stands that comes down from one of these lengths back, some have long toes.
constexpr std::array kLegs{0.3, 0.4, 0.5};
constexpr double kOneFoot = 0.12;  ///< of the height: toes this near are of one foot
constexpr double kSafe = 0.02;     ///< of the height: so far within what it rests on the centre of mass is
constexpr double kStands = 4.0;    ///< feet that this counts for
constexpr int kWays = 72;          ///< level directions in which it could fall over

std::vector<CurveEnd> ends_of(const std::vector<RigCurve>& curves) {
  std::vector<CurveEnd> out;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    if (!curves[k].joint) out.push_back({k, false});
    out.push_back({k, true});
  }
  return out;
}

double lowest_of(const std::vector<Vec3>& points, const Vec3& up) {
  double low = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) low = std::min(low, p.dot(up));
  return low;
}

/// A point on the way from an end back into the body, `length` along the curves.
Vec3 back_from(const std::vector<RigCurve>& curves, const CurveEnd& end, double length) {
  if (!end.last) {
    const std::vector<Vec3>& points = curves[end.curve].points;
    std::size_t i = 0;
    for (double way = 0.0; i + 1 < points.size() && way < length; ++i)
      way += (points[i + 1] - points[i]).norm();
    return points[i];
  }
  std::size_t curve = end.curve, i = curves[curve].points.size() - 1;
  for (double way = 0.0; way < length;) {
    if (i == 0) {
      // A toe's way goes on up the leg, to where that begins.
      const auto& joint = curves[curve].joint;
      if (!joint) break;
      curve = joint->parent, i = joint->node;
      if (!curves[curve].joint) break;
      continue;
    }
    way += (curves[curve].points[i] - curves[curve].points[i - 1]).norm();
    --i;
  }
  return curves[curve].points[i];
}

const Vec3& tip_of(const std::vector<RigCurve>& curves, const CurveEnd& end) {
  return end.last ? curves[end.curve].points.back() : curves[end.curve].points.front();
}

/// What is on the ground stands if the leg above it goes down, whichever way its toes point; what is only
/// near it, a foot out of line or a tail, if its very end does.
bool stands(const std::vector<RigCurve>& curves, const CurveEnd& end, double above, const Stance& stance) {
  if (above > kNearGround * stance.height) return false;
  const auto is_above = [&](const Vec3& from) {
    return (tip_of(curves, end) - from).normalized().dot(stance.up) < -kDownward;
  };
  if (above < kOnGround * stance.height)
    return std::any_of(kLegs.begin(), kLegs.end(), [&](double length) {
      return is_above(back_from(curves, end, length * stance.height));
    });
  const RigCurve& curve = curves[end.curve];
  const std::size_t n = curve.points.size() - 1, two = std::min<std::size_t>(2, n);
  return is_above(curve.points[end.last ? n - two : two]);
}

/// Feet, those of toes once.
std::size_t count_feet(const std::vector<RigCurve>& curves, const Stance& stance) {
  std::vector<Vec3> found;
  for (const CurveEnd& end : stance.feet) {
    const Vec3& tip = tip_of(curves, end);
    const bool toe = std::any_of(found.begin(), found.end(), [&](const Vec3& other) {
      return (tip - other).norm() < kOneFoot * stance.height;
    });
    if (!toe) found.push_back(tip);
  }
  return found.size();
}

/// Of a body of one density; of the skin where it is open.
Vec3 centre_of_mass(const bind::PolygonMesh& mesh, bool closed) {
  const Vec3& origin = mesh.points[mesh.corners[0]];
  double whole = 0.0;
  Vec3 sum = Vec3::Zero();
  for (const auto& [i, j, k] : bind::fan_triangles(mesh)) {
    const Vec3 a = mesh.points[i] - origin, b = mesh.points[j] - origin, c = mesh.points[k] - origin;
    // A tetrahedron with its fourth corner at the origin, or a triangle.
    const double part = closed ? a.dot(b.cross(c)) : (b - a).cross(c - a).norm();
    whole += part;
    sum += part * (a + b + c) / (closed ? 4.0 : 3.0);
  }
  return whole != 0.0 ? Vec3(origin + sum / whole) : origin;
}

/// How far a body that rests on the points within kOnGround of the ground is from falling over, over its
/// height: its centre of mass from the edge of their convex hull, seen from above; negative outside. The hull
/// reaches h(d) = max (p - centre) d along a level direction d, and the edge is where h is least.
double safety(const bind::PolygonMesh& mesh, const Vec3& centre, const Stance& stance) {
  const Vec3 x = stance.up.unitOrthogonal(), y = stance.up.cross(x);
  std::vector<Eigen::Vector2d> rests_on;
  for (const Vec3& p : mesh.points)
    if (p.dot(stance.up) <= stance.ground + kOnGround * stance.height)
      rests_on.emplace_back((p - centre).dot(x), (p - centre).dot(y));
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kWays; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kWays;
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    double reach = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : rests_on) reach = std::max(reach, p.dot(way));
    least = std::min(least, reach);
  }
  return least / stance.height;
}

}  // namespace

Stance stand(const bind::PolygonMesh& mesh, const std::vector<RigCurve>& curves, const Body& body,
             const Vec3& up) {
  const double ground = lowest_of(mesh.points, up);
  Stance out{up, {}, {}, {0, true}, -lowest_of(mesh.points, -up) - ground, ground};
  double lowest = std::numeric_limits<double>::infinity();
  for (const CurveEnd& end : ends_of(curves)) {
    const std::vector<Vec3>& skin = (end.last ? body.last_skin : body.first_skin)[end.curve];
    const double low = skin.empty() ? tip_of(curves, end).dot(up) : lowest_of(skin, up);
    if (low < lowest) lowest = low, out.lowest = end;
    if (stands(curves, end, low - ground, out)) out.feet.push_back(end);
    if (low - ground <= kOnGround * out.height) out.on_ground.push_back(end);
  }
  return out;
}

std::string direction_name(const Vec3& up) {
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  return (up[axis] < 0.0 ? "-" : "") + std::string(1, "xyz"[axis]);
}

Stance guess_stance(const bind::PolygonMesh& mesh, const std::vector<RigCurve>& curves, const Body& body) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const std::pair<Vec3, double> choices[]{{y, 2.5}, {z, 2.0}, {x, 0.0}, {-y, 0.0}, {-z, 0.0}, {-x, 0.0}};
  const Vec3 centre = centre_of_mass(mesh, body.volume > 0.0);
  Stance best;
  double most = -1.0;
  for (const auto& [up, bonus] : choices) {
    Stance stance = stand(mesh, curves, body, up);
    double count = static_cast<double>(count_feet(curves, stance)) + bonus;
    if (safety(mesh, centre, stance) > kSafe) count += kStands;
    if (count > most) most = count, best = std::move(stance);
  }
  return best;
}

}  // namespace tendril::runner
