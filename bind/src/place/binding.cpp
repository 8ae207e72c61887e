#include <tendril/base/error.h>
#include <tendril/bind/binding.h>

#include <cmath>
#include <string>

#include "layout.h"
#include "mesh/parallel.h"
#include "surface_binder.h"

namespace tendril::bind {
namespace {

constexpr double kLargest = 1e150;  // the projection squares coordinates
constexpr double kInPlane = 3e-16;  // of the points' size: w of a normal projection is rounding, and left out

void check(Points points, int threads) {
  require_threads(threads);
  if (points.size() > 0x7fffffff)
    throw InvalidInput("points", std::to_string(points.size()) + " of them", "fewer than 2^31");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!(points[i].cwiseAbs().maxCoeff() <= kLargest) || !is_finite(points[i]))
      throw InvalidInput("points[" + std::to_string(i) + "]", "not finite, or beyond 1e150",
                         "three finite numbers");
}

/// What is known of the nearest projections while a binding is made.
struct Found {
  std::vector<double> lambda, gap;

  explicit Found(std::size_t points) : lambda(points), gap(points) {}
  void set(std::size_t point, const Projection& nearest) {
    lambda[point] = nearest.lambda;
    gap[point] = nearest.gap;
  }
};

void project(const CurvePair& rest, Points points, int threads, BindingLayout& layout, Found& found) {
  const CurveProjector projector(rest.primary());
  layout.entries.resize(points.size());
  in_parts(points.size(), threads, [&](std::size_t begin, std::size_t end) {
    const std::vector<Projection> nearest = projector.nearest(points.subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      found.set(i, nearest[i - begin]);
      layout.entries[i] = to_axial(rest, nearest[i - begin].t, points[i]);
    }
  });
}

/// The shares of every point in nodes, and the nodes that have some.
void lay_out(std::span<const CurvePair> rest, Points points, const Branches& branches,
             BindingLayout& layout) {
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> number(branches.nodes.size(), kNone);
  for (const auto& influences : branches.influences)
    for (const Influence& one : influences) number[one.node] = 0;
  layout.rest_base = BindingLayout::base_of(rest);
  for (std::size_t k = 0; k < number.size(); ++k) {
    if (number[k] == kNone) continue;
    number[k] = static_cast<std::uint32_t>(layout.nodes.size());
    const Node& at = branches.nodes[k];
    layout.nodes.push_back(layout.make_node(at.pair, at.t, rest[at.pair]));
  }
  for (std::uint32_t i = 0; i < layout.size; ++i) {
    const std::vector<Influence>& influences = branches.influences[i];
    const std::size_t begin = layout.node.size(), end = begin + influences.size();
    if (begin == end) continue;
    if (layout.size + end > 0x7fffffff)
      throw InvalidInput("points", "too many influences", "fewer than 2^31");
    layout.blends.push_back({i, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
    const Vec3 place = points[i] - layout.rest_base;
    layout.numbers.place.push_back({place.x(), place.y(), place.z()});
    for (const Influence& one : influences) {
      layout.node.push_back(number[one.node]);
      layout.numbers.share.push_back(one.weight);
    }
  }
}

void share(std::span<const CurvePair> rest, Points points, Branches branches, const BindOptions& options,
           BindingLayout& layout, Found& found, BindReport& report) {
  if (options.mode == BindMode::nearest)
    for (auto& influences : branches.influences) influences.clear();
  layout.entries.resize(points.size());
  if (rest.size() > 1) layout.pair.resize(points.size());
  in_parts(layout.size, options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Candidate& nearest = branches.nearest[i];
      found.set(i, nearest.at);
      if (!layout.pair.empty()) layout.pair[i] = nearest.pair;
      layout.entries[i] = to_axial(rest[nearest.pair], nearest.at.t, points[i]);
    }
  });
  lay_out(rest, points, branches, layout);
  report.ambiguous = std::move(branches.ambiguous);
  report.gated = std::move(branches.gated);
  report.loose = std::move(branches.loose);
  report.clusters = branches.clusters;
}

void inspect(std::span<const CurvePair> rest, Points points, int threads, const Binding& binding,
             const Found& found, BindReport& report) {
  std::vector<Vec3> again(points.size());
  binding.update(rest, again, threads);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    const double t = binding.records()[i].t;
    const CurvePair& pair = rest[binding.pair_of(i)];
    report.rest_error = std::max(report.rest_error, (again[i] - points[i]).norm());
    report.largest_gap = std::max(report.largest_gap, found.gap[i]);
    const bool at_end = t == pair.knots().start() || t == pair.knots().end();
    if (at_end) ++report.beyond_ends;
    if (!at_end && found.lambda[i] <= 0.0) report.past_focus.push_back(id);
    if (pair.frame(t).status != FrameStatus::ok) report.degenerate.push_back(id);
  }
}

}  // namespace

