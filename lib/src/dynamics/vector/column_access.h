#pragma once

#include "columns.h"
#include "lanes.h"

namespace tendril::lanes {

/// Raw columns of a loop, so that the compiler knows they do not overlap.
struct Reader {
  explicit Reader(const Columns3& c) : x(c.x.data()), y(c.y.data()), z(c.z.data()) {}
  const double* __restrict x, * __restrict y, * __restrict z;
  TENDRIL_INLINE V3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};
struct Writer {
  explicit Writer(Columns3& c) : x(c.x.data()), y(c.y.data()), z(c.z.data()) {}
  double* __restrict x, * __restrict y, * __restrict z;
  TENDRIL_INLINE void put(std::size_t i, const V3& v) const {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
  TENDRIL_INLINE void add(std::size_t i, const V3& v) const {
    x[i] += v.x;
    y[i] += v.y;
    z[i] += v.z;
  }
};

}  // namespace tendril::lanes
