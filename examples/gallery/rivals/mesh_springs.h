#pragma once

#include "spring_net.h"

namespace tendril::gallery {

/// Stiffnesses of a cloth's springs [force / length].
struct ClothSprings {
  double structural, shear, bending;
};

/// Springs on a sheet of columns x rows vertices, row after row: structural ones along both directions, one
/// shear spring across each quad, its direction alternating, and bending springs between second neighbours
/// in every other row and column. On 7 x 7 vertices these are 84 + 36 + 24 = 144, the number of the thesis,
/// which does not say where its springs are.
SpringNet cloth_net(std::span<const Vec3> points, int columns, int rows, double mass,
                    const ClothSprings& springs);

/// Springs on a closed mesh of triangles: one along each edge, and one across it between the two corners that
/// face it, against bending.
SpringNet closed_mesh_net(std::span<const Vec3> points,
                          std::span<const std::array<std::uint32_t, 3>> triangles, double mass,
                          double stiffness);

}  // namespace tendril::gallery
