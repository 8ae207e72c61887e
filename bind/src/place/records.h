#pragma once

#include <cstddef>
#include <vector>

namespace tendril::bind {

/// Axial records as a loop reads them, s in place of t.
template <class T>
struct RecordsView {
  const T *s, *u, *v, *w;
  RecordsView from(std::size_t i) const { return {s + i, u + i, v + i, w + i}; }
};

template <class T>
struct Records {
  std::vector<T> s, u, v, w;

  Records() = default;
  explicit Records(std::size_t count) : s(count), u(count), v(count), w(count) {}
  template <class U>
  explicit Records(const Records<U>& other)
      : s(other.s.begin(), other.s.end()),
        u(other.u.begin(), other.u.end()),
        v(other.v.begin(), other.v.end()),
        w(other.w.begin(), other.w.end()) {}

  std::size_t size() const { return s.size(); }
  RecordsView<T> from(std::size_t i) const {
    return RecordsView<T>{s.data(), u.data(), v.data(), w.data()}.from(i);
  }
};

template <class T>
struct ColumnsView {
  T *x, *y, *z;
  ColumnsView from(std::size_t i) const { return {x + i, y + i, z + i}; }
};

}  // namespace tendril::bind
