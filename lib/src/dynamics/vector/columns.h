#pragma once

#include <tendril/curve/frames.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tendril {

/// Numbers in a row, with some zeros before the first and after the last: loops over nodes may look at both
/// neighbours without asking whether they are there.
///
/// The first begins a cache line, so that a vector of eight lies in one line and not across two. A loop walks
/// along many columns side by side, and a processor takes a number read for one just written where the two
/// stand at the same place of their pages, or a little behind; then it waits. So columns begin at different
/// places, by their `rank`: five lines apart, which keeps any eleven neighbours clear of each other.
class Column {
 public:
  Column() = default;
  Column(std::size_t size, std::size_t rank) : values_(size + kFront + kBack + kPage, 0.0) {
    begin_at(kApart * rank);
  }
  /// Begins at the same place of its page.
  Column(const Column& other) : values_(other.values_.size(), 0.0) {
    if (values_.empty()) return;
    begin_at(number_of(other.data()));
    std::copy_n(other.data(), values_.size() - kFront - kBack - kPage, data());
  }
  Column(Column&&) = default;
  Column& operator=(Column other) {
    values_.swap(other.values_);
    std::swap(first_, other.first_);
    return *this;
  }
  ~Column() = default;

  double& operator[](std::size_t i) { return values_[i + first_]; }
  double operator[](std::size_t i) const { return values_[i + first_]; }
  double* data() { return values_.data() + first_; }
  const double* data() const { return values_.data() + first_; }
  void set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

 private:
  // In numbers; a line is 8, a page 512.
  static constexpr std::size_t kFront = 8, kBack = 8, kPage = 512, kApart = 5 * 8;

  static std::size_t number_of(const double* at) {
    return reinterpret_cast<std::uintptr_t>(at) / sizeof(double);
  }
  /// At a place of a page.
  void begin_at(std::size_t place) { first_ = kFront + (place - number_of(values_.data()) - kFront) % kPage; }

  std::vector<double> values_;
  std::size_t first_ = kFront;
};

/// Vectors, one column for each component.
struct Columns3 {
  Columns3() = default;
  Columns3(std::size_t size, std::size_t rank) : x(size, rank), y(size, rank + 1), z(size, rank + 2) {}

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
