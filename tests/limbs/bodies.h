#pragma once

#include <tendril/curve/curve_pair.h>
#include <tendril/curve/fit.h>
#include <tendril/dynamics/rod.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "axis/shapes.h"
#include "support/random.h"

/// Bodies with limbs, what each limb's axis is, and how limbs are bent.
namespace tendril::test {

/// A chain of nodes, its orientation points, and where it is joined to one before it.
struct Limb {
  std::vector<Vec3> p, q;
  int parent = -1;
  std::size_t node = 0;  ///< of the parent
  double radius = 0.0;   ///< of the body at the joint
};

/// Where the axis of a handle is cut open.
struct Cut {
  Vec3 p;
  double radius;  ///< of the body there
};

struct Body {
  std::string name;
  bind::PolygonMesh mesh;
  std::vector<Limb> limbs;  ///< parents first
  std::vector<Cut> cuts;
};

/// On the knots of the limb at rest.
inline CurvePair pair_through(const Limb& rest, const std::vector<Vec3>& p, const std::vector<Vec3>& q) {
  const Interpolator fit(std::min<int>(3, static_cast<int>(rest.p.size()) - 1), rest.p);
  return {fit.knots(), fit.solve(p), fit.solve(q)};
}

inline std::vector<CurvePair> pairs_of(const std::vector<Limb>& limbs) {
  std::vector<CurvePair> pairs;
  for (const Limb& limb : limbs) pairs.push_back(pair_through(limb, limb.p, limb.q));
  return pairs;
}

/// One limb bent evenly along its length towards its orientation points, what hangs on it carried along.
inline std::vector<CurvePair> bent(const std::vector<Limb>& limbs, std::size_t which, double angle) {
  std::vector<CurvePair> pairs;
  std::vector<std::vector<Vec3>> posed(limbs.size());
  std::vector<std::vector<Mat3>> turn(limbs.size());
  for (std::size_t l = 0; l < limbs.size(); ++l) {
    const Limb& limb = limbs[l];
    const std::size_t n = limb.p.size();
    Mat3 from = Mat3::Identity();
    Vec3 start = limb.p[0];
    if (limb.parent >= 0) {
      const auto parent = static_cast<std::size_t>(limb.parent);
      from = turn[parent][limb.node];
      start = posed[parent][limb.node] + from * (limb.p[0] - limbs[parent].p[limb.node]);
    }
    const Vec3 tangent = limb.p[1] - limb.p[0];
    const Vec3 about = tangent.cross(limb.q[0] - limb.p[0]).normalized();
    const double all = l == which ? angle : 0.0;
    const auto turned = [&](double part) { return Mat3(from * Eigen::AngleAxisd(all * part, about)); };
    posed[l] = {start};
    for (std::size_t i = 1; i < n; ++i)
      posed[l].push_back(posed[l].back() +
                         turned(n > 2 ? double(i - 1) / double(n - 2) : 1.0) * (limb.p[i] - limb.p[i - 1]));
    std::vector<Vec3> side;
    for (std::size_t i = 0; i < n; ++i) {
      turn[l].push_back(turned(double(i) / double(n - 1)));
      side.push_back(posed[l][i] + turn[l][i] * (limb.q[i] - limb.p[i]));
    }
    pairs.push_back(pair_through(limb, posed[l], side));
  }
  return pairs;
}

/// Generated bodies: capsules about chains, blended only by their union.
class BodyMaker {
 public:
  BodyMaker(std::string name, double step) : step_(step) { body_.name = std::move(name); }

  /// \param parent  -1, or the limb on whose node nearest to the first point it sits
  int limb(const std::vector<Vec3>& corners, double radius, int parent = -1) {
    Limb limb;
    for (std::size_t k = 1; k < corners.size(); ++k) {
      const Vec3 way = corners[k] - corners[k - 1];
      const int edges = std::max(2, static_cast<int>(std::lround(way.norm() / 0.12)));
      for (int i = k == 1 ? 0 : 1; i <= edges; ++i) limb.p.push_back(corners[k - 1] + way * i / edges);
      parts_.push_back({corners[k - 1], corners[k], radius});
    }
    limb.q = orientation_towards(limb.p, Vec3(0.123, 0.232, 1.0), 0.1);
    limb.parent = parent, limb.radius = radius;
    if (parent >= 0) {
      const Limb& on = body_.limbs[static_cast<std::size_t>(parent)];
      limb.radius = std::max(radius, radius_[static_cast<std::size_t>(parent)]);
      for (std::size_t i = 0; i < on.p.size(); ++i)
        if ((on.p[i] - limb.p[0]).norm() < (on.p[limb.node] - limb.p[0]).norm()) limb.node = i;
    }
    radius_.push_back(radius);
    body_.limbs.push_back(std::move(limb));
    return static_cast<int>(body_.limbs.size()) - 1;
  }
  /// A closed ball of its own.
  void loose(const Vec3& centre, double radius) {
    add(Isosurface([&](const Vec3& p) { return (p - centre).norm() - radius; },
                   centre - Vec3::Constant(1.31 * radius), centre + Vec3::Constant(1.3 * radius),
                   0.31 * radius)
            .mesh());
  }
  Body make() {
    Vec3 low = parts_[0].a, high = low;
    for (const Part& part : parts_)
      for (const Vec3& p : {part.a, part.b})
        low = low.cwiseMin(p - Vec3::Constant(part.r)), high = high.cwiseMax(p + Vec3::Constant(part.r));
    const Field field = [this](const Vec3& p) {
      double least = 1e300;
      for (const Part& part : parts_) least = std::min(least, capsule_field(p, part.a, part.b, part.r));
      return least;
    };
    const bind::PolygonMesh loose = std::move(body_.mesh);
    body_.mesh =
        Isosurface(field, low - step_ * Vec3(1.3, 1.41, 1.23), high + Vec3::Constant(step_), step_).mesh();
    add(loose);
    return std::move(body_);
  }

