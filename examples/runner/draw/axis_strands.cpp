#include "draw/drawing.h"

#include <algorithm>

namespace tendril::runner {
namespace {

constexpr int kPerSpan = 12;

std::vector<double> spread_along(const KnotVector& knots) {
  std::vector<double> out{knots.start()};
  for (const int span : knots.nonempty_spans()) {
    const double begin = knots.knots()[static_cast<std::size_t>(span)];
    const double end = knots.knots()[static_cast<std::size_t>(span) + 1];
    for (int k = 1; k <= kPerSpan; ++k) out.push_back(begin + (end - begin) * k / kPerSpan);
  }
  return out;
}

std::vector<Vec3> along(const BSpline& curve) {
  std::vector<Vec3> out;
  for (const double t : spread_along(curve.knots())) out.push_back(curve.value(t));
  return out;
}

}  // namespace

std::vector<Strand> axis_strands(const CurvePair& pair, Points masses, double radius) {
  const Vec3f red(0.62F, 0.05F, 0.03F), blue(0.03F, 0.16F, 0.55F), dark(0.06F, 0.05F, 0.05F);
  std::vector<Strand> out;
  out.push_back({Strand::Kind::tube, along(pair.primary()), radius, red});
  out.push_back({Strand::Kind::tube, along(pair.orientation()), 0.6 * radius, blue});
  if (!masses.empty()) {
    out.push_back({Strand::Kind::balls, {masses.begin(), masses.end()}, 2.0 * radius, dark});
  }
  return out;
}

void name_axis(Picture& picture, const Camera& camera, const CurvePair& pair, const std::string& name) {
  const double middle = 0.5 * (pair.knots().start() + pair.knots().end());
  const auto at = camera.place(pair.primary().value(middle));
  if (!at) return;
  const int scale = std::max(1, picture.height / 360);
  const auto pixel = [](double part, int size) { return static_cast<int>(0.5 * (1.0 + part) * size); };
  draw_text(picture, name, pixel((*at)[0], picture.width) + 4 * scale, pixel(-(*at)[1], picture.height),
            scale);
}

Strand rod_strand(const CurvePair& pair, std::span<const double> parameters, std::span<const double> widths,
                  double least) {
  Strand out{Strand::Kind::tube, along(pair.primary()), least, Vec3f(0.40F, 0.30F, 0.22F)};
  std::vector<double> at_node{widths.front()};
  for (std::size_t i = 1; i < widths.size(); ++i) at_node.push_back(0.5 * (widths[i - 1] + widths[i]));
  at_node.push_back(widths.back());
  for (const double t : spread_along(pair.knots())) {
    const auto after = std::upper_bound(parameters.begin() + 1, parameters.end() - 1, t);
    const auto k = static_cast<std::size_t>(after - parameters.begin());
    const double part = (t - parameters[k - 1]) / (parameters[k] - parameters[k - 1]);
    out.radii.push_back(std::max(least, 0.5 * ((1.0 - part) * at_node[k - 1] + part * at_node[k])));
  }
  return out;
}

}  // namespace tendril::runner
