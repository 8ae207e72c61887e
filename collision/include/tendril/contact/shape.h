#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

/// Solids that rods and surfaces come into contact with, by their signed distance.
namespace tendril::contact {

/// The signed distance phi of a solid at a point, in the solid's own frame and to second order.
struct SignedDistance {
  double value;    ///< to its surface; negative within
  Vec3 normal;     ///< the gradient of phi: away from the solid, unit
  Mat3 curvature;  ///< the Hessian of phi; 0 along the normal. Where phi has a kink, one side's
};

/// A ball that belongs to a solid.
struct ShapePoint {
  Vec3 centre;    ///< in the solid's frame
  double radius;  ///< at least 0
};

/// A solid. Extension point: derive, and hand it to a Body; nothing else knows which shapes there are.
/// All are const and pure, safe to call from several threads, and O(1) unless they say so.
class TENDRIL_CONTACT_API Shape {
 public:
  virtual ~Shape() = default;

  /// At a point of the solid's frame, anywhere.
  virtual SignedDistance at(const Vec3& x) const = 0;
  /// The value of at(x) alone. |phi(x) - phi(y)| must be at most |x - y|.
  virtual double distance(const Vec3& x) const { return at(x).value; }

  /// A straight line between two points outside enters the solid by at most l^2 / (8 R), l the way between
  /// them, where R is this: the least radius by which the surface bends outward. 0 where it has edges,
  /// infinite where it bends nowhere outward (a half space, the inside of a tube).
  virtual double outward_radius() const = 0;
  /// From the frame's origin to the farthest point of the solid; infinite where it has none.
  virtual double extent() const = 0;
  /// Balls in the solid such that a half space meets the solid no more than `depth` before it meets one of
  /// them. Where `round()`, any solid does. Empty for a solid that cannot be a free body.
  virtual std::vector<ShapePoint> points(double /*depth*/) const { return {}; }
  virtual bool round() const { return false; }  ///< all of its points have a positive radius
  /// Room within the solid's hollow for a ball, by its radius: infinite where there is no hollow.
  virtual double bore() const { return std::numeric_limits<double>::infinity(); }
};

/// A shape, shared by what uses it.
using ShapePtr = std::shared_ptr<const Shape>;

/// What is below the plane through the origin: z <= 0.
TENDRIL_CONTACT_API ShapePtr half_space();
/// A ball about the origin. InvalidInput unless 0 < radius < infinity, here and below.
TENDRIL_CONTACT_API ShapePtr ball(double radius);
/// All within `radius` of the segment from -half to half on the z axis; half may be 0.
TENDRIL_CONTACT_API ShapePtr capsule(double half, double radius);
/// |x_i| <= half_i, its edges sharp.
TENDRIL_CONTACT_API ShapePtr box(const Vec3& half);
/// A solid cylinder about the z axis, |z| <= half, which may be infinite.
TENDRIL_CONTACT_API ShapePtr cylinder(double radius, double half);
/// The wall of a tube about the z axis between the radii inner < outer, |z| <= half; outer and half may be
/// infinite. What is inside stays there until it leaves by the ends. At the very axis the normal is -x.
TENDRIL_CONTACT_API ShapePtr tube(double inner, double outer, double half);
/// What a closed surface encloses, its edges sharp; fixed or driven, never free. Points and triangles are
/// copied. Sides must not pass through each other, which is not checked: the sign is that of the nearest one.
/// A distance costs O(log n), some 1 us. InvalidInput for points that are not finite, indices out of range,
/// triangles without area, edges that do not belong to just two triangles of one orientation, points where
/// two parts touch, and what is inside out.
TENDRIL_CONTACT_API ShapePtr mesh(Points points, std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace tendril::contact
