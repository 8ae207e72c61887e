#include "slab.h"

#include <limits>

#include "interval.h"

namespace tendril::collision {
namespace {

constexpr double kRounding = 0x1p-36;  // what BoundPoints promises
constexpr double kOwn = 0x1p-40;       // rounding before the first interval, relative to the span's sizes
// Below these the frame turns so fast that a bound on it would be too wide to say anything.
constexpr double kLeastSpeed = 1.0 / 64.0, kLeastOffset = 1.0 / 16.0;  // of the span's sizes
constexpr double kInfinite = std::numeric_limits<double>::infinity();

using Controls = std::array<Vec3, kMostControls>;

Controls in_slab(const SlabWeights& weights, const Controls& points, std::size_t count) {
  Controls out;
  for (std::size_t j = 0; j < count; ++j) {
    Vec3 sum = weights.row[j][0] * points[0];
    for (std::size_t i = 1; i < count; ++i) sum += weights.row[j][i] * points[i];
    out[j] = sum;
  }
  return out;
}

Spread hull(const Controls& points, std::size_t count) {
  Vec3 low = points[0], high = points[0];
  for (std::size_t j = 1; j < count; ++j) {
    low = low.cwiseMin(points[j]);
    high = high.cwiseMax(points[j]);
  }
  return {0.5 * (low + high), 0.5 * (high - low)};
}

/// Between the least and the largest of top[j] / bottom[j]; all bottoms positive. The quotient of two
/// polynomials is a mean of these with positive weights, which is tighter than to divide their hulls.
Interval ratio(const std::array<double, kMostControls>& top, const std::array<double, kMostControls>& bottom,
               std::size_t count) {
  double low = top[0] / bottom[0], high = low;
  for (std::size_t j = 1; j < count; ++j) {
    const double x = top[j] / bottom[j];
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return outward(low, high);
}

double least(const std::array<double, kMostControls>& x, std::size_t count) {
  return *std::min_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Orthonormal to a few units of rounding; false where nothing spans them.
bool choose_axes(const Vec3& along, const Vec3& offset, Mat3& axes) {
  // Any axes give a true bound; those along the slab's own frame give one near (0, 0, 1), hence a narrow one.
  const double length = along.norm();
  const Vec3 z = along / length;
  const Vec3 x = offset.cross(z);
  const double width = x.norm();
  if (!(length > 0.0) || !(width > 0.0)) return false;
  axes.col(2) = z;
  axes.col(0) = x / width;
  axes.col(1) = z.cross(axes.col(0));
  return true;
}

/// Components of control points in the axes.
struct Components {
  std::array<double, kMostControls> x{}, y{}, z{};
};
Components components(const Mat3& axes, const Controls& points, std::size_t count) {
  Components out;
  for (std::size_t j = 0; j < count; ++j) {
    out.x[j] = axes.col(0).dot(points[j]);
    out.y[j] = axes.col(1).dot(points[j]);
    out.z[j] = axes.col(2).dot(points[j]);
  }
  return out;
}

using Direction = std::array<Interval, 3>;

/// Back to the world's axes, each component up to `turn`.
Spread in_world(const Mat3& axes, const Direction& d, double turn) {
  Vec3 middle, radius;
  for (int k = 0; k < 3; ++k) {
    const Interval& i = d[static_cast<std::size_t>(k)];
    middle[k] = i.middle();
    radius[k] = std::max(i.high - middle[k], middle[k] - i.low);
  }
  return {axes * middle, axes.cwiseAbs() * radius + Vec3::Constant(turn)};
}

/// The frame from the four ratios; false where it may turn too far.
bool frame_of(const Interval& alpha, const Interval& beta, const Interval& p, const Interval& r,
              std::array<Direction, 3>& axis) {
  // Up to here, half a right angle, the intervals stay narrow; beyond, the caller cuts the span finer.
  if (!(std::max(alpha.most(), beta.most()) <= 1.0) || !(p.most() <= 1.0)) return false;
  const Interval one{1.0, 1.0};
  const Interval first = one - r * beta;
  if (!(first.low >= 0.5)) return false;
  const Interval xi = (r * alpha - p) / first, zeta = (p * beta - alpha) / first;
  if (!(std::max(xi.most(), zeta.most()) <= 4.0)) return false;
  const Interval z = inverse_length(alpha, beta), x = inverse_length(xi, zeta), y = z * x;
  axis[0] = {x, xi * x, zeta * x};
  axis[1] = {(beta * zeta - xi) * y, (one - alpha * zeta) * y, (alpha * xi - beta) * y};
  axis[2] = {alpha * z, beta * z, z};
  return true;
}

void bound_frame(const SpanControls& span, const SlabWeights& weights, const Controls& c, Slab& slab) {
  const std::size_t count = span.count;
  if (!(span.reach > 1e-100) || !(span.offset > 1e-100) || !(span.origin < 1e100)) return;
  const Controls n = in_slab(weights, span.n, count);
  Controls e;
  Vec3 offset = n[0];
  for (std::size_t j = 0; j + 1 < count; ++j) {
    e[j] = c[j + 1] - c[j];
    offset += n[j + 1];
  }
  Mat3 axes;
  if (!choose_axes(c[count - 1] - c[0], offset, axes)) return;
  const Components d = components(axes, e, count - 1), m = components(axes, n, count);
  const double step = least(d.z, count - 1), across = least(m.y, count);
  const double speed = static_cast<double>(count - 1) * step / weights.width;
  if (!(speed >= kLeastSpeed * span.reach) || !(across >= kLeastOffset * span.offset)) return;
  const Interval alpha = ratio(d.x, d.z, count - 1), beta = ratio(d.y, d.z, count - 1);
  std::array<Direction, 3> axis;
  if (!frame_of(alpha, beta, ratio(m.x, m.y, count), ratio(m.z, m.y, count), axis)) return;
  const double of_tangent = kRounding * span.origin / speed + kOwn * span.reach / step;
  const double of_offset = kRounding * span.origin / across + kOwn * span.offset / across;
  const double turn = 8.0 * (of_tangent * (1.0 + span.offset / across) + of_offset) + kRounding;
  for (std::size_t k = 0; k < 3; ++k) slab.axis[k] = in_world(axes, axis[k], turn);
  slab.framed = true;
}

}  // namespace

Slab bound_slab(const SpanControls& span, const SlabWeights& weights) {
  Slab slab;
  const Controls c = in_slab(weights, span.c, span.count);
  slab.c = hull(c, span.count);
  slab.c.middle += span.base;
  slab.c.radius.array() += 2.0 * kRounding * (span.origin + span.reach);
  bound_frame(span, weights, c, slab);
  return slab;
}

Box bound(const Slab& slab, const AxialRange& range) {
  Vec3 middle = slab.c.middle, radius = slab.c.radius, size = slab.c.middle.cwiseAbs();
  if (slab.framed) {
    for (int k = 0; k < 3; ++k) {
      const Spread& axis = slab.axis[static_cast<std::size_t>(k)];
      const double m = range.middle[k], r = range.radius[k];
      middle += m * axis.middle;
      radius += (std::abs(m) + r) * axis.radius + r * axis.middle.cwiseAbs();
      size += std::abs(m) * axis.middle.cwiseAbs();
    }
  } else {
    // Without a frame: an offset is no longer than its coordinates together, whatever way it points.
    radius.array() += range.reach * (1.0 + 2.0 * kRounding);
  }
  // Fewer than 2^5 roundings of numbers up to `size` and `radius`, each 2^-52 of them at most.
  radius = radius * (1.0 + 0x1p-40) + size * 0x1p-44;
  const Vec3 low = middle - radius, high = middle + radius;
  if (!(high - low).allFinite()) return {Vec3::Constant(-kInfinite), Vec3::Constant(kInfinite)};
  return {low, high};
}

}  // namespace tendril::collision
