#include <tendril/base/error.h>
#include <tendril/bind/binding.h>

#include <cmath>
#include <string>

#include "parallel.h"

namespace tendril::bind {
namespace {

constexpr double kLargest = 1e150;  // the projection squares coordinates

void check(Points points, int threads) {
  if (threads < 1 || threads > 256) throw InvalidInput("threads", std::to_string(threads), "1 to 256");
  if (points.size() > 0x7fffffff)
    throw InvalidInput("points", std::to_string(points.size()) + " of them", "fewer than 2^31");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!(points[i].cwiseAbs().maxCoeff() <= kLargest) || !is_finite(points[i]))
      throw InvalidInput("points[" + std::to_string(i) + "]", "not finite, or beyond 1e150",
                         "three finite numbers");
}

}  // namespace

/// A posed curve-pair as an update reads it: control points, and offsets to the orientation's.
struct Binding::Posed {
  const CurvePair& pair;
  Points control;
  std::vector<Vec3> offset;
};

Binding::Binding(const CurvePair& rest, Points points, int threads) : knots_(rest.knots()) {
  check(points, threads);
  const std::size_t order = static_cast<std::size_t>(knots_.degree()) + 1;
  records_.resize(points.size());
  first_.resize(points.size());
  weights_.resize(points.size() * 2 * order);
  lambda_.resize(points.size());
  gap_.resize(points.size());
  project(rest, points, threads);
  inspect(rest, points, threads);
}

void Binding::project(const CurvePair& rest, Points points, int threads) {
  const CurveProjector projector(rest.primary());
  const std::size_t order = static_cast<std::size_t>(knots_.degree()) + 1;
  in_parts(points.size(), threads, [&](std::size_t begin, std::size_t end) {
    double hint = 0.5 * (knots_.start() + knots_.end());
    for (std::size_t i = begin; i < end; ++i) {
      const Projection nearest = projector.nearest(points[i], hint);
      hint = nearest.t;
      lambda_[i] = nearest.lambda;
      gap_[i] = nearest.gap;
      records_[i] = to_axial(rest, nearest.t, points[i]);
      const Basis basis = knots_.basis(nearest.t, 1);
      first_[i] = basis.first;
      double* row = weights_.data() + i * 2 * order;
      for (std::size_t j = 0; j < order; ++j) {
        row[j] = basis.value[0][j];
        row[order + j] = basis.value[1][j];
      }
    }
  });
}

void Binding::inspect(const CurvePair& rest, Points points, int threads) {
  std::vector<Vec3> again(points.size());
  update(rest, again, threads);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    const double t = records_[i].t;
    report_.rest_error = std::max(report_.rest_error, (again[i] - points[i]).norm());
    report_.largest_gap = std::max(report_.largest_gap, gap_[i]);
    const bool at_end = t == knots_.start() || t == knots_.end();
    if (at_end) ++report_.beyond_ends;
    if (!at_end && lambda_[i] <= 0.0) report_.past_focus.push_back(id);
    if (rest.frame(t).status != FrameStatus::ok) report_.degenerate.push_back(id);
  }
  lambda_ = {};
  gap_ = {};
}

Binding::Posed Binding::pose(const CurvePair& posed) const {
  if (posed.knots() != knots_)
    throw InvalidInput("posed curve-pair", "other knots", "those it was bound with");
  Posed result{posed, posed.primary().control_points(), {}};
  for (std::size_t i = 0; i < result.control.size(); ++i)
    result.offset.push_back(posed.orientation().control_points()[i] - result.control[i]);
  return result;
}

Vec3 Binding::evaluate(const Posed& posed, std::size_t point) const {
  const std::size_t order = static_cast<std::size_t>(knots_.degree()) + 1;
  const double* row = weights_.data() + point * 2 * order;
  const Vec3* u = posed.control.data() + first_[point];
  const Vec3* d = posed.offset.data() + first_[point];
  Vec3 origin = row[0] * u[0];
  Vec3 offset = row[0] * d[0];
  Vec3 z = row[order] * u[0];
  for (std::size_t j = 1; j < order; ++j) {
    origin += row[j] * u[j];
    offset += row[j] * d[j];
    z += row[order + j] * u[j];
  }
  const AxialPoint& at = records_[point];
  Vec3 x = offset.cross(z);
  const double speed = z.norm();
  const double sine = x.norm();
  // Well inside where the frame exists; elsewhere the curve-pair's own rules decide.
  if (!(sine > 1e-8 * speed * offset.norm()) || !(speed > 1e-8 * posed.pair.scale_of_speed()))
    return from_axial(posed.pair, at);
  z /= speed;
  x /= sine;
  return origin + at.u * x + at.v * z.cross(x) + at.w * z;
}

void Binding::update(const CurvePair& posed, MutablePoints out, int threads) const {
  if (out.size() != size())
    throw InvalidInput("out", std::to_string(out.size()) + " points", std::to_string(size()));
  if (threads < 1 || threads > 256) throw InvalidInput("threads", std::to_string(threads), "1 to 256");
  const Posed ready = pose(posed);
  in_parts(size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = evaluate(ready, i);
  });
}

Vec3 Binding::at(const CurvePair& posed, std::size_t point) const {
  if (point >= size())
    throw InvalidInput("point", std::to_string(point), "less than " + std::to_string(size()));
  return evaluate(pose(posed), point);
}

}  // namespace tendril::bind
