#include <tendril/curve/equal_length.h>
#include <tendril/curve/fit.h>
#include <tendril/curve/reference_frames.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "figures.h"
#include "page/sketch.h"
#include "shapes/ribbed_bar.h"
#include "spared.h"

namespace tendril::gallery {
namespace {

constexpr int kFramesEdges = 12;

std::vector<Vec3> straight() {
  std::vector<Vec3> p;
  for (int i = 0; i <= kFramesEdges; ++i) p.emplace_back(double(i) / kFramesEdges, 0, 0);
  return p;
}

/// An axis posed: an S in the plane x z, and a helix of one turn and a half.
std::vector<Vec3> posed_s() {
  std::vector<Vec3> p = straight();
  for (Vec3& one : p) one.z() = 0.16 * std::sin(2 * kPi * one.x());
  return p;
}
std::vector<Vec3> posed_helix() {
  std::vector<Vec3> p = straight();
  for (Vec3& one : p) {
    const double angle = 3 * kPi * one.x();
    one += 0.14 * Vec3(0, std::cos(angle) - 1, std::sin(angle));
  }
  return p;
}

/// Frames along a curve, by parameter.
using Frames = std::map<double, Frame>;

/// Angle about the tangent from one frame to another at the same place.
double angle_to(const Frame& from, const Frame& to) {
  return std::atan2(-to.y.dot(from.x), to.y.dot(from.y));
}

/// All frames turned by one angle so that they begin as `like`.
Frames begun_as(Frames frames, const Frame& like) {
  const double angle = angle_to(frames.begin()->second, like);
  for (auto& [t, frame] : frames) {
    frame.x = rotate_about(frame.z, angle, frame.x);
    frame.y = rotate_about(frame.z, angle, frame.y);
  }
  return frames;
}

/// What frames twist against those that do not.
struct Twist {
  double all = 0.0;      ///< forth and back [degrees]
  double net = 0.0;      ///< from one end to the other
  double largest = 0.0;  ///< between two neighbouring parameters
};
Twist twist_of(const Frames& frames, const Frames& least) {
  Twist out;
  double before = 0.0;
  for (auto at = frames.begin(), other = least.begin(); at != frames.end(); ++at, ++other) {
    const double now = angle_to(other->second, at->second);
    const double step = std::remainder(now - before, 2 * kPi) * 180 / kPi;
    out.all += std::abs(step);
    out.net += step;
    out.largest = std::max(out.largest, std::abs(step));
    before = now;
  }
  return out;
}

/// The bar on a posed axis: its points by (t, u, v), and frames of all kinds at their parameters.
class OnAxis {
 public:
  OnAxis(const std::vector<Vec3>& posed, const bind::PolygonMesh& mesh, const std::vector<Vec3>& axis)
      : fit_(3, straight()),
        curve_(fit_.knots(), fit_.solve(posed)),
        posed_(posed),
        mesh_(mesh),
        axis_(axis) {
    for (int k = 0; k <= 600; ++k) parameters_.push_back(k / 600.0);
    for (const auto* points : {&mesh.points, &axis})
      for (const Vec3& point : *points) parameters_.push_back(point.x());
    std::sort(parameters_.begin(), parameters_.end());
    parameters_.erase(std::unique(parameters_.begin(), parameters_.end()), parameters_.end());
    const NodeFrames found = rotation_minimising_frames(curve_, parameters_, Vec3::UnitZ());
    for (std::size_t k = 0; k < parameters_.size(); ++k) least_[parameters_[k]] = found.frame[k];
  }

  const Frames& least() const { return least_; }
  Frames frenet() const {
    return each([&](double t) { return frenet_frame(curve_, t).frame; });
  }
  Frames directional(const Vec3& d) const {
    return each([&](double t) { return directional_frame(curve_, t, d).frame; });
  }
  /// A curve-pair whose orientation masses stand where the frames that do not twist have them, turned by a
  /// share of `twist` [degrees].
  Frames curve_pair(double twist) const {
    std::vector<Vec3> q = posed_;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double t = fit_.parameters()[i];
      const Frame& frame = least_.lower_bound(t - 1e-9)->second;
      q[i] += 0.1 * rotate_about(frame.z, twist * kPi / 180 * t, frame.y);
    }
    const CurvePair pair(fit_.knots(), fit_.solve(posed_), fit_.solve(q));
    return each([&](double t) { return pair.frame(t).frame; });
  }

