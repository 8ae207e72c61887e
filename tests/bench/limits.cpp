#include "bench/limits.h"

#include <array>
#include <cmath>
#include <vector>

#include "bench/clock.h"

namespace tendril::bench {
namespace {

using Array = std::vector<double>;

void triad(const Array& b, const Array& c, double s, Array& a) {
  const double* from = b.data();
  const double* with = c.data();
  double* to = a.data();
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i) to[i] = from[i] + s * with[i];
}

struct Chain {
  explicit Chain(std::size_t n) : edge_length(1.0 / static_cast<double>(n)) {
    for (auto* arrays : {&p, &v, &dp, &dv, &edge}) arrays->fill(Array(n + 4, 0.0));
    for (std::size_t i = 0; i < n + 4; ++i) {
      p[0][i] = static_cast<double>(i) * edge_length;
      p[1][i] = 0.1 * edge_length * std::sin(0.3 * static_cast<double>(i));
      v[2][i] = 0.01 * std::cos(0.2 * static_cast<double>(i));
    }
  }

  void stretch(std::size_t n) {
    const double *px = p[0].data(), *py = p[1].data(), *pz = p[2].data();
    double* __restrict ex = edge[0].data();
    double* __restrict ey = edge[1].data();
    double* __restrict ez = edge[2].data();
    const double rest = edge_length;
    for (std::size_t i = 0; i < n + 3; ++i) {
      const double x = px[i + 1] - px[i], y = py[i + 1] - py[i], z = pz[i + 1] - pz[i];
      const double tension = 1e3 * (1.0 - rest / std::sqrt(x * x + y * y + z * z));
      ex[i] = tension * x;
      ey[i] = tension * y;
      ez[i] = tension * z;
    }
  }

  void rates(std::size_t n) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double *x = p[k].data(), *w = v[k].data(), *f = edge[k].data();
      double* __restrict dx = dp[k].data();
      double* __restrict dw = dv[k].data();
      for (std::size_t i = 2; i < n + 2; ++i) {
        const double fourth = x[i - 2] - 4 * x[i - 1] + 6 * x[i] - 4 * x[i + 1] + x[i + 2];
        dw[i] = 1e2 * (f[i] - f[i - 1] - 3.0 * fourth) - 0.5 * w[i];
        dx[i] = w[i];
      }
    }
  }

  double edge_length;
  std::array<Array, 3> p, v, dp, dv, edge;
};

}  // namespace

double bytes_ns(std::size_t nodes) {
  // 24 bytes an entry: 4 entries are a node's 96.
  Array a(4 * nodes), b(4 * nodes, 1.0), c(4 * nodes, 2.0);
  double s = 0.5;
  const double seconds = fastest_of_many(5, 0.02, [&] {
    triad(b, c, s, a);
    s = a[0] * 0.1;
  });
  return 1e9 * seconds / static_cast<double>(nodes);
}

double plain_chain_ns(std::size_t nodes) {
  Chain chain(nodes);
  const double seconds = fastest_of_many(5, 0.02, [&] {
    chain.stretch(nodes);
    chain.rates(nodes);
    chain.p[1][2] += 1e-9 * chain.dp[1][2];
  });
  return 1e9 * seconds / static_cast<double>(nodes);
}

}  // namespace tendril::bench
