#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/binding.h>

namespace tendril::bind {

/// A binding's update in single precision: half the memory traffic, for what is drawn. The records are the
/// binding's, rounded; a point comes back at rest to about 1e-6 of the coordinates' size. Where a frame is
/// within 1e-2 of degenerate it is computed in double precision. The same bits for any number of threads, on
/// any vector unit, and for a point alone. Immutable, cheap to copy.
class TENDRIL_BIND_API Bindingf {
 public:
  /// \param binding  copied, which shares its arrays; its records are rounded. O(shares)
  explicit Bindingf(const Binding& binding);

  std::size_t size() const { return binding_.size(); }  ///< number of points
  const Binding& binding() const { return binding_; }   ///< in double precision

  /// As Binding::update: in the order of the points, or, which is fastest, in binding order.
  void update(std::span<const CurvePair> posed, std::span<Eigen::Vector3f> out, int threads = 1) const;
  /// The same in binding order.
  void update(std::span<const CurvePair> posed, const Columns<float>& out, int threads = 1) const;
  /// One point alone: the same bits as update gives it.
  Eigen::Vector3f at(std::span<const CurvePair> posed, std::size_t point) const;

 private:
  struct Numbers;
  Binding binding_;
  std::shared_ptr<const Numbers> numbers_;
};

}  // namespace tendril::bind
