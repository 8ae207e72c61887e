#pragma once

#include <tendril/collision/continuous.h>
#include <tendril/collision/path_of_record.h>

#include <cmath>
#include <string>

#include "support/random.h"

namespace tendril::test {

/// A made-up continuous query. Its truth comes from meeting_truth.h; what it was made to be is `kind`.
template <int Degree>
struct MadeQuery {
  collision::Features features;
  collision::Paths<Degree> paths;
  std::string kind;
  bool surely_meets = false;
};

/// Makes queries of all kinds, the same ones from the same seed.
template <int Degree>
class QueryMaker {
 public:
  using Paths = collision::Paths<Degree>;
  using Features = collision::Features;

  explicit QueryMaker(std::uint64_t seed) : random_(seed) {}

  MadeQuery<Degree> make(Features features, int number) {
    features_ = features;
    switch (number % 20) {
      case 15:
      case 16:
        return parabolas("parabolas", random_.uniform(1e-6, 0.9));
      case 17:
        return parabolas("near miss", random_.uniform(-1.0, 1.0) < 0.0 ? -1e-12 : 1e-12);
      case 18:
        return special(number / 20 % 3);
      case 19:
        return special(3 + number / 20 % 4);
      default:
        return number % 2 == 0 ? anywhere() : smooth();
    }
  }

 private:
  template <class Point>
  Paths paths_of(Point&& point) {
    Paths paths;
    for (auto& path : paths)
      for (Vec3& p : path) p = point();
    return paths;
  }

  MadeQuery<Degree> anywhere() {
    return {features_, paths_of([&] { return random_.in_cube(); }), "anywhere"};
  }

  /// Features near each other that turn and drift, as those of a mesh within a step.
  MadeQuery<Degree> smooth() {
    Paths paths;
    const double reach = random_.uniform(0.1, 1.0);
    for (auto& path : paths) {
      const Vec3 from = random_.in_cube();
      const Vec3 along = random_.in_cube(reach);
      path = between({from, along + random_.in_cube(0.3 * reach)},
                     {from + along, along + random_.in_cube(0.3 * reach)});
    }
    return {features_, paths, "smooth"};
  }

  static std::array<Vec3, Degree + 1> between(const collision::Passing& from, const collision::Passing& to) {
    if constexpr (Degree == 3)
      return path_of_record(from, to, 1.0);
    else
      return {from.position, to.position};
  }

  /// Two features that face each other across a gap of twice their sagitta less `closer` of it (or an amount,
  /// if tiny), on mirrored parabolas (straight: towards each other and past by as much), turned and adrift.
  /// The chords of the curved paths do not move.
  MadeQuery<Degree> parabolas(const std::string& kind, double closer) {
    const double sagitta = random_.uniform(0.0005, 0.009);
    const double gap = std::abs(closer) < 1e-9 ? 2 * sagitta - closer : 2 * sagitta * (1.0 - closer);
    const Vec3 up = random_.in_cube().normalized();
    const Vec3 x = up.cross(random_.in_cube()).normalized();
    const Vec3 y = up.cross(x);
    const Vec3 drift = random_.in_cube();
    const int below = features_ == Features::vertex_face ? 1 : 2;
    Paths paths;
    for (int vertex = 0; vertex < 4; ++vertex) {
      const double side = vertex < below ? -1.0 : 1.0;
      const Vec3 place = corner(vertex, x, y);
      for (int i = 0; i <= Degree; ++i) {
        const double risen = Degree == 3 ? (i == 1 || i == 2 ? 4.0 / 3.0 : 0.0) * sagitta : i * sagitta;
        paths[vertex][i] = place + side * (0.5 * gap - risen) * up + i / (1.0 * Degree) * drift;
      }
    }
    return {features_, paths, kind, closer > 1e-9};
  }

  /// Corners of features that lie across each other, seen along the common normal.
  Vec3 corner(int vertex, const Vec3& x, const Vec3& y) {
    const double far = random_.uniform(0.5, 1.0);
    const double off = random_.uniform(-0.1, 0.1);
    if (features_ == Features::edge_edge)
      return (vertex % 2 == 0 ? far : -far) * (vertex < 2 ? x : y) + off * (vertex < 2 ? y : x);
    if (vertex == 0) return off * x;
    const double angle = 2.1 * vertex;
    return far * (std::cos(angle) * x + std::sin(angle) * y);
  }

  MadeQuery<Degree> special(int which) {
    switch (which) {
      case 0:
        return {features_, paths_of([&] { return whole(2); }), "whole numbers"};
      case 1:
        return meeting_at_an_end(0);
      case 2:
        return meeting_at_an_end(Degree);
      case 3:
        return {features_, paths_of([&] { return Vec3(random_.uniform(-1, 1), whole(3)[0], 0.0); }),
                "in a plane"};
      case 4:
        return {features_, paths_of([&]() -> Vec3 { return whole(3)[1] * Vec3(1, 2, -1); }), "on a line"};
      case 5:
        return degenerate();
      default:
        return {features_, paths_of([&] { return in_slanted_plane(); }), "in a slanted plane"};
    }
  }

  Vec3 whole(int most) {
    const int x = random_.integer(2 * most + 1) - most;
    const int y = random_.integer(2 * most + 1) - most;
    return Vec3(x, y, random_.integer(2 * most + 1) - most);
  }

  Vec3 in_slanted_plane() {
    const Vec3 p = whole(3);
    return p[0] * Vec3(1, 3, 2) + p[1] * Vec3(0, 1, -1) + Vec3(1, 1, 1);
  }

  /// The first vertex at its first or last time-control point on a corner, an edge or the middle of the other
  /// feature, exactly.
  MadeQuery<Degree> meeting_at_an_end(int end) {
    Paths paths = paths_of([&]() -> Vec3 { return whole(1000) / 1024.0; });
    const Vec3& a = paths[2][end];
    const Vec3& b = paths[3][end];
    const double weights[] = {0.0, 0.25, 0.5, 1.0};
    const double w = weights[random_.integer(4)];
    paths[0][end] = (1.0 - w) * a + w * b;
    return {features_, paths, "meeting at an end", true};
  }

  MadeQuery<Degree> degenerate() {
    Paths paths = paths_of([&] { return whole(4); });
    paths[3] = paths[2];
    if (random_.integer(3) == 0)
      paths[1] = paths[random_.integer(2)];
    else
      paths[0][Degree] = paths[2][Degree];
    return {features_, paths, "degenerate"};
  }

  Random random_;
  Features features_ = Features::vertex_face;
};

}  // namespace tendril::test
