#pragma once

#include <string>
#include <vector>

#include "spring_net.h"

namespace tendril::gallery {

/// Places and velocities of the masses of a net.
struct NetState {
  double time = 0.0;
  std::vector<Vec3> p, v;
};
NetState at_rest(const SpringNet& net);

/// What a run came to.
struct NetReport {
  bool finished = false;
  std::string reason = {};  ///< where it did not
  double time = 0.0;
  long accepted = 0, rejected = 0;
  long evaluations = 0;  ///< of the forces, those for the largest frequency included
};

struct NetOptions {
  double tolerance;  ///< of a step's error
  double size;       ///< what errors of places are relative to [length]
  double duration;   ///< of all that is asked for: of the guard's limit, a hundredth of it is the first step
};

/// Moves a net by the library's Cash-Karp pair (tendril/dynamics/cash_karp.h) on plain arrays, for nothing
/// but springs: the fastest fair rival. Everything else is as tendril::Simulation does it: the controller
/// of [Chan 2008] 3.34 (0.93, exponents 0.2 and 0.25, factor within 0.2 and 5), the scales of errors (size
/// of the net, largest speed so far, at least what the first acceleration gives over the size; where
/// nothing accelerates at first, the size over the duration), and the guard against amplified oscillations,
/// from a new estimate of the largest frequency every 128 steps.
class FlatRun {
 public:
  /// \param net  kept by reference
  FlatRun(const SpringNet& net, NetState start, const NetOptions& options);

  /// On to a time; may be called again to go on.
  const NetReport& run(double until);

  const NetState& state() const { return state_; }

 private:
  using Columns = std::vector<Vec3>;  ///< places, then velocities
  void rates(double time, const Columns& y, Columns& dy);
  template <std::size_t S>
  void stage(double h);
  double try_step(double h);
  void measure_guard();
  void see_speed();

  const SpringNet& net_;
  NetState state_;
  NetOptions options_;
  double speed_ = 0.0, step_ = 0.0, cap_ = 0.0;
  long since_guard_ = 0;
  Columns y_, next_, stage_;
  std::array<Columns, 6> k_;
  bool first_known_ = false;
  NetReport report_;
};

}  // namespace tendril::gallery
