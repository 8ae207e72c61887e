#include "spring_net.h"

#include <algorithm>
#include <cmath>

namespace tendril::gallery {
namespace {

double angle_between(const Vec3& e, const Vec3& f) {
  return std::atan2(e.cross(f).norm(), e.dot(f));
}

void add_angle(const AngleSpring& spring, std::span<const Vec3> p, std::span<Vec3> force) {
  const auto [a, b, c] = spring.nodes;
  const Vec3 e = p[b] - p[a], f = p[c] - p[b];
  const Vec3 across = e.cross(f);
  const double sine = across.norm();
  // Straight or folded back, every direction to bend is the same: there is no force.
  if (sine <= 1e-12 * e.norm() * f.norm()) return;
  const double torque = spring.stiffness * (std::atan2(sine, e.dot(f)) - spring.rest);
  const Vec3 axis = across / sine;
  const Vec3 by_e = e.cross(axis) / e.squaredNorm(), by_f = -f.cross(axis) / f.squaredNorm();
  // The angle grows by by_e . de + by_f . df.
  force[a] += torque * by_e;
  force[b] += torque * (by_f - by_e);
  force[c] -= torque * by_f;
}

/// Product of M^-1 K about p with x, by central differences of the forces; held masses do not move.
void multiply(const SpringNet& net, std::span<const Vec3> p, double by, std::vector<Vec3>& x) {
  std::vector<Vec3> at(p.begin(), p.end());
  std::vector<Vec3> ahead(p.size(), Vec3::Zero()), behind = ahead;
  for (std::size_t i = 0; i < p.size(); ++i) at[i] = p[i] + by * x[i];
  add_forces(net, at, ahead);
  for (std::size_t i = 0; i < p.size(); ++i) at[i] = p[i] - by * x[i];
  add_forces(net, at, behind);
  for (std::size_t i = 0; i < p.size(); ++i) x[i] = (behind[i] - ahead[i]) / (2 * by * net.mass[i]);
  for (const std::uint32_t i : net.held) x[i].setZero();
}

double norm(const std::vector<Vec3>& x) {
  double sum = 0.0;
  for (const Vec3& one : x) sum += one.squaredNorm();
  return std::sqrt(sum);
}

}  // namespace

Spring spring_between(std::span<const Vec3> rest, std::uint32_t a, std::uint32_t b, double stiffness) {
  return {a, b, stiffness, (rest[b] - rest[a]).norm()};
}

AngleSpring angle_at(std::span<const Vec3> rest, std::uint32_t middle, double stiffness) {
  const std::uint32_t a = middle - 1, c = middle + 1;
  return {{a, middle, c}, stiffness, angle_between(rest[middle] - rest[a], rest[c] - rest[middle])};
}

void add_forces(const SpringNet& net, std::span<const Vec3> p, std::span<Vec3> force) {
  for (const Spring& spring : net.springs) {
    const Vec3 d = p[spring.b] - p[spring.a];
    const double length = d.norm();
    if (length == 0.0) continue;
    const Vec3 pull = (spring.stiffness * (1.0 - spring.rest / length)) * d;
    force[spring.a] += pull;
    force[spring.b] -= pull;
  }
  for (const AngleSpring& spring : net.angles) add_angle(spring, p, force);
}

double elastic_energy(const SpringNet& net, std::span<const Vec3> p) {
  double energy = 0.0;
  for (const Spring& spring : net.springs)
    energy += 0.5 * spring.stiffness * std::pow((p[spring.b] - p[spring.a]).norm() - spring.rest, 2);
  for (const AngleSpring& spring : net.angles) {
    const auto [a, b, c] = spring.nodes;
    energy += 0.5 * spring.stiffness * std::pow(angle_between(p[b] - p[a], p[c] - p[b]) - spring.rest, 2);
  }
  return energy;
}

double largest_frequency(const SpringNet& net, std::span<const Vec3> p) {
  constexpr int kProducts = 16;  // as many evaluations as the library's own estimate counts
  std::vector<Vec3> x(p.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto k = static_cast<double>(i);
    x[i] = Vec3(std::sin(1 + 7 * k), std::sin(2 + 11 * k), std::sin(3 + 13 * k));
  }
  for (const std::uint32_t i : net.held) x[i].setZero();
  double size = 0.0;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) size = std::max(size, (p[i + 1] - p[i]).norm());
  double square = 0.0;
  for (int k = 0; k < kProducts; ++k) {
    const double length = norm(x);
    if (!(length > 0.0)) return 0.0;
    for (Vec3& one : x) one /= length;
    multiply(net, p, 1e-6 * size, x);
    square = norm(x);
  }
  return std::sqrt(square);
}

}  // namespace tendril::gallery
