#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/binding.h>
#include <tendril/curve/bound_points.h>

namespace tendril::bind {

/// The points of a binding as those of `LoadedPoints`, for what deforms a bound mesh in part: a hierarchy
/// of tendril::collision, contact of its surface. Its groups hold the records in their own order (32 bytes
/// a point and group), so that a group is placed at the speed of an update, and to its last bit.
///
/// The promise on rounding: an update works on polynomials in s = (t - middle) / length of a span, |s| <=
/// 1/2. Basis functions are at least 0 there, so the two terms of each factor (a + b s) of their recurrence
/// have |a| + |b s| <= 2 and the absolute sum of a function's coefficients grows by at most 4 a degree: 2^10
/// at degree 5. Some 2^5 roundings of 2^-53 follow, so curve, velocity by s and offset are within 2^-38 of
/// the control points' size; normalising divides that by the lengths of velocity and offset cross velocity.
class TENDRIL_BIND_API BindingPoints : public LoadedPoints {
 public:
  /// \param binding  copied, which shares its arrays
  explicit BindingPoints(Binding binding) : binding_(std::move(binding)) {}

  std::size_t size() const override { return binding_.size(); }
  void shares(std::size_t point, std::vector<BoundShare>& out) const override;
  /// InvalidInput for a point that there is not, or beginnings that are not ascending from 0 to the number of
  /// points.
  std::unique_ptr<PointGroups> group(std::span<const std::uint32_t> begin,
                                     std::span<const std::uint32_t> points) const override;

  void place(std::span<const CurvePair> posed, std::span<const std::uint32_t> points,
             MutablePoints out) const override {
    binding_.at(posed, points, out);
  }
  void velocities(std::span<const CurvePair> posed, std::span<const CurvePair> rates,
                  std::span<const std::uint32_t> points, MutablePoints out) const override {
    binding_.velocities(posed, rates, points, out);
  }
  std::vector<ControlForces> pull_back(std::span<const CurvePair> posed,
                                       std::span<const std::uint32_t> points, Points forces) const override {
    return binding_.pull_back(posed, points, forces);
  }

 private:
  Binding binding_;
};

}  // namespace tendril::bind
