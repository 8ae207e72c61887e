#pragma once

#include <tendril/curve/bound_points.h>
#include <tendril/dynamics/rod_curves.h>

namespace tendril {

/// Points that follow the curve-pairs of rods, as a force sees them: where they are at a state, how fast they
/// move, and what forces on them do to the masses and the frames.
class TENDRIL_CORE_API RodPoints {
 public:
  /// Throws InvalidInput for a rod that is not there, and none.
  /// \param curves  of all rods of the scene
  /// \param rods    of each of the curve-pairs that the points are bound to, its rod
  /// \param points  on the knots of these curves; not null
  RodPoints(RodCurves curves, std::vector<std::size_t> rods, std::shared_ptr<const LoadedPoints> points);

  const LoadedPoints& points() const { return *points_; }      ///< as they are bound
  std::span<const std::size_t> rods() const { return rods_; }  ///< of the curve-pairs
  const RodCurves& curves() const { return curves_; }          ///< of all rods

  /// The curve-pairs at a state, in the order of rods(). Empty where control points would overflow, that is
  /// beyond 1e150. Throws as RodCurves::pair: a force that asks says twists().
  std::vector<CurvePair> pairs(const StateView& state) const;
  /// How fast their control points move, likewise.
  std::vector<CurvePair> rates(const StateView& state) const;
  /// As pairs() of some of them; the others, on their knots, have all control points at 0.
  /// \param state  at which the forces are
  /// \param which  per curve-pair
  std::vector<CurvePair> pairs(const StateView& state, const std::vector<bool>& which) const;
  /// As rates(), likewise.
  /// \param state  at which the forces are
  /// \param which  per curve-pair
  std::vector<CurvePair> rates(const StateView& state, const std::vector<bool>& which) const;
  /// Adds what forces on the control points mean for the masses and frames.
  /// \param state   at which the forces are
  /// \param forces  one for each of rods(), as LoadedPoints::pull_back gives them
  /// \param loads   of the scene
  void add_loads(const StateView& state, std::span<const ControlForces> forces, const Loads& loads) const;

 private:
  RodCurves curves_;
  std::vector<std::size_t> rods_;
  std::shared_ptr<const LoadedPoints> points_;
};

}  // namespace tendril
