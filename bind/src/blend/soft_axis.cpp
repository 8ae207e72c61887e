#include "soft_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tendril::bind {
namespace {

constexpr int kNodesPerSpan = 2;
constexpr std::size_t kBlock = 8;        ///< samples
constexpr double kSamplesPerSide = 6.0;  ///< at least 1.4 times these beside a minimum on a straight line
constexpr double kFaint = 1e-3;          ///< weight that fades to nothing

/// Interval of an ascending list that holds t, and the share of it before t.
struct Bracket {
  std::size_t right;
  double part;
};

Bracket bracket(const std::vector<double>& list, double t) {
  const auto found = std::upper_bound(list.begin(), list.end(), t) - list.begin();
  const auto right = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(found, 1, static_cast<std::ptrdiff_t>(list.size()) - 1));
  return {right, (t - list[right - 1]) / (list[right] - list[right - 1])};
}

/// Samples of a span: 16, or fewer where the curve has some hundreds all the same.
int samples_per_span(std::size_t spans) {
  constexpr std::size_t kEnough = 300;
  return spans * 4 >= kEnough ? 4 : spans * 8 >= kEnough ? 8 : 16;
}

double largest_speed(const BSpline& curve) {
  double speed = 0.0;
  for (const BezierPiece& piece : curve.bezier_pieces())
    for (std::size_t j = 1; j < piece.points.size(); ++j)
      speed = std::max(
          speed, curve.degree() * (piece.points[j] - piece.points[j - 1]).norm() / (piece.end - piece.begin));
  return speed;
}

Vec3 tangent(const BSpline& curve, double t) {
  const Vec3 d1 = curve.derivative(t);
  const double speed = d1.norm();
  return speed > 0.0 ? Vec3(d1 / speed) : Vec3(Vec3::Zero());
}

/// Vector of the curvature; 0 where the speed is 0.
Vec3 curvature(const BSpline& curve, double t) {
  const Vec3 along = tangent(curve, t), d2 = curve.derivative(t, 2);
  const double speed2 = curve.derivative(t).squaredNorm();
  return speed2 > 0.0 ? Vec3((d2 - d2.dot(along) * along) / speed2) : Vec3(Vec3::Zero());
}

/// Weights that sum to 1; small ones fade out instead of being cut off.
std::vector<Influence> normalized(std::vector<Influence> all, double sum) {
  for (Influence& one : all) one.weight = std::max(0.0, one.weight / sum - kFaint);
  std::erase_if(all, [](const Influence& one) { return !(one.weight > 0.0); });
  double rest = 0.0;
  for (const Influence& one : all) rest += one.weight;
  for (Influence& one : all) one.weight /= rest;
  return all;
}

}  // namespace

SoftAxis::SoftAxis(std::span<const CurveProjector> projectors, double band) : band_(band) {
  std::uint32_t first_node = 0;
  for (const CurveProjector& projector : projectors) {
    const BSpline& curve = projector.curve();
    Curve one{&curve, largest_speed(curve), {}, first_node, {}, {}, {}, {}, {}, 0.0, {}, {}};
    const std::vector<BezierPiece> pieces = curve.bezier_pieces();
    const int per_span = samples_per_span(pieces.size());
    const auto sample = [&](double t) {
      const Vec3 point = curve.value(t);
      const double step = one.points.empty() ? 0.0 : (point - one.points.back()).norm();
      one.spacing = std::max(one.spacing, step);
      one.lengths.push_back(one.points.empty() ? 0.0 : one.lengths.back() + step);
      one.parameters.push_back(t);
      one.points.push_back(point);
      one.tangents.push_back(tangent(curve, t));
      one.curvatures.push_back(curvature(curve, t));
      if (one.points.size() % static_cast<std::size_t>(per_span / kNodesPerSpan) == 1) one.nodes.push_back(t);
    };
    sample(curve.knots().start());
    for (const BezierPiece& piece : pieces) {
      one.polynomials.push_back(polynomial(piece));
      for (int k = 1; k <= per_span; ++k)
        sample(k == per_span ? piece.end : piece.begin + (piece.end - piece.begin) * k / per_span);
    }
    one.blocks = blocks_of(one);
    first_node += static_cast<std::uint32_t>(one.nodes.size());
    curves_.push_back(std::move(one));
  }
}

