#pragma once

#include <tendril/bind/binding_points.h>

#include <map>

namespace tendril::runner {

/// Points of a binding of which some stay where they are. A hierarchy knows them as bound to curve-pairs of
/// their own that are never posed: of n curve-pairs, the curve-pairs n to 2 n - 1 are those at rest again.
class StillPoints : public BoundPoints {
 public:
  /// \param still  indices of the points that stay
  /// \param at     all points, where they are at rest
  StillPoints(const bind::Binding& binding, std::span<const std::size_t> still, Points at);

  std::size_t size() const override { return points_.size(); }
  void shares(std::size_t point, std::vector<BoundShare>& out) const override;
  std::unique_ptr<PointGroups> group(std::span<const std::uint32_t> begin,
                                     std::span<const std::uint32_t> points) const override;

 private:
  bind::Binding binding_;
  bind::BindingPoints points_;
  std::map<std::size_t, Vec3> still_;
};

}  // namespace tendril::runner
