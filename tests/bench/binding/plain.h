#pragma once

#include <tendril/bind/columns.h>
#include <tendril/curve/axial.h>

#include <array>
#include <cstdint>
#include <vector>

/// What anyone would write first, and what the machine can do.
namespace tendril::bench {

/// One pass over seven arrays of doubles or floats, reading four and writing three.
template <class T>
void stream(const std::array<std::vector<T>, 4>& from, const bind::Columns<T>& to);

/// c(t), c'(t) and c_D(t) by de Boor's triangle, then the frame, a point at a time.
void de_boor_loop(const CurvePair& posed, const std::vector<AxialPoint>& records, std::vector<Vec3>& out);

/// Linear blend skinning with four bones a vertex, matrices of 3 by 4.
struct Skin {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint16_t, 4>> bone;
  std::vector<std::array<double, 4>> weight;
  std::vector<std::array<double, 12>> matrix;
};
Skin make_skin(const std::vector<Vec3>& points, int bones);
void skin_loop(const Skin& skin, std::vector<Vec3>& out);

}  // namespace tendril::bench
