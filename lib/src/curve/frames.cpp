#include <tendril/base/error.h>
#include <tendril/curve/frames.h>

#include <cmath>
#include <string>

namespace tendril {
namespace {

constexpr double kParallel = 1e-12;  // sine of the angle below which two directions count as parallel

Vec3 least_aligned_axis(const Vec3& z) {
  Eigen::Index axis = 0;
  z.cwiseAbs().minCoeff(&axis);
  return Vec3::Unit(axis);
}

/// Unit direction, or zero for a vector of length 0. Safe from overflow and underflow.
Vec3 direction(const Vec3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return Vec3::Zero();
  const Vec3 scaled = v / largest;
  return scaled / scaled.norm();
}

}  // namespace

FrameChoice frame_towards(const Vec3& z, const Vec3& offset) {
  const Vec3 n = direction(offset);
  Vec3 x = n.cross(z);
  const double sine = x.norm();
  FrameStatus status = FrameStatus::ok;
  if (!(sine > kParallel)) {
    status = n.isZero(0.0) ? FrameStatus::zero_offset : FrameStatus::offset_along_tangent;
    x = least_aligned_axis(z).cross(z);
  }
  x.normalize();
  return {Frame{x, z.cross(x), z}, status, sine};
}

/// The smallest rotation from a to b (unit vectors) is the mirroring in the plane across a followed by that
/// across a + b, as a turns into -a and then into b: v - 2 a (a.v), and then, with s = a + b, v - s (2 s.v /
/// s^2) + 2 (a.v) b, since mirroring -a in the plane across s gives b. No angle, no axis, and no loss of
/// digits but where b nears -a, where the axis is free.
Vec3 rotate_smallest(const Vec3& from, const Vec3& to, const Vec3& v) {
  const Vec3 sum = from + to;
  const double square = sum.squaredNorm();  // 2 (1 + a.b) without its cancellation near a half turn
  if (square < 1e-28) {
    const Vec3 axis = from.cross(least_aligned_axis(from)).normalized();
    return 2.0 * axis.dot(v) * axis - v;
  }
  return v - sum * (2.0 * sum.dot(v) / square) + 2.0 * from.dot(v) * to;
}

Vec3 rotate_about(const Vec3& axis, double angle, const Vec3& v) {
  const double c = std::cos(angle);
  return c * v + std::sin(angle) * axis.cross(v) + (1.0 - c) * axis.dot(v) * axis;
}

PolygonTangents polygon_tangents(Points p) {
  if (p.size() < 2) throw InvalidInput("polygon", std::to_string(p.size()) + " points", "at least 2");
  const std::size_t n = p.size();
  PolygonTangents result{std::vector<Vec3>(n), std::vector<FrameStatus>(n, FrameStatus::ok)};
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 before = i > 0 ? direction(p[i] - p[i - 1]) : Vec3::Zero();
    const Vec3 after = i + 1 < n ? direction(p[i + 1] - p[i]) : Vec3::Zero();
    const bool degenerate = (i > 0 && before.isZero(0.0)) || (i + 1 < n && after.isZero(0.0));
    Vec3 t = before + after;
    if (degenerate) {
      result.status[i] = FrameStatus::zero_edge;
      if (t.isZero(0.0)) t = i > 0 ? result.t[i - 1] : Vec3(Vec3::UnitZ());
    } else if (i > 0 && i + 1 < n && t.norm() < kParallel) {
      result.status[i] = FrameStatus::fold_back;
      t = before;
    }
    result.t[i] = t.normalized();
  }
  return result;
}

NodeFrames node_frames(Points p, Points q) {
  if (p.size() != q.size())
    throw InvalidInput("orientation points", std::to_string(q.size()) + " of them", std::to_string(p.size()));
  PolygonTangents tangents = polygon_tangents(p);
  NodeFrames result{{}, std::move(tangents.status)};
  for (std::size_t i = 0; i < p.size(); ++i) {
    const FrameChoice choice = frame_towards(tangents.t[i], q[i] - p[i]);
    result.frame.push_back(choice.frame);
    if (result.status[i] == FrameStatus::ok) result.status[i] = choice.status;
  }
  return result;
}

}  // namespace tendril
