#pragma once

#include <tendril/curve/closest_point.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/random.h"

/// Curves and points that are hard for nearest-point searches, and a dense reference.
namespace tendril::test {

struct NamedCurve {
  std::string name;
  BSpline curve;
};

inline BSpline uniform_curve(int degree, std::vector<Vec3> points) {
  KnotVector knots = KnotVector::uniform(degree, static_cast<int>(points.size()));
  return BSpline(std::move(knots), std::move(points));
}

/// Control points f(0) ... f(1).
template <class F>
std::vector<Vec3> along(int count, F&& f) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(f(static_cast<double>(i) / (count - 1)));
  return points;
}

inline std::vector<Vec3> random_points(int count, std::uint64_t seed) {
  Random random(seed);
  return along(count, [&](double) { return random.in_cube(5.0); });
}

/// Random steps of lengths over 3.5 decades; knots spaced like the steps.
inline BSpline uneven_curve() {
  Random random(17);
  std::vector<Vec3> points{Vec3::Zero()};
  std::vector<double> knots(4, 0.0);
  for (int i = 0; i < 18; ++i) {
    const double step = std::pow(10.0, random.uniform(-3.5, 0.0));
    points.push_back(points.back() + step * random.in_cube().normalized());
    if (i >= 3) knots.push_back(knots.back() + step);
  }
  knots.insert(knots.end(), 4, knots.back() + 0.1);
  return BSpline(KnotVector(3, knots), points);
}

/// Degree 5 with interior knots of multiplicity 1 to 5, so with corners.
inline BSpline quintic_with_corners() {
  const std::vector<double> knots{0, 0, 0, 0, 0, 0, 1, 1.5, 1.5, 2, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4};
  return BSpline(KnotVector(5, knots), random_points(18, 23));
}

inline std::vector<NamedCurve> projection_curves() {
  const double pi = std::numbers::pi;
  const auto trochoid = [&](double s) {
    const double a = 10.0 * pi * s;
    return Vec3(10.0 * s + 1.2 * std::sin(a), 1.2 * std::cos(a), 0.02 * std::sin(3.0 * s));
  };
  std::vector<Vec3> rests = random_points(6, 5);
  for (int i = 4; i > 0; i -= 2) rests.insert(rests.begin() + i, 2, rests[static_cast<std::size_t>(i)]);
  std::vector<Vec3> hairpin;
  for (int i = 0; i < 12; ++i) hairpin.emplace_back(i % 2 * 8.0, 0.01 * i, i % 3 * 0.005);
  const auto circle = [&](double s) { return Vec3(std::cos(3 * pi * s), std::sin(3 * pi * s), 0.0); };
  const auto gentle = [](double s) { return Vec3(10 * s, 0.5 * std::sin(6 * s), 0.3 * std::cos(5 * s)); };
  const auto back = [](double s) { return Vec3(s < 0.5 ? 8.0 * s : 8.0 - 8.0 * s, 0.0, 0.0); };
  return {{"gentle, 8 spans", uniform_curve(3, along(11, gentle))},
          {"trochoid, 32 spans", uniform_curve(3, along(35, trochoid))},
          {"hairpins", uniform_curve(3, hairpin)},
          {"zero speed", uniform_curve(3, rests)},
          {"random tangle", uniform_curve(3, random_points(14, 3))},
          {"uneven over 3.5 decades", uneven_curve()},
          {"circle, 1.5 turns", uniform_curve(3, along(25, circle))},
          {"there and back", uniform_curve(3, along(9, back))},
          {"polyline", uniform_curve(1, random_points(12, 4))},
          {"degree 2", uniform_curve(2, random_points(10, 6))},
          {"degree 4", uniform_curve(4, along(20, trochoid))},
          {"degree 5 with corners", quintic_with_corners()}};
}

/// To the last bit.
inline bool same(const Projection& a, const Projection& b) {
  return a.t == b.t && a.point == b.point && a.distance == b.distance && a.kind == b.kind &&
         a.lambda == b.lambda && a.gap == b.gap;
}

/// Diagonal of the control points' bounding box.
inline double diagonal(const BSpline& curve) {
  Vec3 low = curve.control_points().front(), high = low;
  for (const Vec3& u : curve.control_points()) {
    low = low.cwiseMin(u);
    high = high.cwiseMax(u);
  }
  return (high - low).norm();
}

/// Points near everything that decides a projection: see the cases of next().
class HardPoints {
 public:
  HardPoints(const BSpline& curve, const CurveProjector& projector, std::uint64_t seed)
      : curve_(curve), projector_(projector), random_(seed), size_(diagonal(curve)) {}

  Vec3 next() {
    switch (count_++ % 9) {
      case 0:
        return anywhere();
      case 1:
        return near_centre_of_curvature();
      case 2:
        return equidistant();
      case 3:
        return beyond_end();
      case 4:
        return curve_.value(parameter());
      case 5:
        return curve_.value(knot());
      case 6:
        return beside(knot(), std::pow(10.0, random_.uniform(-9.0, 0.0)));
      case 7:
        return std::pow(10.0, random_.uniform(2.0, 5.0)) * size_ * random_.in_cube();
      default:
        return beside(parameter(), std::pow(10.0, random_.uniform(-14.0, 0.0)));
    }
  }

