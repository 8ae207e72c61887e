#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/force.h>
#include <tendril/dynamics/signal.h>
#include <tendril/dynamics/wind.h>

namespace tendril {

/// m g on every mass ([Chan 2008] 3.17); energy -sum m g.p.
class TENDRIL_CORE_API Gravity final : public Force {
 public:
  /// \param acceleration  g, finite; else InvalidInput
  explicit Gravity(const Vec3& acceleration);
  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  bool depends_on_time() const override { return false; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override;
  std::optional<Vec3> uniform_acceleration() const override { return g_; }
  bool acts_on_frames() const override { return false; }

 private:
  Vec3 g_;
};

/// direction times signal(t) on one node of one rod; a force [force] or a torque [torque] fixed in the world
/// frame.
class TENDRIL_CORE_API PointLoad : public Force {
 public:
  /// What it applies.
  enum class Kind { force, torque };
  /// Throws InvalidInput for a direction that is not finite; check() for a node that is not there.
  PointLoad(Kind kind, std::size_t rod, std::size_t node, const Vec3& direction, Signal signal);
  void add(const StateView& state, const Loads& loads) const override;
  void check(std::span<const NodeRange> rods) const override;
  bool has_energy() const override { return kind_ == Kind::force && signal_.is_constant(); }
  double energy(const StateView& state) const override;
  bool twists() const override { return kind_ == Kind::torque; }
  bool acts_on_frames() const override { return kind_ == Kind::torque; }
  Couplings couplings(std::span<const NodeRange> rods) const override;
  bool depends_on_time() const override { return !signal_.is_constant(); }
  std::vector<double> breaks() const override { return signal_.breaks(); }
  double period() const override { return signal_.period(); }

 private:
  Kind kind_;
  std::size_t rod_, node_;
  Vec3 direction_;
  Signal signal_;
};

/// A spring of rest length 0 that pulls a node towards a point: -K (p - target), energy 1/2 K |p - target|^2.
class TENDRIL_CORE_API PullTowards : public Force {
 public:
  /// Throws InvalidInput for a target that is not finite or a negative stiffness [force / length].
  PullTowards(std::size_t rod, std::size_t node, const Vec3& target, double stiffness);
  bool depends_on_time() const override { return false; }
  bool acts_on_frames() const override { return false; }
  void add(const StateView& state, const Loads& loads) const override;
  void check(std::span<const NodeRange> rods) const override;
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override;
  Couplings couplings(std::span<const NodeRange> rods) const override;

 private:
  std::size_t rod_, node_;
  Vec3 target_;
  double stiffness_;
};

}  // namespace tendril
