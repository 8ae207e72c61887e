#include <tendril/base/error.h>
#include <tendril/curve/frame_jump.h>
#include <tendril/dynamics/rod.h>

#include <cmath>
#include <string>

namespace tendril {
namespace {

constexpr double kFolds = -0.8;  ///< cosine of the tangents of neighbours beyond which a chain folds

void check_positive(const char* what, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InvalidInput(what, std::to_string(value), "a positive number");
}

void check_chain(const std::vector<Vec3>& p, const std::vector<Vec3>& q) {
  if (p.size() < 2) throw InvalidInput("points", std::to_string(p.size()) + " of them", "at least 2");
  if (q.size() != p.size())
    throw InvalidInput("orientation points", std::to_string(q.size()) + " of them", std::to_string(p.size()));
}

std::vector<double> edge_lengths(const std::vector<Vec3>& p) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    lengths.push_back((p[i + 1] - p[i]).stableNorm());
    if (!(lengths.back() > 0.0) || !std::isfinite(lengths.back()))
      throw InvalidInput("points[" + std::to_string(i + 1) + "]",
                         "edge of length " + std::to_string(lengths.back()), "distinct, finite neighbours");
  }
  return lengths;
}

}  // namespace

Rod make_rod(const std::vector<Vec3>& p, const std::vector<Vec3>& q, const Material& material,
             const Section& section) {
  check_chain(p, q);
  check_positive("young", material.young);
  check_positive("shear", material.shear);
  check_positive("density", material.density);
  const std::vector<double> length = edge_lengths(p);
  const std::size_t n = p.size();
  Rod rod;
  rod.p = p;
  rod.q = q;
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? length[i - 1] : 0.0;
    const double after = i + 1 < n ? length[i] : 0.0;
    const double half_sum = 0.5 * (before + after);
    const double mean = i == 0 || i + 1 == n ? before + after : half_sum;
    rod.mass.push_back(material.density * section.area * half_sum);
    rod.inertia.push_back(material.density * section.polar * half_sum);
    rod.bend_l.push_back(2 * material.young * section.bending1 / mean);
    rod.bend_m.push_back(2 * material.young * section.bending2 / mean);
    rod.bend_t.push_back(0.0);
  }
  for (const double l : length) {
    rod.stretch.push_back(material.young * section.area / l);
    rod.twist.push_back(material.shear * section.torsion / l);
    rod.width.push_back(section.width);
  }
  return rod;
}

Rod make_rod(const std::vector<Vec3>& p, const std::vector<Vec3>& q, const SpringConstants& springs) {
  check_chain(p, q);
  edge_lengths(p);
  const std::size_t n = p.size();
  Rod rod;
  rod.p = p;
  rod.q = q;
  rod.mass.assign(n, springs.mass);
  rod.inertia.assign(n, springs.inertia);
  rod.bend_l.assign(n, springs.bend_l);
  rod.bend_m.assign(n, springs.bend_m);
  rod.bend_t.assign(n, springs.bend_t);
  rod.stretch.assign(n - 1, springs.stretch);
  rod.twist.assign(n - 1, springs.twist);
  rod.width.assign(n - 1, springs.width);
  return rod;
}

std::vector<Vec3> orientation_towards(const std::vector<Vec3>& p, const Vec3& side, double offset) {
  const PolygonTangents tangents = polygon_tangents(p);
  std::vector<Vec3> q;
  Frame before;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const FrameChoice choice = frame_towards(tangents.t[i], side);
    if (choice.status != FrameStatus::ok)
      throw InvalidInput("orientation at node " + std::to_string(i), "along the tangent there, or zero",
                         "a direction across the chain");
    // Where the direction passes from one side of the chain to the other, no node need lie along it.
    if (i > 0 && std::abs(turn_between(before, choice.frame)) > 0.5 * M_PI + 1e-9)
      throw InvalidInput(
          "orientation between nodes " + std::to_string(i - 1) + " and " + std::to_string(i),
          before.z.dot(choice.frame.z) < kFolds
              ? "the chain folds back there"
              : "the chain turns past its direction: its frame would turn by more than 90 degrees",
          "a direction that no part of the chain has, or orientation points");
    before = choice.frame;
    q.push_back(p[i] + offset * choice.frame.y);
  }
  return q;
}

}  // namespace tendril
