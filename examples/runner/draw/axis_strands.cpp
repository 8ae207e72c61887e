#include "draw/drawing.h"

namespace tendril::runner {
namespace {

constexpr int kPerSpan = 12;

std::vector<Vec3> along(const BSpline& curve) {
  std::vector<Vec3> out{curve.value(curve.knots().start())};
  const auto knots = curve.knots().knots();
  for (const int span : curve.knots().nonempty_spans()) {
    const double begin = knots[static_cast<std::size_t>(span)],
                 end = knots[static_cast<std::size_t>(span) + 1];
    for (int k = 1; k <= kPerSpan; ++k) out.push_back(curve.value(begin + (end - begin) * k / kPerSpan));
  }
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

}  // namespace tendril::runner
