#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <numbers>
#include <string>

#include "support/pairs.h"

/// Axes through a mesh, from gentle to absurd, and poses of them.
namespace tendril::test {

struct Chain {
  std::vector<Vec3> points;
  Vec3 side;  ///< the orientation curve lies there
};

/// A pose of a chain: the same count of masses.
struct AxisCase {
  std::string name;
  Chain rest;
};

/// The box of the points with its sides in descending order.
struct SortedBox {
  Vec3 low, size;
  std::array<Eigen::Index, 3> axis;

  explicit SortedBox(Points points) : low(points.front()) {
    Vec3 high = low;
    for (const Vec3& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    size = high - low;
    axis = {0, 1, 2};
    std::stable_sort(axis.begin(), axis.end(), [&](auto a, auto b) { return size[a] > size[b]; });
  }
  /// A place by shares of the three sides.
  Vec3 at(double a, double b, double c) const {
    Vec3 p;
    p[axis[0]] = low[axis[0]] + a * size[axis[0]];
    p[axis[1]] = low[axis[1]] + b * size[axis[1]];
    p[axis[2]] = low[axis[2]] + c * size[axis[2]];
    return p;
  }
};

template <class F>
Chain chain(const SortedBox& box, int count, F&& place) {
  Chain out{{}, Vec3::Unit(box.axis[2])};
  for (int i = 0; i < count; ++i) out.points.push_back(place(static_cast<double>(i) / (count - 1)));
  return out;
}

inline std::vector<AxisCase> tear_axes(Points points) {
  const SortedBox box(points);
  const double pi = std::numbers::pi;
  const auto straight = [&](double s) { return box.at(0.05 + 0.9 * s, 0.5, 0.5); };
  const auto wave = [&](double s) { return box.at(0.05 + 0.9 * s, 0.5 + 0.15 * std::sin(2 * pi * s), 0.5); };
  const auto bend = [&](double s) {
    return box.at(0.5 - 0.45 * std::cos(pi * s), 0.25 + 0.5 * std::sin(pi * s), 0.5);
  };
  const auto u_bend = [&](double s) {
    const double along = s < 0.4 ? s / 0.4 : s > 0.6 ? (1 - s) / 0.4 : 1.0;
    const double across = s < 0.4 ? 0.0 : s > 0.6 ? 1.0 : (s - 0.4) / 0.2;
    const double round = 0.15 * std::sin(pi * across);
    return box.at(0.1 + 0.65 * along + round, 0.5 - 0.15 * std::cos(pi * across), 0.5);
  };
  const auto loops = [&](double s) {
    const double a = 6 * pi * s;
    return box.at(0.1 + 0.8 * s + 0.08 * std::sin(a), 0.5 + 0.2 * std::cos(a), 0.5 + 0.05 * std::sin(3 * s));
  };
  return {{"straight", chain(box, 12, straight)},
          {"wave", chain(box, 16, wave)},
          {"bend", chain(box, 16, bend)},
          {"U-bend", chain(box, 24, u_bend)},
          {"loops", chain(box, 36, loops)}};
}

inline constexpr int kTearPoses = 5;
inline const char* tear_pose_name(int pose) {
  return std::array{"straightened", "arc", "twisted", "swaying", "curled"}[static_cast<std::size_t>(pose)];
}

/// The curve-pair at rest and in a pose, on the same knots.
struct RestAndPose {
  CurvePair rest, posed;
};

inline RestAndPose tear_pose(const Chain& chain, int pose) {
  const std::vector<Vec3>& p = chain.points;
  const Vec3 along = (p.back() - p.front()).normalized();
  const Vec3 across = chain.side.cross(along).normalized(), up = along.cross(across);
  double length = 0.0;
  for (std::size_t i = 1; i < p.size(); ++i) length += (p[i] - p[i - 1]).norm();
  std::vector<Vec3> posed = p, sides(p.size(), chain.side);
  const PolygonTangents tangents = polygon_tangents(p);
  double s = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i > 0) s += (p[i] - p[i - 1]).norm();
    const double turn = pose == 1 ? 0.5 * std::numbers::pi : 1.5 * std::numbers::pi;
    const double a = turn * s / length, radius = length / turn;
    if (pose == 0) posed[i] = p.front() + s * along;
    if (pose == 1 || pose == 4)
      posed[i] = p.front() + radius * (std::sin(a) * along + (1 - std::cos(a)) * up);
    if (pose == 2) sides[i] = rotate_about(tangents.t[i], a, chain.side);
    if (pose == 3) posed[i] += 0.08 * length * std::sin(2 * a) * (s / length) * (across + 0.5 * up);
    if (pose == 1 || pose == 4) sides[i] = across;
  }
  const Interpolator fit(3, p);
  const double offset = 0.1 * length;
  const auto orientation = [&](const std::vector<Vec3>& at, const std::vector<Vec3>& to) {
    std::vector<Vec3> q = at;
    for (std::size_t i = 0; i < at.size(); ++i) q[i] += offset * to[i];
    return fit.solve(q);
  };
  return {CurvePair(fit.knots(), fit.solve(p), orientation(p, std::vector<Vec3>(p.size(), chain.side))),
          CurvePair(fit.knots(), fit.solve(posed), orientation(posed, sides))};
}

}  // namespace tendril::test
