#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/random.h"

/// Pairs of triangles that are hard in different ways: each a way to make the next one.
namespace tendril::test {

struct TrianglePair {
  std::array<Vec3, 3> a, b;
  Vec3& operator[](std::size_t i) { return i < 3 ? a[i] : b[i - 3]; }
};

struct PairFamily {
  std::string name;
  TrianglePair (*next)(Random&);
};

inline TrianglePair random_pair(Random& random) {
  TrianglePair p;
  for (std::size_t i = 0; i < 6; ++i) p[i] = random.in_cube();
  return p;
}

inline TrianglePair grid_pair(Random& random) {
  TrianglePair p;
  for (std::size_t i = 0; i < 6; ++i)
    for (int k = 0; k < 3; ++k) p[i][k] = random.integer(4);
  return p;
}

/// On the grid, but rounded: nearly on one plane or one line.
inline TrianglePair shifted_grid_pair(Random& random) {
  TrianglePair p = grid_pair(random);
  for (std::size_t i = 0; i < 6; ++i) p[i] = p[i] * 0.1 + Vec3::Constant(1000.0);
  return p;
}

/// In a plane to the last bit: level, upright or slanted. Half of those in planes of the axes are of many
/// sizes and
/// have a corner on an edge, rounded, so that differences of coordinates are rounded too.
inline TrianglePair coplanar_pair(Random& random) {
  TrianglePair p;
  const int plane = random.integer(4);
  const bool near = random.integer(2) == 0;
  for (std::size_t i = 0; i < 6; ++i) {
    double x = 0x1p-20 * random.integer(1 << 20), y = 0x1p-20 * random.integer(1 << 20);
    if (plane < 3 && near) {
      x = std::ldexp(random.uniform(), -random.integer(12));
      y = std::ldexp(random.uniform(), -random.integer(12));
    }
    p[i] = plane == 0   ? Vec3(x, y, 0.25)
           : plane == 1 ? Vec3(0.5, x, y)
           : plane == 2 ? Vec3(y, -1, x)
                        : Vec3(x, y, x + 2 * y);
  }
  if (plane < 3 && near) p.b[0] = p.a[0] + random.uniform() * (p.a[1] - p.a[0]);
  return p;
}

inline TrianglePair shared_vertex_pair(Random& random) {
  TrianglePair p = random_pair(random);
  p.b[static_cast<std::size_t>(random.integer(3))] = p.a[static_cast<std::size_t>(random.integer(3))];
  return p;
}

/// A corner of b on a, as well as doubles can say.
inline TrianglePair vertex_on_face_pair(Random& random) {
  TrianglePair p = random_pair(random);
  const double s = random.uniform(), t = random.uniform() * (1 - s);
  p.b[0] = p.a[0] + s * (p.a[1] - p.a[0]) + t * (p.a[2] - p.a[0]);
  return p;
}

inline TrianglePair tiny_pair(Random& random) {
  TrianglePair p = random_pair(random);
  for (std::size_t i = 0; i < 6; ++i) p[i] *= 1e-7;
  return p;
}

/// Pressed flat along one axis, or two needles near each other's middles.
inline TrianglePair sliver_pair(Random& random) {
  TrianglePair p = random_pair(random);
  if (random.integer(2) == 0) {
    const int axis = random.integer(3);
    for (std::size_t i = 0; i < 6; ++i) p[i][axis] *= 1e-6;
    return p;
  }
  for (auto* t : {&p.a, &p.b}) {
    const double s = random.uniform();
    (*t)[2] = (*t)[0] + s * ((*t)[1] - (*t)[0]) + random.in_cube(1e-6);
  }
  const Vec3 shift = p.a[2] - p.b[2] + random.in_cube(1e-6);
  for (Vec3& x : p.b) x += shift;
  return p;
}

/// Corners that coincide, lie on one line, or on the other triangle's edges; on a grid, so exactly.
inline TrianglePair degenerate_pair(Random& random) {
  TrianglePair p = grid_pair(random);
  for (auto* t : {&p.a, &p.b}) {
    const int kind = random.integer(4);
    if (kind == 1) (*t)[2] = 0.5 * ((*t)[0] + (*t)[1]);
    if (kind == 2) (*t)[2] = (*t)[1];
    if (kind == 3) (*t)[1] = (*t)[2] = (*t)[0];
  }
  if (random.integer(2) == 0) p.b[0] = 0.5 * (p.a[0] + p.a[1]);
  return p;
}

/// On the grid but for a hair: some zeros are 2^-60 to 2^-99 instead, less than any rounding of their
/// neighbours.
inline TrianglePair hair_pair(Random& random) {
  TrianglePair p = grid_pair(random);
  for (std::size_t i = 0; i < 6; ++i)
    for (double& x : p[i])
      if (x == 0.0 && random.integer(2) == 0)
        x = std::ldexp(random.integer(2) - 0.5, -59 - random.integer(40));
  return p;
}

/// At the ends of the range of doubles, and from one end to the other within one triangle.
inline TrianglePair extreme_pair(Random& random) {
  TrianglePair p = grid_pair(random);
  const int kind = random.integer(4);
  for (std::size_t i = 0; i < 6; ++i)
    for (double& x : p[i]) {
      const int mixed = random.integer(2098) - 1074;
      const int exponent = kind == 0 ? 1021 : kind == 1 ? -1074 : kind == 2 ? (i < 3 ? 1000 : 999) : mixed;
      x = std::ldexp(x - (kind == 3 ? 1 : 0), kind == 3 ? exponent / 2 : exponent);
    }
  return p;
}

inline const std::vector<PairFamily>& pair_families() {
  static const std::vector<PairFamily> families{
      {"random", random_pair},
      {"integer grid 0..3", grid_pair},
      {"grid x 0.1 + 1000", shifted_grid_pair},
      {"coplanar", coplanar_pair},
      {"shared vertex", shared_vertex_pair},
      {"vertex on face, rounded", vertex_on_face_pair},
      {"size 1e-7", tiny_pair},
      {"slivers 1e-6", sliver_pair},
      {"a hair off the grid", hair_pair},
      {"degenerate", degenerate_pair},
      {"extreme", extreme_pair},
  };
  return families;
}

}  // namespace tendril::test
