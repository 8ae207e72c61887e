#include <tendril/base/error.h>
#include <tendril/bind/binding.h>

#include <cmath>
#include <string>

#include "branches.h"
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
  std::size_t order;
  Points control;
  std::vector<Vec3> offset;
};

Binding::Binding(const CurvePair& rest, Points points, int threads)
    : knots_{rest.knots()}, size_(points.size()) {
  check(points, threads);
  reserve(points.size());
  project(rest, points, threads);
  inspect({&rest, 1}, points, threads);
}

Binding::Binding(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& options)
    : size_(mesh.points.size()) {
  check(mesh.points, options.threads);
  require_valid(mesh);
  if (rest.empty()) throw InvalidInput("rest", "no curve-pair", "at least one");
  if (!(options.band > 0.0 && options.band <= 1.0))
    throw InvalidInput("band", std::to_string(options.band), "above 0, at most 1");
  for (const CurvePair& pair : rest) knots_.push_back(pair.knots());
  if (rest.size() == 1 && options.mode == BindMode::nearest) {
    reserve(size_);
    project(rest[0], mesh.points, options.threads);
  } else {
    share(rest, mesh, options);
  }
  inspect(rest, mesh.points, options.threads);
}

void Binding::reserve(std::size_t entries) {
  row_ = 0;
  for (const KnotVector& knots : knots_)
    row_ = std::max(row_, 2 * (static_cast<std::size_t>(knots.degree()) + 1));
  records_.resize(entries);
  first_.resize(entries);
  weights_.resize(entries * row_);
  lambda_.resize(size_);
  gap_.resize(size_);
}

void Binding::set(std::size_t entry, const CurvePair& pair, double t, const Vec3& point) {
  records_[entry] = to_axial(pair, t, point);
  const Basis basis = pair.knots().basis(t, 1);
  first_[entry] = basis.first;
  double* row = weights_.data() + entry * row_;
  const std::size_t order = static_cast<std::size_t>(pair.knots().degree()) + 1;
  for (std::size_t j = 0; j < order; ++j) {
    row[j] = basis.value[0][j];
    row[order + j] = basis.value[1][j];
  }
}

void Binding::project(const CurvePair& rest, Points points, int threads) {
  const CurveProjector projector(rest.primary());
  in_parts(points.size(), threads, [&](std::size_t begin, std::size_t end) {
    double hint = 0.5 * (knots_[0].start() + knots_[0].end());
    for (std::size_t i = begin; i < end; ++i) {
      const Projection nearest = projector.nearest(points[i], hint);
      hint = nearest.t;
      lambda_[i] = nearest.lambda;
      gap_[i] = nearest.gap;
      set(i, rest, nearest.t, points[i]);
    }
  });
  report_.places = points.size();
}

void Binding::share(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& options) {
  std::vector<CurveProjector> projectors;
  for (const CurvePair& pair : rest) projectors.emplace_back(pair.primary());
  Branches branches = find_branches(projectors, mesh, options.band, options.threads);
  std::size_t entries = size_;
  for (std::uint32_t i = 0; i < size_; ++i) {
    if (options.mode == BindMode::nearest) branches.influences[i].clear();
    const std::size_t others = branches.influences[i].size();
    if (others == 0) continue;
    if (entries + others > 0x7fffffff) throw InvalidInput("points", "too many influences", "fewer than 2^31");
    blended_.push_back(i);
    blends_.push_back({static_cast<std::uint32_t>(entries), static_cast<std::uint32_t>(entries + others)});
    entries += others;
  }
  reserve(entries);
  shares_.resize(entries - size_);
  if (rest.size() > 1) pair_.resize(entries);
  const auto enter = [&](std::size_t entry, std::uint32_t pair, double t, std::size_t point) {
    if (!pair_.empty()) pair_[entry] = pair;
    set(entry, rest[pair], t, mesh.points[point]);
  };
  in_parts(size_, options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Candidate& nearest = branches.nearest[i];
      lambda_[i] = nearest.at.lambda;
      gap_[i] = nearest.at.gap;
      enter(i, nearest.pair, nearest.at.t, i);
    }
  });
  in_parts(blended_.size(), options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t entry = blends_[b].begin; entry < blends_[b].end; ++entry) {
        const Influence& one = branches.influences[blended_[b]][entry - blends_[b].begin];
        enter(entry, one.pair, one.t, blended_[b]);
        shares_[entry - size_] = one.weight;
      }
  });
  report_.ambiguous = std::move(branches.ambiguous);
  report_.gated = std::move(branches.gated);
  report_.clusters = branches.clusters;
  report_.places = entries;
}

