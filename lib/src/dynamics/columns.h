#pragma once

#include <tendril/curve/frames.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace tendril {

/// Memory that begins with a cache line: vectors of eight numbers then lie in one, not across two.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, kLine); }
  friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
};

/// Numbers in a row, with some zeros before the first and after the last: loops over nodes may look at both
/// neighbours without asking whether they are there.
class Column {
 public:
  Column() = default;
  explicit Column(std::size_t size) : values_(size + kFront + kBack, 0.0) {}

  double& operator[](std::size_t i) { return values_[i + kFront]; }
  double operator[](std::size_t i) const { return values_[i + kFront]; }
  double* data() { return values_.data() + kFront; }
  const double* data() const { return values_.data() + kFront; }
  void set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

 private:
  static constexpr std::size_t kFront = 8;
  static constexpr std::size_t kBack = 8;
  std::vector<double, LineAllocator<double>> values_;
};

/// Vectors, one column for each component.
struct Columns3 {
  Columns3() = default;
  explicit Columns3(std::size_t size) : x(size), y(size), z(size) {}

  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3& v) {
    x[i] = v.x();
    y[i] = v.y();
    z[i] = v.z();
  }
  void add(std::size_t i, const Vec3& v) {
    x[i] += v.x();
    y[i] += v.y();
    z[i] += v.z();
  }
  void set_zero() {
    x.set_zero();
    y.set_zero();
    z.set_zero();
  }

  Column x, y, z;
};

/// Node frames by their directors y and tangents z; x = y x z.
struct FrameColumns {
  explicit FrameColumns(std::size_t size) : y(size), z(size) {}

  Frame operator[](std::size_t i) const {
    const Vec3 m = y[i];
    const Vec3 t = z[i];
    return {m.cross(t), m, t};
  }
  void set(std::size_t i, const Frame& f) {
    y.set(i, f.y);
    z.set(i, f.z);
  }

  Columns3 y, z;
};

}  // namespace tendril
