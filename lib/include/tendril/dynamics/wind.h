#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/force.h>
#include <tendril/dynamics/signal.h>

#include <cstdint>

namespace tendril {

/// Air that moves: u(x, t) = mean + gust strength along the mean direction, times a sum of waves that the air
/// carries along, 1/sqrt(waves) sum_k sin(2 pi f_k (t - x.d / |mean|) + phi_k), f_k spread evenly in ratio
/// over one decade around `gust_frequency`; deterministic by `seed`. With `switched` the whole wind is
/// multiplied by that signal.
struct WindOptions {
  Vec3 mean = Vec3::Zero();                 ///< [length / time]
  double gust = 0.0;                        ///< root mean square gust over |mean|, times sqrt(2)
  double gust_frequency = 1.0;              ///< [1 / time]
  int waves = 8;                            ///< 0 to 1000
  std::uint64_t seed = 1;                   ///< of the waves' phases
  double air_density = 1.2;                 ///< [mass / length^3]
  double normal_drag = 1.2;                 ///< coefficient for flow across an edge
  double tangential_drag = 0.02;            ///< for flow along it
  Signal switched = Signal::constant(1.0);  ///< factor on the whole wind
};

/// Drag of the air on every edge ([Chan 2008] 3.18, as a vector): with w = v_edge - u, split across and along
/// the edge, -1/2 rho width |e| (C_n |w_n| w_n + C_t |w_t| w_t), half to each end.
class TENDRIL_CORE_API Wind : public Force {
 public:
  /// Throws InvalidInput for options out of range.
  explicit Wind(const WindOptions& options);
  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange> rods) const override;
  std::vector<double> breaks() const override { return options_.switched.breaks(); }
  double period() const override;
  bool acts_on_frames() const override { return false; }
  /// Air velocity at a point and time.
  Vec3 velocity(const Vec3& x, double t) const;
  /// And its derivative by x.
  Mat3 velocity_gradient(const Vec3& x, double t) const;

 private:
  void add_derivatives(const StateView& state, LoadDerivatives& to) const;
  struct Wave {
    double frequency, phase;
  };
  WindOptions options_;
  std::vector<Wave> waves_;
};

}  // namespace tendril