/// c_j = (p over j) sum_i (-1)^(j - i) (j over i) (b_i - b_0) for j > 0: the differences j times over.
SoftAxis::Polynomial SoftAxis::polynomial(const BezierPiece& piece) {
  std::vector<Vec3> c(piece.points.begin(), piece.points.end());
  for (std::size_t j = 1; j < c.size(); ++j)
    for (std::size_t i = c.size(); i-- > j;) c[i] -= c[i - 1];
  double choices = 1.0;
  for (std::size_t j = 1; j < c.size(); ++j) {
    choices *= static_cast<double>(c.size() - j) / static_cast<double>(j);
    c[j] *= choices;
  }
  return {piece.begin, piece.end, std::move(c)};
}

Vec3 SoftAxis::Polynomial::value(double t) const {
  const double s = (t - begin) / (end - begin);
  Vec3 sum = c.back();
  for (std::size_t j = c.size() - 1; j-- > 0;) sum = c[j] + s * sum;
  return sum;
}

/// Neighbouring blocks have a sample in common, so that each pair of consecutive ones is in a block.
std::vector<SoftAxis::Block> SoftAxis::blocks_of(const Curve& curve) {
  const std::vector<Vec3>& points = curve.points;
  std::vector<Block> out;
  for (std::size_t first = 0; first + 1 < points.size(); first += kBlock) {
    const std::size_t last = std::min(first + kBlock, points.size() - 1);
    const Vec3& along = curve.tangents[(first + last) / 2];
    Block block{0.5 * (points[first] + points[last]), 0.0, first, last, along, 0.0, 0.0};
    for (std::size_t k = first; k <= last; ++k) {
      block.radius = std::max(block.radius, (points[k] - block.centre).norm());
      block.spread = std::max(block.spread, (curve.tangents[k] - along).norm());
      block.curvature = std::max(block.curvature, curve.curvatures[k].norm());
    }
    block.radius *= 1.0 + kRoom;
    out.push_back(block);
  }
  return out;
}

/// Samples at multiples of a step that is a power of two, so that they do not move with p, marching both ways
/// from each minimum to where the weight ends.
std::vector<SoftAxis::Sample> SoftAxis::samples(const Site& site, std::uint32_t pair, double step) const {
  const Curve& curve = curves_[pair];
  std::vector<double> minima;
  for (const Candidate& c : site.all)
    if (c.pair == pair && c.open) minima.push_back(c.at.t);
  std::sort(minima.begin(), minima.end());
  const double nearest = site.nearest().at.distance,
               factor2 = site.curves[pair].factor * site.curves[pair].factor;
  const double room = this->room(site);
  const double start = curve.curve->knots().start(), end = curve.curve->knots().end();
  std::vector<Sample> out;
  const Polynomial* piece = curve.polynomials.data();
  const auto sample = [&](double index) {
    const double t = std::clamp(index * step, start, end);
    while (t > piece->end && piece + 1 != curve.polynomials.data() + curve.polynomials.size()) ++piece;
    while (t < piece->begin && piece != curve.polynomials.data()) --piece;
    const Vec3 c = piece->value(t);
    return Sample{t, (factor2 * (c - site.p).squaredNorm() - nearest * nearest) / room, c};
  };
  double done = std::floor(start / step) - 1.0;
  const double last = std::ceil(end / step);
  for (const double t : minima) {
    const double from = std::floor(t / step);
    if (from < done) continue;
    std::vector<Sample> back;
    for (double k = from; k > done && k * step > start - step; --k) {
      back.push_back(sample(k));
      if (back.back().excess >= 1.0) break;
    }
    out.insert(out.end(), back.rbegin(), back.rend());
    for (done = from + 1.0; done <= last; ++done) {
      out.push_back(sample(done));
      if (out.back().excess >= 1.0) break;
    }
  }
  raise_behind_maxima(minima, out);
  return out;
}

