#pragma once

#include <Eigen/Geometry>
#include <array>

#include "spring_net.h"

namespace tendril::gallery {

/// A lattice of free-form deformation ([Sederberg and Parry 1986], [Chan 2008] 3.3): control points in a
/// box, and the volume of Bernstein polynomials over them. Its dynamic form has a mass at each control
/// point and 18 springs a cell, the thesis's number: 12 along the edges and a diagonal of each face; what
/// neighbouring cells have in common is there once.
class Lattice {
 public:
  /// \param box    at rest; points outside it are mapped by the same polynomials
  /// \param cells  along x, y, z: the degrees of the polynomials
  Lattice(const Eigen::AlignedBox3d& box, std::array<int, 3> cells);

  const std::vector<Vec3>& rest() const { return rest_; }
  const std::array<int, 3>& cells() const { return cells_; }
  /// Index of the control point in layer i along x.
  std::uint32_t index(int i, int j, int k) const;
  /// The layer along x that a control point is of.
  int layer(std::uint32_t index) const;

  /// Where control points at p carry a point that was at x at rest.
  Vec3 map(std::span<const Vec3> p, const Vec3& x) const;
  std::vector<Vec3> map(std::span<const Vec3> p, std::span<const Vec3> points) const;

  /// Equal masses at the control points, springs of one stiffness an edge (by length: stiffness = tension /
  /// rest).
  SpringNet net(double mass, double tension) const;

 private:
  Eigen::AlignedBox3d box_;
  std::array<int, 3> cells_;
  std::vector<Vec3> rest_;
};

}  // namespace tendril::gallery