  std::vector<Vec3> map(const Frames& frames, const std::vector<Vec3>& points) const {
    std::vector<Vec3> out;
    for (const Vec3& point : points) {
      const Frame& frame = frames.at(point.x());
      out.push_back(curve_.value(point.x()) + point.y() * frame.x + point.z() * frame.y);
    }
    return out;
  }
  std::string drawn(const Frames& frames, const std::string& title, const std::string& colour) const {
    Sketch sketch(seen_from(Vec3(0.3, -1.0, 0.35)));
    sketch.faces(mesh_, map(frames, mesh_.points), colour);
    return sketch.svg(250, title);
  }
  long inside_out(const Frames& frames) const {
    return inverted(mesh_, map(frames, mesh_.points), map(frames, axis_));
  }

 private:
  template <class Choose>
  Frames each(const Choose& choose) const {
    Frames out;
    for (const double t : parameters_) out[t] = choose(t);
    return begun_as(std::move(out), least_.begin()->second);
  }

  Interpolator fit_;
  BSpline curve_;
  std::vector<Vec3> posed_;
  const bind::PolygonMesh& mesh_;
  const std::vector<Vec3>& axis_;
  std::vector<double> parameters_;
  Frames least_;
};

/// Largest and smallest stretch along an axis that was straight.
struct Stretch {
  double most = 0.0, least = HUGE_VAL;
};
Stretch stretch_of(const std::vector<Vec3>& points, double rest) {
  Stretch out;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const double one = (points[k + 1] - points[k]).norm() / rest;
    out.most = std::max(out.most, one);
    out.least = std::min(out.least, one);
  }
  return out;
}

void length_preserving(Figure& out) {
  const Interpolator fit(3, straight());
  const std::vector<Vec3> p = posed_s();
  const auto pair_of = [&](const std::vector<Vec3>& masses) {
    std::vector<Vec3> q = masses;
    for (Vec3& one : q) one.y() += 0.1;
    return CurvePair(fit.knots(), fit.solve(masses), fit.solve(q));
  };
  const CurvePair rest = pair_of(straight()), posed = pair_of(p);
  const ArcLength rest_length(rest.primary()), posed_length(posed.primary());
  constexpr int kPoints = 400;
  std::vector<Vec3> plain, even;
  for (int k = 0; k <= kPoints; ++k) {
    const AxialPoint record = to_axial(rest, double(k) / kPoints, Vec3(double(k) / kPoints, 0, 0));
    plain.push_back(from_axial(posed, record));
    even.push_back(from_axial(posed, at_equal_length(rest_length, posed_length, record)));
  }
  const Stretch by_parameter = stretch_of(plain, 1.0 / kPoints), by_length = stretch_of(even, 1.0 / kPoints);
  out.numbers.insert(out.numbers.end(),
                     {{"S: largest stretch along the axis, as bound", by_parameter.most, Bounds{1.2, 1.6}},
                      {"S: smallest stretch, as bound", by_parameter.least, Bounds{0.9, 1.1}},
                      {"S: largest stretch, length preserved", by_length.most, Bounds{0.9999, 1.0001}},
                      {"S: smallest stretch, length preserved", by_length.least, Bounds{0.9999, 1.0001}}});
  out.claims.push_back(
      {"an axial curve with an arc-length parametrisation (Peng) deforms an object homogeneously",
       "along the S, which is " + text("%.2f", posed_length.total()) +
           " times as long as the straight axis, lengths stretch " + text("%.2f", by_parameter.least) +
           " to " + text("%.2f", by_parameter.most) + " times as bound, " + text("%.5f", by_length.least) +
           " to " + text("%.5f", by_length.most) + " with the length preserved",
       by_length.most - by_length.least < 1e-3 ? Verdict::holds : Verdict::fails});
}

/// One axis with all four frames.
struct Four {
  Twist frenet, directional, pair, wanted;
  long pair_out = 0;
};