 private:
  struct Part {
    Vec3 a, b;
    double r;
  };
  void add(const bind::PolygonMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(body_.mesh.points.size());
    body_.mesh.points.insert(body_.mesh.points.end(), mesh.points.begin(), mesh.points.end());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      for (const std::uint32_t i : mesh.face(f)) body_.mesh.corners.push_back(first + i);
      body_.mesh.face_begin.push_back(static_cast<std::uint32_t>(body_.mesh.corners.size()));
    }
  }

  double step_;
  Body body_;
  std::vector<Part> parts_;
  std::vector<double> radius_;
};

/// Kinds: near-mirror legs; a thick ear beside a thin arm and a thumb between fingers, whose skin is nearer
/// to the axis of what is beside it; a loose part in a socket; a shell within a shell.
inline constexpr int kBodyKinds = 5;
inline Body make_body(int kind, Random& random) {
  const auto about = [&](double value, double part) {
    return value * random.uniform(1.0 - part, 1.0 + part);
  };
  const double trunk = about(0.25, 0.2);
  switch (kind) {
    case 0: {
      BodyMaker body("mirror legs", 0.041);
      const int spine = body.limb({Vec3(-1, 0, 0), Vec3(1, 0, 0)}, trunk);
      const double spread = about(0.16, 0.2), leg = about(0.08, 0.2);
      for (const double x : {-0.8, 0.8})
        for (const double side : {-1.0, 1.0})
          body.limb({Vec3(x, 0, 0), Vec3(x, -0.1, side * spread * about(1, 0.02)),
                     Vec3(x, about(-0.9, 0.03), side * spread)},
                    leg * about(1, 0.03), spine);
      return body.make();
    }
    case 1: {
      BodyMaker body("ear beside arm", 0.041);
      const int spine = body.limb({Vec3(0, -1, 0), Vec3(0, 1, 0)}, trunk);
      const double ear = about(0.15, 0.1), arm = about(0.05, 0.1), y = 0.9 - ear - about(0.06, 0.2) - arm;
      body.limb({Vec3(0, 0.9, 0), Vec3(1.1, 0.9, 0)}, ear, spine);
      body.limb({Vec3(0, 0.3, 0), Vec3(0.45, 0.3, 0), Vec3(0.45, y, 0), Vec3(about(1.0, 0.1), y, 0)}, arm,
                spine);
      return body.make();
    }
    case 2: {
      BodyMaker body("fingers", 0.031);
      const int palm = body.limb({Vec3(-1, 0, 0), Vec3(0, 0, 0)}, trunk);
      const double thumb = about(0.13, 0.05), finger = about(0.05, 0.05);
      const double apart = thumb + about(0.05, 0.2) + finger;
      body.limb({Vec3(0, 0, 0), Vec3(about(0.9, 0.1), 0, 0)}, thumb, palm);
      for (const double side : {-apart, apart})
        body.limb({Vec3(-0.1, 0, 0), Vec3(0.1, side, 0), Vec3(about(0.9, 0.1), side, 0)}, finger, palm);
      return body.make();
    }
    case 3: {
      BodyMaker body("loose in socket", 0.041);
      const int spine = body.limb({Vec3(-1, 0, 0), Vec3(1, 0, 0)}, trunk);
      body.limb({Vec3(0.5, 0, 0), Vec3(0.5, 0.9, 0)}, 0.1, spine);
      body.loose(Vec3(-0.5, trunk, 0), about(0.07, 0.2));
      body.loose(Vec3(0.5, about(0.7, 0.1), 0.1), about(0.04, 0.2));
      return body.make();
    }
    default: {
      BodyMaker body("shell in shell", 0.041);
      const int spine = body.limb({Vec3(-1, 0, 0), Vec3(1, 0, 0)}, trunk);
      body.limb({Vec3(0.3, 0, 0), Vec3(0.3, -0.9, 0)}, 0.1, spine);
      body.loose(Vec3(about(-0.3, 0.5), 0, 0), 0.6 * trunk);
      return body.make();
    }
  }
}

}  // namespace tendril::test
