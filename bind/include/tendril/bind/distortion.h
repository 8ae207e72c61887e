#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/binding.h>

#include <cstdint>
#include <vector>

namespace tendril::bind {

/// Triangles next to each other, by a point, that a pose spoils.
struct SpoiltZone {
  Vec3 centre = Vec3::Zero();        ///< mean of their corners at rest, weighted by area [length]
  double radius = 0.0;               ///< about the centre, of their corners at rest [length]
  double area = 0.0;                 ///< at rest, over that of the mesh
  std::vector<std::uint32_t> faces;  ///< of the mesh, ascending
};

/// What a pose does to the triangles of a mesh, faces of more corners cut into fans. A triangle's map from
/// rest to pose is linear; its singular values are by how much it stretches lengths the most and the least.
struct Distortion {
  std::size_t triangles = 0;      ///< those with an area at rest above 1e-12 of the largest edge's square
  double most_stretch = 1.0;      ///< largest singular value of any triangle
  double least_stretch = 1.0;     ///< smallest one
  std::size_t stretched = 0;      ///< triangles with a singular value above the limit
  std::size_t crushed = 0;        ///< below 1 over it
  std::size_t folded = 0;         ///< turned over, against what their axis' frame does
  double spoilt = 0.0;            ///< share of the mesh's area at rest that is any of these
  std::vector<SpoiltZone> zones;  ///< connected, the largest area first
};

/// Measures a pose. A fold on the inner side of a bend sharper than the skin allows counts: it is one.
/// \param binding  of the mesh's points
/// \param rest     the curve-pairs it was made with
/// \param mesh     at rest, valid
/// \param posed    as for Binding::update
/// \param points   of the mesh in that pose, as many as it has
/// \param limit    above 1; else InvalidInput
/// Cost: O(points + corners), a frame a point.
TENDRIL_BIND_API Distortion measure_distortion(const Binding& binding, std::span<const CurvePair> rest,
                                               const PolygonMesh& mesh, std::span<const CurvePair> posed,
                                               Points points, double limit = 10.0);

/// Normals that were given at rest, turned as the faces beside each point are: the mean over these,
/// weighted by their area at rest, of the inverse transpose of each one's map, applied to the normal. Unit
/// length; those of points without a face with an area stay as they are.
/// \param mesh    at rest, with as many point_normals as points
/// \param points  posed, as many
TENDRIL_BIND_API std::vector<Vec3> posed_normals(const PolygonMesh& mesh, Points points);

}  // namespace tendril::bind
