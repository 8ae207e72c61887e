#include "waves.h"

#include <cstddef>

#include "base/vector_loops.h"
#include "lanes.h"

namespace tendril {
namespace {

TENDRIL_LANES void add(double s, double c, double frequency, const double* __restrict at,
                       double* __restrict sum, std::size_t count) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const lanes::SineCosine turned = lanes::sine_cosine(frequency * at[i]);
    sum[i] += s * turned.cosine - c * turned.sine;
  }
}

}  // namespace

void add_wave(double s, double c, double frequency, std::span<const double> at, std::span<double> sum) {
  add(s, c, frequency, at.data(), sum.data(), at.size());
}

}  // namespace tendril