Four four_frames(const OnAxis& on, const std::string& name, Figure& out) {
  const Frames frenet = on.frenet(), directional = on.directional(Vec3::UnitZ()), pair = on.curve_pair(0),
               turned = on.curve_pair(90);
  const auto draw = [&](const Frames& frames, const std::string& title, const char* colour,
                        const Twist& twist) {
    out.pictures.push_back(
        {on.drawn(frames, name + ": " + title, colour),
         text("twist %.0f degrees", twist.all) + text(", %.0f of it in one place", twist.largest)});
  };
  const Four found{twist_of(frenet, on.least()), twist_of(directional, on.least()),
                   twist_of(pair, on.least()), twist_of(turned, on.least()), on.inside_out(turned)};
  draw(frenet, "Frenet frame", "#d55e00", found.frenet);
  draw(on.least(), "rotation-minimising frame", "#009e73", {});
  draw(directional, "directional frame", "#cc79a7", found.directional);
  draw(turned, "curve-pair, turned 90", "#56b4e9", found.wanted);
  return found;
}

}  // namespace

Figure four_frames_of_an_axis() {
  const bind::PolygonMesh mesh = ribbed_bar({.half = 0.05, .rib = 0.075, .ribs = 7, .per_side = 2});
  const std::vector<Vec3> axis = axis_points(mesh);
  Figure out{
      "2.1", "One bar, four frames (also 2.3)",
      "A straight bar follows an axis that is bent to an S in a plane, and to a helix of one turn and a "
      "half, by "
      "the Frenet frame, the rotation-minimising frame, a directional frame (towards z) and a curve-pair. "
      "Twist is "
      "measured against the rotation-minimising frame, which has none, in degrees along the whole axis."};
  const Four s = four_frames(OnAxis(posed_s(), mesh, axis), "S", out);
  const Four helix = four_frames(OnAxis(posed_helix(), mesh, axis), "helix", out);
  const FrenetFrame on_straight = frenet_frame(
      BSpline(Interpolator(3, straight()).knots(), Interpolator(3, straight()).solve(straight())), 0.4);
  out.numbers = {
      {"S: twist by the Frenet frame [degrees]", s.frenet.all, Bounds{179, 185}},
      {"S: of it in one place (1/600 of the axis)", s.frenet.largest, Bounds{85, 180.1}},
      {"S: twist by the directional frame", s.directional.all, Bounds{0, 1e-6}},
      {"S: twist by the curve-pair, none wanted", s.pair.all, Bounds{0, 1e-6}},
      {"S: twist by the curve-pair, 90 wanted", s.wanted.net, Bounds{89.9, 90.1}},
      {"helix: twist by the Frenet frame [degrees]", helix.frenet.all, Bounds{200, 500}},
      {"helix: twist by the directional frame", helix.directional.all, Bounds{20, 500}},
      {"helix: net twist by the curve-pair, none wanted", helix.pair.net, Bounds{-0.5, 0.5}},
      {"helix: twist forth and back by the curve-pair, none wanted", helix.pair.all, Bounds{0, 10}},
      {"helix: net twist by the curve-pair, 90 wanted", helix.wanted.net, Bounds{89.5, 90.5}},
      {"triangles inside out by the curve-pair", double(s.pair_out + helix.pair_out), Bounds{0, 0}},
      {"on the straight axis: the Frenet frame has a status other than ok",
       double(on_straight.status != FrameStatus::ok), Bounds{1, 1}}};
  out.claims = {
      {"with the Frenet frame unexpected twist may be obtained, and where c'' vanishes there is no frame",
       "the S twists by " + text("%.0f", s.frenet.all) +
           " degrees, all at its inflection, where the bar is wrung; the helix by " +
           text("%.0f", helix.frenet.all) + "; on a straight axis the frame is undefined, and said to be",
       s.frenet.all > 90 && helix.frenet.all > 90 ? Verdict::holds : Verdict::fails},
      {"neither the rotation-minimising nor the directional frame controls the twist fully",
       "the first has no twist, whatever is wanted; the second none on the S and " +
           text("%.0f", helix.directional.all) + " degrees on the helix",
       helix.directional.all > 10 ? Verdict::holds : Verdict::fails},
      {"the curve-pair gives complete control of the twist",
       "90 degrees wanted: " + text("%.2f", s.wanted.net) + " on the S, " + text("%.2f", helix.wanted.net) +
           " on the helix; none wanted: " + text("%.2g", s.pair.net) + " and " +
           text("%.2g", helix.pair.net) + text(", %.1f forth and back between the masses", helix.pair.all),
       std::abs(s.wanted.net - 90) < 1 && std::abs(helix.wanted.net - 90) < 1 ? Verdict::holds
                                                                              : Verdict::fails}};
  length_preserving(out);
  say_left_out(Parts::curves, out);
  return out;
}

}  // namespace tendril::gallery
