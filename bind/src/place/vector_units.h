#pragma once

#include <type_traits>

#include "base/vector_loops.h"

/// Loops compiled for several vector units, of which a run takes the widest that the machine has. Results do
/// not depend on which.
#if defined(__GNUC__) && defined(__x86_64__)
#define TENDRIL_UNIT_256 __attribute__((target("avx2")))
#if defined(__clang__)
#define TENDRIL_UNIT_512 __attribute__((target("avx512f,avx512dq,avx512bw,avx512vl")))
#else
#define TENDRIL_UNIT_512 __attribute__((target("avx512f,avx512dq,avx512bw,avx512vl,prefer-vector-width=512")))
#endif
#else
#define TENDRIL_UNIT_256
#define TENDRIL_UNIT_512
#endif

namespace tendril::bind {

enum class VectorUnit { plain, bits_256, bits_512 };

inline VectorUnit widest_unit() {
#if defined(__GNUC__) && defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    return VectorUnit::bits_512;
  if (__builtin_cpu_supports("avx2")) return VectorUnit::bits_256;
#endif
  return VectorUnit::plain;
}

/// Kernel::run, a static function marked TENDRIL_INLINE, compiled for each vector unit: it is inlined into a
/// function of each, whose unit it takes.
template <class Kernel>
struct OnUnits {
  template <class... Arguments>
  static auto run(VectorUnit unit, const Arguments&... arguments) {
    switch (unit) {
      case VectorUnit::bits_512:
        return on_512(arguments...);
      case VectorUnit::bits_256:
        return on_256(arguments...);
      default:
        return Kernel::run(arguments...);
    }
  }

 private:
  template <class... Arguments>
  TENDRIL_UNIT_256 static auto on_256(const Arguments&... arguments) {
    return Kernel::run(arguments...);
  }
  template <class... Arguments>
  TENDRIL_UNIT_512 static auto on_512(const Arguments&... arguments) {
    return Kernel::run(arguments...);
  }
};

/// Calls body(std::integral_constant<int, degree>) for a degree of 1 to 5.
template <class Body>
auto for_degree(int degree, const Body& body) {
  switch (degree) {
    case 1:
      return body(std::integral_constant<int, 1>{});
    case 2:
      return body(std::integral_constant<int, 2>{});
    case 3:
      return body(std::integral_constant<int, 3>{});
    case 4:
      return body(std::integral_constant<int, 4>{});
    default:
      return body(std::integral_constant<int, 5>{});
  }
}

}  // namespace tendril::bind
