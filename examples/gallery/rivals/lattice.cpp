#include "lattice.h"

#include <algorithm>

namespace tendril::gallery {
namespace {

/// All Bernstein polynomials of a degree at u.
std::vector<double> bernstein(int degree, double u) {
  std::vector<double> b(static_cast<std::size_t>(degree) + 1, 0.0);
  b[0] = 1.0;
  for (std::size_t d = 1; d < b.size(); ++d) {
    for (std::size_t i = d; i > 0; --i) b[i] = (1 - u) * b[i] + u * b[i - 1];
    b[0] *= 1 - u;
  }
  return b;
}

using Step = std::array<int, 3>;

}  // namespace

Lattice::Lattice(const Eigen::AlignedBox3d& box, std::array<int, 3> cells) : box_(box), cells_(cells) {
  for (int i = 0; i <= cells[0]; ++i)
    for (int j = 0; j <= cells[1]; ++j)
      for (int k = 0; k <= cells[2]; ++k) {
        const Vec3 part(double(i) / cells[0], double(j) / cells[1], double(k) / cells[2]);
        rest_.push_back(box.min() + part.cwiseProduct(box.sizes()));
      }
}

std::uint32_t Lattice::index(int i, int j, int k) const {
  return static_cast<std::uint32_t>((i * (cells_[1] + 1) + j) * (cells_[2] + 1) + k);
}

int Lattice::layer(std::uint32_t index) const {
  return static_cast<int>(index) / ((cells_[1] + 1) * (cells_[2] + 1));
}

Vec3 Lattice::map(std::span<const Vec3> p, const Vec3& x) const {
  const Vec3 part = (x - box_.min()).cwiseQuotient(box_.sizes());
  const auto bx = bernstein(cells_[0], part.x()), by = bernstein(cells_[1], part.y()),
             bz = bernstein(cells_[2], part.z());
  Vec3 out = Vec3::Zero();
  std::size_t at = 0;
  for (const double i : bx)
    for (const double j : by)
      for (const double k : bz) out += i * j * k * p[at++];
  return out;
}

std::vector<Vec3> Lattice::map(std::span<const Vec3> p, std::span<const Vec3> points) const {
  std::vector<Vec3> out;
  for (const Vec3& x : points) out.push_back(map(p, x));
  return out;
}

SpringNet Lattice::net(double mass, double tension) const {
  SpringNet net{rest_, std::vector<double>(rest_.size(), mass / static_cast<double>(rest_.size())), {}};
  // Along the edges, and a diagonal of each face across x, y and z.
  constexpr std::array<Step, 6> kSteps{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}};
  for (int i = 0; i <= cells_[0]; ++i)
    for (int j = 0; j <= cells_[1]; ++j)
      for (int k = 0; k <= cells_[2]; ++k)
        for (const auto& [di, dj, dk] : kSteps) {
          if (i + di > cells_[0] || j + dj > cells_[1] || k + dk > cells_[2]) continue;
          Spring spring = spring_between(rest_, index(i, j, k), index(i + di, j + dj, k + dk), 0.0);
          spring.stiffness = tension / spring.rest;
          net.springs.push_back(spring);
        }
  return net;
}

}  // namespace tendril::gallery
