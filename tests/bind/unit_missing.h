#pragma once

#include <string>

#include "place/vector_units.h"

namespace tendril::bind {

/// Why a test of a unit's loops is skipped: their code cannot be run here; the narrower units' is tested.
inline std::string unit_missing(VectorUnit unit) {
  const std::string name = unit == VectorUnit::bits_512 ? "AVX-512 (F, DQ, BW, VL)" : "AVX2";
  return "this processor lacks " + name +
         ", which the loop under test is compiled for; it would stop at the first "
         "instruction";
}

}  // namespace tendril::bind
