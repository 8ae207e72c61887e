#pragma once

#include <tendril/bind/polygon_mesh.h>

namespace tendril::bind {

/// Points by their exact positions, 0 and -0 the same: a table with open addresses, at most half full. Ids
/// are given in the order of first appearance.
class PointTable {
 public:
  PointTable() : slots_(16, kFree) {}

  std::uint32_t id(const Vec3& p);
  std::size_t size() const { return points_.size(); }
  std::vector<Vec3> take() { return std::move(points_); }

 private:
  static constexpr std::uint32_t kFree = 0xffffffff;
  std::size_t slot_of(const Vec3& p) const;
  void grow();

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace tendril::bind