Binding::Binding(const CurvePair& rest, Points points, int threads) {
  check(points, threads);
  auto layout = std::make_shared<BindingLayout>();
  Found found(points.size());
  layout->size = points.size();
  layout->knots.push_back(rest.knots());
  layout->make_spans();
  project(rest, points, threads, *layout, found);
  layout->arrange(kInPlane * bounding_diagonal(points));
  layout_ = std::move(layout);
  inspect({&rest, 1}, points, threads, *this, found, report_);
  report_.shares = points.size();
}

SurfaceBinder::SurfaceBinder(std::span<const CurvePair> rest, const PolygonMesh& body,
                             const BindOptions& options)
    : rest_(rest), options_(options) {
  check(body.points, options.threads);
  require_valid(body);
  if (rest.empty()) throw InvalidInput("rest", "no curve-pair", "at least one");
  if (!(options.band > 0.0 && options.band <= 1.0))
    throw InvalidInput("band", std::to_string(options.band), "above 0, at most 1");
  negligible_ = kInPlane * bounding_diagonal(body.points);
  for (const CurvePair& pair : rest) projectors_.emplace_back(pair.primary());
  if (rest.size() > 1 || options.mode != BindMode::nearest)
    branches_ = std::make_unique<BodyBranches>(projectors_, body, options.band, options.threads);
}

Binding SurfaceBinder::bind(Points points, std::span<const std::uint32_t> face) const {
  Binding out;
  auto layout = std::make_shared<BindingLayout>();
  Found found(points.size());
  layout->size = points.size();
  for (const CurvePair& pair : rest_) layout->knots.push_back(pair.knots());
  layout->make_spans();
  if (branches_)
    share(rest_, points, branches_->find(points, face, options_.threads), options_, *layout, found,
          out.report_);
  else
    project(rest_[0], points, options_.threads, *layout, found);
  layout->arrange(negligible_);
  out.layout_ = std::move(layout);
  inspect(rest_, points, options_.threads, out, found, out.report_);
  out.report_.shares = points.size() + out.layout_->node.size();
  return out;
}

Binding::Binding(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& options)
    : Binding(SurfaceBinder(rest, mesh, options).bind(mesh.points, {})) {}

std::size_t Binding::size() const {
  return layout_->size;
}

std::size_t Binding::pair_count() const {
  return layout_->knots.size();
}

std::span<const AxialPoint> Binding::records() const {
  return {layout_->entries.data(), layout_->size};
}

std::uint32_t Binding::pair_of(std::size_t point) const {
  return layout_->pair_of(point);
}

std::span<const std::uint32_t> Binding::order() const {
  return layout_->nearest.entry;
}

std::vector<Share> Binding::shares(std::size_t point) const {
  layout_->require_point(point);
  std::vector<Share> result{{pair_of(point), 1.0, records()[point]}};
  const BindingLayout::Blend* blend = layout_->blend_of(point);
  if (!blend) return result;
  for (std::size_t k = blend->begin; k < blend->end; ++k) {
    const double weight = layout_->numbers.share[k];
    result.push_back({layout_->nodes[layout_->node[k]].pair, weight, layout_->record(*blend, k)});
    result.front().weight -= weight;
  }
  return result;
}

}  // namespace tendril::bind
