#pragma once

#include "curve/projection_cases.h"

/// Sixty-two curves of degrees 1 to 5 with everything that makes projections ambiguous.
namespace tendril::test {

/// Clamped knots of random spacing over three decades, some repeated up to the degree.
inline KnotVector uneven_knots(int degree, int count, Random& random) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  double t = 0.0;
  while (static_cast<int>(knots.size()) < count) {
    t += std::pow(10.0, random.uniform(-3.0, 0.0));
    const int times = random.integer(4) == 0 ? 1 + random.integer(degree) : 1;
    for (int i = 0; i < times && static_cast<int>(knots.size()) < count; ++i) knots.push_back(t);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, t + 0.5);
  return KnotVector(degree, knots);
}

/// Whole numbers, the same again mirrored at y = 0: exact ties for points with y = 0.
inline std::vector<Vec3> mirrored(int half, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < half; ++i) {
    const double x = random.integer(9) - 4;
    const double y = 1 + random.integer(4);
    points.emplace_back(x, y, random.integer(5) - 2);
  }
  for (int i = half - 1; i >= 0; --i)
    points.push_back(points[static_cast<std::size_t>(i)].cwiseProduct(Vec3(1, -1, 1)));
  return points;
}

inline void add_family(int degree, std::vector<NamedCurve>& out) {
  const auto seed = static_cast<std::uint64_t>(100 + degree);
  const std::string name = "degree " + std::to_string(degree) + ", ";
  Random random(seed);
  const auto add = [&](const char* what, std::vector<Vec3> points) {
    out.push_back({name + what, uniform_curve(degree, std::move(points))});
  };
  add("tangle", random_points(degree + 8, seed));
  out.push_back({name + "uneven knots",
                 BSpline(uneven_knots(degree, degree + 12, random), random_points(degree + 12, seed + 1))});
  std::vector<Vec3> rests = random_points(6, seed + 2);
  for (int i = 4; i > 0; i -= 2)
    rests.insert(rests.begin() + i, static_cast<std::size_t>(degree) - (degree > 1 ? 1 : 0),
                 rests[static_cast<std::size_t>(i)]);
  add("rests", rests);
  add("hairpins", along(degree + 9, [i = 0](double s) mutable { return Vec3(i++ % 2 * 8.0, s, 0.1 * s); }));
  add("there and back", along(2 * degree + 5, [](double s) { return Vec3(8 * std::abs(s - 0.5), 0, 0); }));
  add("mirrored", mirrored(degree + 3, seed + 3));
  add("circle", along(4 * degree + 8, [](double s) {
        return Vec3(std::cos(2 * std::numbers::pi * s), std::sin(2 * std::numbers::pi * s), 0.0);
      }));
  add("flat tangle", [&] {
    std::vector<Vec3> points = random_points(degree + 7, seed + 4);
    for (Vec3& u : points) u.z() = 0.0;
    return points;
  }());
  add("far from the origin", [&] {
    std::vector<Vec3> points = random_points(degree + 7, seed + 5);
    for (Vec3& u : points) u += Vec3(3e5, -1e5, 2e5);
    return points;
  }());
  add("one bend", along(degree + 1, [](double s) { return Vec3(s, s * s, 0); }));
}

inline std::vector<NamedCurve> minima_curves() {
  std::vector<NamedCurve> curves = projection_curves();
  for (int degree = 1; degree <= 5; ++degree) add_family(degree, curves);
  return curves;
}

}  // namespace tendril::test