 private:
  double parameter() { return random_.uniform(curve_.knots().start(), curve_.knots().end()); }
  double knot() {
    const auto knots = curve_.knots().knots();
    return knots[static_cast<std::size_t>(random_.integer(static_cast<int>(knots.size())))];
  }
  Vec3 anywhere() {
    const int count = static_cast<int>(curve_.control_points().size());
    return curve_.control_points()[static_cast<std::size_t>(random_.integer(count))] +
           random_.in_cube(0.3 * size_);
  }
  Vec3 near_centre_of_curvature() {
    const double t = parameter();
    const Vec3 d1 = curve_.derivative(t), d2 = curve_.derivative(t, 2);
    const Vec3 bend = d2 - d1 * (d1.dot(d2) / d1.squaredNorm());
    const double off[] = {1.0, 1.0 + 1e-8, 1.0 - 1e-8, 1.0 + 1e-3};
    const Vec3 centre =
        curve_.value(t) + off[random_.integer(4)] * d1.squaredNorm() / bend.squaredNorm() * bend;
    return centre.allFinite() && centre.norm() < 1e6 * size_ ? centre : anywhere();
  }
  /// Bisects between two points with different feet until the two distances agree to the last bits.
  Vec3 equidistant() {
    Vec3 a = anywhere(), b = anywhere();
    const double ta = projector_.nearest(a).t;
    const double apart = std::abs(projector_.nearest(b).t - ta) / 2.0;
    for (int i = 0; i < 56; ++i) {
      const Vec3 middle = 0.5 * (a + b);
      (std::abs(projector_.nearest(middle).t - ta) < apart ? a : b) = middle;
    }
    return a;
  }
  Vec3 beyond_end() {
    const bool start = random_.integer(2) == 0;
    const auto u = curve_.control_points();
    const Vec3 outward = start ? Vec3(u[0] - u[1]) : Vec3(u[u.size() - 1] - u[u.size() - 2]);
    const double length = std::pow(10.0, random_.uniform(-6.0, 1.0)) * size_;
    const Vec3 direction = outward.norm() > 0.0 ? Vec3(outward.normalized()) : Vec3(Vec3::UnitZ());
    return (start ? u.front() : u.back()) +
           length * (direction + random_.uniform(0.0, 2.0) * random_.in_cube());
  }
  Vec3 beside(double t, double share) {
    const Vec3 side = curve_.derivative(t).cross(random_.in_cube());
    return curve_.value(t) + (side.norm() > 0.0 ? share * size_ / side.norm() : 0.0) * side;
  }

  const BSpline& curve_;
  const CurveProjector& projector_;
  Random random_;
  double size_;
  int count_ = 0;
};

/// Samples every span densely and polishes the sampled local minima by golden section on the distance: shares
/// no idea with the search. It can miss a minimum, so it bounds the true distance from above only.
class DenseReference {
 public:
  DenseReference(const BSpline& curve, int per_span) : curve_(curve) {
    const auto knots = curve.knots().knots();
    for (const int span : curve.knots().nonempty_spans()) {
      const double a = knots[static_cast<std::size_t>(span)], b = knots[static_cast<std::size_t>(span) + 1];
      for (int i = 0; i < per_span; ++i) add(a + (b - a) * i / per_span);
    }
    add(curve.knots().end());
    for (std::size_t i = 1; i < points_.size(); ++i)
      step_ = std::max(step_, (points_[i] - points_[i - 1]).norm());
  }

  double distance(const Vec3& p) {
    double best2 = (points_[0] - p).squaredNorm();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      squares_[i] = (points_[i] - p).squaredNorm();
      best2 = std::min(best2, squares_[i]);
    }
    double best = std::sqrt(best2);
    const double promising = (best + 2.0 * step_) * (best + 2.0 * step_);
    const std::size_t last = points_.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      if (squares_[i] > promising) continue;
      const std::size_t low = i == 0 ? i : i - 1, high = i == last ? i : i + 1;
      if (squares_[i] <= squares_[low] && squares_[i] <= squares_[high])
        best = std::min(best, golden(p, parameters_[low], parameters_[high]));
    }
    return best;
  }

 private:
  void add(double t) {
    parameters_.push_back(t);
    points_.push_back(curve_.value(t));
    squares_.push_back(0.0);
  }
  double golden(const Vec3& p, double a, double b) const {
    const double share = 0.5 * (std::sqrt(5.0) - 1.0);
    const auto at = [&](double t) { return (curve_.value(t) - p).norm(); };
    double c = b - share * (b - a), d = a + share * (b - a);
    double fc = at(c), fd = at(d), best = std::min(fc, fd);
    for (int i = 0; i < 80 && c < d; ++i) {
      if (fc < fd) {
        b = d;
        d = c;
        fd = fc;
        c = b - share * (b - a);
        best = std::min(best, fc = at(c));
      } else {
        a = c;
        c = d;
        fc = fd;
        d = a + share * (b - a);
        best = std::min(best, fd = at(d));
      }
    }
    return best;
  }

  const BSpline& curve_;
  std::vector<double> parameters_, squares_;
  std::vector<Vec3> points_;
  double step_ = 0.0;
};

}  // namespace tendril::test
