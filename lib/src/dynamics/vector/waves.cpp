#include "waves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/vector_loops.h"
#include "lanes.h"

namespace tendril {
namespace {

constexpr double kFarthestPhase = 1e6;  // up to which the sines of lanes.h hold
constexpr std::size_t kMany = 24;       // delays for which a series is made
constexpr double kFarthest = 4.0;       // that a wave turns by from the middle of its delays [rad]
constexpr double kLeast = 0x1p-60;      // of a series' last term to the amplitude
constexpr std::size_t kTerms = 40;      // 4^n / n! is below that from n = 37 on

TENDRIL_LANES void add_one(const CarriedWave& wave, const double* __restrict delay, double* __restrict sum,
                           std::size_t count) {
  const auto [s, c, frequency] = wave;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const lanes::SineCosine turned = lanes::sine_cosine(frequency * delay[i]);
    sum[i] += s * turned.cosine - c * turned.sine;
  }
}

void add_exactly(const CarriedWave& wave, std::span<const double> delay, std::span<double> sum) {
  for (std::size_t i = 0; i < delay.size(); ++i) {
    const double a = wave.frequency * delay[i];
    sum[i] += wave.s * std::cos(a) - wave.c * std::sin(a);
  }
}

struct Around {
  double middle, radius;
  double farthest() const { return std::abs(middle) + radius; }
};

TENDRIL_LANES Around around(const double* __restrict delay, std::size_t count) {
  double low = delay[0], high = delay[0];
  for (std::size_t i = 1; i < count; ++i) {
    low = lanes::smaller(low, delay[i]);
    high = lanes::larger(high, delay[i]);
  }
  return {0.5 * (low + high), 0.5 * (high - low)};
}

/// A sum of waves as a series in (d - middle) / radius.
struct Series {
  std::array<double, kTerms> coefficient;
  std::size_t terms = 0;
};

constexpr std::size_t kTogether = 8;  // waves side by side

/// From the middle on each wave is S cos(q u) - C sin(q u), whose terms are (S, -C q, -S q^2 / 2, ...) u^n.
TENDRIL_LANES void add_terms(const CarriedWave* waves, std::size_t count, const Around& at, std::size_t terms,
                             std::array<double, kTerms * kTogether>& sums) {
  std::array<double, kTogether> even, odd, q;
  for (std::size_t k = 0; k < kTogether; ++k) {
    const CarriedWave wave = k < count ? waves[k] : CarriedWave{0.0, 0.0, 0.0};
    const lanes::SineCosine turned = lanes::sine_cosine(wave.frequency * at.middle);
    q[k] = wave.frequency * at.radius;
    even[k] = wave.s * turned.cosine - wave.c * turned.sine;
    odd[k] = -q[k] * (wave.c * turned.cosine + wave.s * turned.sine);
  }
  for (std::size_t n = 0; n < terms; n += 2) {
    const double next = -1.0 / static_cast<double>((n + 1) * (n + 2));
    const double after = -1.0 / static_cast<double>((n + 2) * (n + 3));
    for (std::size_t k = 0; k < kTogether; ++k) {
      sums[kTogether * n + k] += even[k];
      sums[kTogether * (n + 1) + k] += odd[k];
      const double square = q[k] * q[k];
      even[k] *= next * square;
      odd[k] *= after * square;
    }
  }
}

Series series_of(std::span<const CarriedWave> waves, const Around& at, double turn) {
  Series series;
  for (double term = 1.0; series.terms + 2 <= kTerms && term > kLeast; series.terms += 2)
    term *= turn * turn / static_cast<double>((series.terms + 1) * (series.terms + 2));
  std::array<double, kTerms * kTogether> sums;
  std::fill_n(sums.begin(), kTogether * series.terms, 0.0);
  for (std::size_t first = 0; first < waves.size(); first += kTogether)
    add_terms(waves.data() + first, std::min(kTogether, waves.size() - first), at, series.terms, sums);
  for (std::size_t n = 0; n < series.terms; ++n) {
    const double* of = sums.data() + kTogether * n;
    series.coefficient[n] = ((of[0] + of[1]) + (of[2] + of[3])) + ((of[4] + of[5]) + (of[6] + of[7]));
  }
  return series;
}

/// So many at a time that their sums stay in registers.
constexpr std::size_t kStrip = 32;
template <std::size_t Count>
TENDRIL_INLINE void add_strip(const Series& series, double middle, double inverse,
                              const double* __restrict delay, double* __restrict sum, std::size_t count) {
  std::array<double, Count> u, s;
  for (std::size_t k = 0; k < Count; ++k) u[k] = k < count ? (delay[k] - middle) * inverse : 0.0;
  for (std::size_t k = 0; k < Count; ++k) s[k] = series.coefficient[series.terms - 1];
  for (std::size_t n = series.terms - 1; n-- > 0;)
    for (std::size_t k = 0; k < Count; ++k) s[k] = s[k] * u[k] + series.coefficient[n];
  for (std::size_t k = 0; k < Count && k < count; ++k) sum[k] += s[k];
}

TENDRIL_LANES void add_series(const Series& series, const Around& at, const double* delay, double* sum,
                              std::size_t count) {
  const double inverse = at.radius > 0.0 ? 1.0 / at.radius : 0.0;
  for (std::size_t i = 0; i < count; i += kStrip)
    add_strip<kStrip>(series, at.middle, inverse, delay + i, sum + i, count - i);
}

}  // namespace

void add_waves(std::span<const CarriedWave> waves, std::span<const double> delay, std::span<double> sum) {
  if (delay.empty() || waves.empty()) return;
  double fastest = 0.0;
  for (const CarriedWave& wave : waves) fastest = std::max(fastest, std::abs(wave.frequency));
  const Around at = around(delay.data(), delay.size());
  const double turn = fastest * at.radius;
  if (!(fastest * at.farthest() < kFarthestPhase))
    for (const CarriedWave& wave : waves) add_exactly(wave, delay, sum);
  else if (delay.size() >= kMany && turn <= kFarthest)
    add_series(series_of(waves, at, turn), at, delay.data(), sum.data(), delay.size());
  else
    for (const CarriedWave& wave : waves) add_one(wave, delay.data(), sum.data(), delay.size());
}

}  // namespace tendril
