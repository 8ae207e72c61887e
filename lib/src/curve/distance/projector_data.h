#pragma once

#include <tendril/curve/closest_point.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

#include "distance_search.h"
#include "minima_sweep.h"

namespace tendril {

/// The curve and what classification needs; the search proper depends on the degree.
struct CurveProjector::Data {
  explicit Data(const BSpline& c) : curve(c) {
    Eigen::AlignedBox3d box;
    for (const Vec3& u : curve.control_points()) {
      box.extend(u);
      reach = std::max(reach, u.norm());
    }
    centre = box.center();
    diagonal = box.diagonal().norm();
  }
  virtual ~Data() = default;

  struct Found {
    double t;
    double least;   ///< proven: no distance is smaller
    int span = -1;  ///< that ends with t or holds it, when known
  };
  /// The same for many points, neighbours in space: found[i] for every i in `which`.
  class Batch {
   public:
    virtual ~Batch() = default;
    virtual void find(Points points, std::span<const std::uint32_t> which, std::span<Found> found) = 0;
  };
  virtual std::unique_ptr<Batch> batch() const = 0;
  virtual std::vector<Projection> describe(Points points, std::span<const Found> found) const = 0;
  /// \param hint  a parameter, NaN for none: its sub-piece is examined first
  virtual Found find(const Vec3& p, const search::Bounds& bounds, double hint) const = 0;
  /// Local minima up to the distance `cut`, in the order of t.
  virtual std::vector<search::Minimum> sweep(const Vec3& p, double cut, double blur) const = 0;

  double size(const Vec3& p) const { return diagonal + (p - centre).norm(); }
  search::Bounds bounds(const Vec3& p) const { return bounds_for(size(p)); }
  search::Bounds bounds_for(double size) const {
    const double blur = 12 * (curve.degree() + 1) * search::kUnit * reach;
    return {1e-14 * size, 1e-13 * size + 4.0 * blur, blur, 1e-13 * size + blur};
  }

  /// Speed below rounding of the control points' differences, in a span of that length.
  bool at_rest(double speed, double length) const {
    return speed * length <= 64.0 * search::kUnit * (diagonal + reach);
  }

  BSpline curve;
  Vec3 centre;
  double diagonal = 0.0;
  double reach = 0.0;  ///< largest norm of a control point
};

}  // namespace tendril
