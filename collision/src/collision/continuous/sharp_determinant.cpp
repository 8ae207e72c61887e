#include "sharp_determinant.h"

namespace tendril::collision {
namespace {

/// Of the time-control points at a time.
template <int Degree>
std::array<Twofold, Degree + 1> weights_at(double time) {
  const Twofold t{time, 0.0}, s = Twofold::sum(1.0, -time);
  if constexpr (Degree == 1) {
    return {s, t};
  } else {
    const Twofold ss = s * s, tt = t * t, three{3.0, 0.0};
    return {ss * s, three * (ss * t), three * (s * tt), tt * t};
  }
}

}  // namespace

template <int Degree>
SharpDeterminant<Degree>::SharpDeterminant(const Paths<Degree>& paths, double scale) {
  for (int i = 0; i <= Degree; ++i)
    for (int which = 0; which < 3; ++which)
      for (int k = 0; k < 3; ++k)
        control_[i][3 * which + k] = Twofold::sum(scale * paths[which + 1][i][k], -scale * paths[0][i][k]);
}

template <int Degree>
double SharpDeterminant<Degree>::operator()(double time) const {
  const auto weight = weights_at<Degree>(time);
  std::array<Twofold, 9> d;
  for (int k = 0; k < 9; ++k) {
    d[k] = weight[0] * control_[0][k];
    for (int i = 1; i <= Degree; ++i) d[k] = d[k] + weight[i] * control_[i][k];
  }
  const auto minor = [&](int x, int y) { return d[3 + x] * d[6 + y] - d[3 + y] * d[6 + x]; };
  return (d[0] * minor(1, 2) + d[1] * minor(2, 0) + d[2] * minor(0, 1)).high;
}

template class SharpDeterminant<1>;
template class SharpDeterminant<3>;

}  // namespace tendril::collision