void Binding::inspect(std::span<const CurvePair> rest, Points points, int threads) {
  std::vector<Vec3> again(points.size());
  update(rest, again, threads);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    const double t = records_[i].t;
    const CurvePair& pair = rest[pair_of(i)];
    report_.rest_error = std::max(report_.rest_error, (again[i] - points[i]).norm());
    report_.largest_gap = std::max(report_.largest_gap, gap_[i]);
    const bool at_end = t == pair.knots().start() || t == pair.knots().end();
    if (at_end) ++report_.beyond_ends;
    if (!at_end && lambda_[i] <= 0.0) report_.past_focus.push_back(id);
    if (pair.frame(t).status != FrameStatus::ok) report_.degenerate.push_back(id);
  }
  lambda_ = {};
  gap_ = {};
}

std::vector<Binding::Posed> Binding::pose(std::span<const CurvePair> posed) const {
  if (posed.size() != knots_.size())
    throw InvalidInput("posed", std::to_string(posed.size()) + " curve-pairs", std::to_string(knots_.size()));
  std::vector<Posed> result;
  for (std::size_t k = 0; k < posed.size(); ++k) {
    if (posed[k].knots() != knots_[k])
      throw InvalidInput("posed curve-pair", "other knots", "those it was bound with");
    result.push_back({posed[k],
                      static_cast<std::size_t>(knots_[k].degree()) + 1,
                      posed[k].primary().control_points(),
                      {}});
    for (std::size_t i = 0; i < result[k].control.size(); ++i)
      result[k].offset.push_back(posed[k].orientation().control_points()[i] - result[k].control[i]);
  }
  return result;
}

Vec3 Binding::evaluate(const Posed& posed, std::size_t entry) const {
  const std::size_t order = posed.order;
  const double* row = weights_.data() + entry * row_;
  const Vec3* u = posed.control.data() + first_[entry];
  const Vec3* d = posed.offset.data() + first_[entry];
  Vec3 origin = row[0] * u[0];
  Vec3 offset = row[0] * d[0];
  Vec3 z = row[order] * u[0];
  for (std::size_t j = 1; j < order; ++j) {
    origin += row[j] * u[j];
    offset += row[j] * d[j];
    z += row[order + j] * u[j];
  }
  const AxialPoint& at = records_[entry];
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

/// The nearest projection's point and the weighted differences to it: at rest these vanish, whatever rounding
/// the weights have.
Vec3 Binding::blend(std::span<const Posed> posed, std::size_t blended) const {
  const std::size_t point = blended_[blended];
  const Vec3 base = evaluate(posed[pair_of(point)], point);
  Vec3 sum = base;
  for (std::size_t entry = blends_[blended].begin; entry < blends_[blended].end; ++entry)
    sum += shares_[entry - size_] * (evaluate(posed[pair_of(entry)], entry) - base);
  return sum;
}

void Binding::update(std::span<const CurvePair> posed, MutablePoints out, int threads) const {
  if (out.size() != size())
    throw InvalidInput("out", std::to_string(out.size()) + " points", std::to_string(size()));
  if (threads < 1 || threads > 256) throw InvalidInput("threads", std::to_string(threads), "1 to 256");
  const std::vector<Posed> ready = pose(posed);
  in_parts(size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = evaluate(ready[pair_of(i)], i);
  });
  in_parts(blended_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) out[blended_[b]] = blend(ready, b);
  });
}

void Binding::update(const CurvePair& posed, MutablePoints out, int threads) const {
  update({&posed, 1}, out, threads);
}

Vec3 Binding::at(std::span<const CurvePair> posed, std::size_t point) const {
  if (point >= size())
    throw InvalidInput("point", std::to_string(point), "less than " + std::to_string(size()));
  const std::vector<Posed> ready = pose(posed);
  const auto found = std::lower_bound(blended_.begin(), blended_.end(), point);
  if (found != blended_.end() && *found == point)
    return blend(ready, static_cast<std::size_t>(found - blended_.begin()));
  return evaluate(ready[pair_of(point)], point);
}

Vec3 Binding::at(const CurvePair& posed, std::size_t point) const {
  return at({&posed, 1}, point);
}

std::vector<Share> Binding::shares(std::size_t point) const {
  if (point >= size())
    throw InvalidInput("point", std::to_string(point), "less than " + std::to_string(size()));
  std::vector<Share> result{{pair_of(point), 1.0, records_[point]}};
  const auto found = std::lower_bound(blended_.begin(), blended_.end(), point);
  if (found == blended_.end() || *found != point) return result;
  const Blend& blend = blends_[static_cast<std::size_t>(found - blended_.begin())];
  for (std::size_t entry = blend.begin; entry < blend.end; ++entry) {
    result.push_back({pair_of(entry), shares_[entry - size_], records_[entry]});
    result.front().weight -= shares_[entry - size_];
  }
  return result;
}

}  // namespace tendril::bind