/// Samples separated from every open minimum by a maximum of the distance count as if they were as far as the
/// maximum: those around a closed minimum get their weight gradually, not at once when the maximum falls
/// below the reach.
void SoftAxis::raise_behind_maxima(std::span<const double> minima, std::vector<Sample>& along) {
  std::vector<double> ahead(along.size());
  double most = std::numeric_limits<double>::infinity();
  auto next = minima.begin();
  for (std::size_t k = 0; k < along.size(); ++k) {
    if (next != minima.end() && *next <= along[k].t) most = 0.0;
    while (next != minima.end() && *next <= along[k].t) ++next;
    ahead[k] = most = std::max(most, along[k].excess);
  }
  most = std::numeric_limits<double>::infinity();
  auto last = minima.rbegin();
  for (std::size_t k = along.size(); k-- > 0;) {
    if (last != minima.rend() && *last >= along[k].t) most = 0.0;
    while (last != minima.rend() && *last >= along[k].t) ++last;
    most = std::max(most, along[k].excess);
    along[k].excess = std::min(ahead[k], most);
  }
}

void SoftAxis::distribute(const Curve& curve, std::span<const Sample> along, double part,
                          std::vector<double>& weight) {
  if (along.empty()) return;
  std::size_t right = bracket(curve.nodes, along.front().t).right;
  for (std::size_t k = 0; k < along.size(); ++k) {
    if (along[k].excess >= 1.0) continue;
    const Vec3& before = along[k > 0 ? k - 1 : k].point;
    const Vec3& after = along[k + 1 < along.size() ? k + 1 : k].point;
    const double rest = 1.0 - std::max(0.0, along[k].excess);
    const double w = part * rest * rest * rest * (after - before).norm();
    while (right + 1 < curve.nodes.size() && curve.nodes[right] <= along[k].t) ++right;
    const double share =
        (along[k].t - curve.nodes[right - 1]) / (curve.nodes[right] - curve.nodes[right - 1]);
    weight[right - 1] += (1.0 - share) * w;
    weight[right] += share * w;
  }
}

Vec3 SoftAxis::value(std::uint32_t pair, double t) const {
  const std::vector<Polynomial>& all = curves_[pair].polynomials;
  const auto after = std::upper_bound(all.begin() + 1, all.end(), t,
                                      [](double at, const Polynomial& p) { return at < p.begin; });
  return std::prev(after)->value(t);
}

std::vector<Node> SoftAxis::nodes() const {
  std::vector<Node> out;
  for (std::uint32_t pair = 0; pair < curves_.size(); ++pair)
    for (const double t : curves_[pair].nodes) out.push_back({pair, t});
  return out;
}

std::vector<Influence> SoftAxis::influences(const Site& site) const {
  std::vector<Influence> out;
  std::vector<double> weight;
  double sum = 0.0;
  for (std::uint32_t pair = 0; pair < curves_.size(); ++pair) {
    if (std::none_of(site.all.begin(), site.all.end(), [&](const Candidate& c) { return c.pair == pair; }))
      continue;
    const Curve& curve = curves_[pair];
    const double length = curve.curve->knots().end() - curve.curve->knots().start();
    const double wanted = std::sqrt(room(site)) / (kSamplesPerSide * curve.speed);
    const double level = std::log2(std::max(wanted, 1e-6 * length)), whole = std::floor(level);
    const double step = std::exp2(whole), coarse = level - whole;
    weight.assign(curve.nodes.size(), 0.0);
    distribute(curve, samples(site, pair, step), coarse, weight);
    distribute(curve, samples(site, pair, 0.5 * step), 1.0 - coarse, weight);
    for (std::size_t k = 0; k < weight.size(); ++k) {
      sum += weight[k];
      if (weight[k] > 0.0)
        out.push_back({curves_[pair].first_node + static_cast<std::uint32_t>(k), weight[k]});
    }
  }
  return sum > 0.0 ? normalized(std::move(out), sum) : out;
}

double SoftAxis::Curve::length(double t) const {
  const Bracket at = bracket(parameters, t);
  return lengths[at.right - 1] + at.part * (lengths[at.right] - lengths[at.right - 1]);
}

}  // namespace tendril::bind
