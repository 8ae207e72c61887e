#include "point_table.h"

#include <bit>

namespace tendril::bind {
namespace {

/// Bits, as a host that flushes subnormal numbers to 0 would otherwise find them equal to it.
std::uint64_t bits_of(double c) {
  const auto bits = std::bit_cast<std::uint64_t>(c);
  return bits << 1 == 0 ? 0 : bits;
}

bool same(const Vec3& a, const Vec3& b) {
  return bits_of(a.x()) == bits_of(b.x()) && bits_of(a.y()) == bits_of(b.y()) &&
         bits_of(a.z()) == bits_of(b.z());
}

/// The finalizer of splitmix64 after each coordinate [Steele et al. 2014].
std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t h = 0;
  for (const double c : p) {
    h = (h ^ bits_of(c)) + 0x9e3779b97f4a7c15;
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9;
    h = (h ^ h >> 27) * 0x94d049bb133111eb;
    h ^= h >> 31;
  }
  return h;
}

}  // namespace

std::size_t PointTable::slot_of(const Vec3& p) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(p) & mask;
  while (slots_[slot] != kFree && !same(points_[slots_[slot]], p)) slot = (slot + 1) & mask;
  return slot;
}

void PointTable::grow() {
  slots_.assign(2 * slots_.size(), kFree);
  for (std::uint32_t i = 0; i < points_.size(); ++i) slots_[slot_of(points_[i])] = i;
}

std::uint32_t PointTable::id(const Vec3& p) {
  std::size_t slot = slot_of(p);
  if (slots_[slot] != kFree) return slots_[slot];
  if (2 * points_.size() >= slots_.size()) {
    grow();
    slot = slot_of(p);
  }
  slots_[slot] = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  return slots_[slot];
}

}  // namespace tendril::bind
