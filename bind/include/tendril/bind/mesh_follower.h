#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/binding.h>
#include <tendril/dynamics/follower.h>

#include <vector>

namespace tendril::bind {

/// Keeps points on their moving curve-pairs: every call of follow updates `out` through the binding.
class TENDRIL_BIND_API MeshFollower : public Follower {
 public:
  /// \param binding  kept by reference
  /// \param pair     index of the binding's first curve-pair among those of the simulation; its others follow
  /// \param out      binding.size() points, kept by reference
  /// \param threads  1 to 256
  MeshFollower(const Binding& binding, std::size_t pair, MutablePoints out, int threads = 1);
  /// \param binding  kept by reference
  /// \param pairs    indices of the binding's curve-pairs among those of the simulation; as many as it has
  /// \param out      binding.size() points, kept by reference
  /// \param threads  1 to 256
  MeshFollower(const Binding& binding, std::vector<std::size_t> pairs, MutablePoints out, int threads = 1);

  void follow(double time, std::span<const CurvePair> pairs) override;

  double time() const { return time_; }      ///< of the last update
  long updates() const { return updates_; }  ///< number of them

 private:
  const Binding& binding_;
  std::vector<std::size_t> pairs_;
  MutablePoints out_;
  int threads_;
  double time_ = 0.0;
  long updates_ = 0;
};

}  // namespace tendril::bind
