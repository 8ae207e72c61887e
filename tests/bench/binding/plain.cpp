#include "bench/binding/plain.h"

#include <algorithm>

namespace tendril::bench {
namespace {

/// The curve's point from degree + 1 control points that begin at u.
Vec3 triangle(const Vec3* u, const double* knot, int degree, double t) {
  std::array<Vec3, kMaxDegree + 1> d;
  std::copy(u, u + degree + 1, d.begin());
  for (int level = 1; level <= degree; ++level)
    for (int j = degree; j >= level; --j) {
      const double left = knot[j - degree], right = knot[j + 1 - level];
      const double w = (t - left) / (right - left);
      d[static_cast<std::size_t>(j)] =
          (1.0 - w) * d[static_cast<std::size_t>(j - 1)] + w * d[static_cast<std::size_t>(j)];
    }
  return d[static_cast<std::size_t>(degree)];
}

/// Pointers as parameters: only these may a compiler take for distinct arrays.
template <class T>
void add_in_threes(const T* __restrict a, const T* __restrict b, const T* __restrict c, const T* __restrict d,
                   T* __restrict x, T* __restrict y, T* __restrict z, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = a[i] + b[i];
    y[i] = b[i] + c[i];
    z[i] = c[i] + d[i];
  }
}

}  // namespace

template <class T>
void stream(const std::array<std::vector<T>, 4>& from, const bind::Columns<T>& to) {
  add_in_threes(from[0].data(), from[1].data(), from[2].data(), from[3].data(), to.x.data(), to.y.data(),
                to.z.data(), from[0].size());
}
template void stream(const std::array<std::vector<double>, 4>&, const bind::Columns<double>&);
template void stream(const std::array<std::vector<float>, 4>&, const bind::Columns<float>&);

void de_boor_loop(const CurvePair& posed, const std::vector<AxialPoint>& records, std::vector<Vec3>& out) {
  const KnotVector& knots = posed.knots();
  const int p = knots.degree();
  const Points u = posed.primary().control_points(), v = posed.orientation().control_points();
  std::vector<Vec3> hodograph;
  for (std::size_t i = 0; i + 1 < u.size(); ++i) {
    const double width = knots.knots()[i + static_cast<std::size_t>(p) + 1] - knots.knots()[i + 1];
    hodograph.push_back(p * (u[i + 1] - u[i]) / width);
  }
  for (std::size_t i = 0; i < records.size(); ++i) {
    const AxialPoint& at = records[i];
    const int span = knots.span(at.t);
    const double* knot = knots.knots().data() + span;
    const std::size_t first = static_cast<std::size_t>(span - p);
    const Vec3 c = triangle(&u[first], knot, p, at.t);
    const Vec3 n = triangle(&v[first], knot, p, at.t) - c;
    const Vec3 z = triangle(&hodograph[first], knot, p - 1, at.t).normalized();
    const Vec3 x = n.cross(z).normalized();
    out[i] = c + at.u * x + at.v * z.cross(x) + at.w * z;
  }
}

Skin make_skin(const std::vector<Vec3>& points, int bones) {
  Skin skin{points, {}, {}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto first = static_cast<std::uint16_t>(i * static_cast<std::size_t>(bones - 4) / points.size());
    std::array<std::uint16_t, 4> bone{};
    for (std::uint16_t k = 0; k < 4; ++k) bone[k] = static_cast<std::uint16_t>(first + k);
    skin.bone.push_back(bone);
    skin.weight.push_back({0.4, 0.3, 0.2, 0.1});
  }
  for (int b = 0; b < bones; ++b) {
    const double c = std::cos(0.1 * b), s = std::sin(0.1 * b);
    skin.matrix.push_back({c, -s, 0, 0.1 * b, s, c, 0, 0, 0, 0, 1, 0.5});
  }
  return skin;
}

void skin_loop(const Skin& skin, std::vector<Vec3>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3& p = skin.points[i];
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& m = skin.matrix[skin.bone[i][k]];
      const double w = skin.weight[i][k];
      sum += w * Vec3(m[0] * p.x() + m[1] * p.y() + m[2] * p.z() + m[3],
                      m[4] * p.x() + m[5] * p.y() + m[6] * p.z() + m[7],
                      m[8] * p.x() + m[9] * p.y() + m[10] * p.z() + m[11]);
    }
    out[i] = sum;
  }
}

}  // namespace tendril::bench
