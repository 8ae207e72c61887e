#include "rigid_body.h"

#include <tendril/base/error.h>

#include <Eigen/Eigenvalues>

#include <cmath>

namespace tendril {
namespace {

constexpr double kRounding = 1e-12;

bool is_symmetric(const Mat3& m) {
  return (m - m.transpose()).cwiseAbs().maxCoeff() <= kRounding * m.cwiseAbs().maxCoeff();
}

/// Moments (ascending) that a distribution of mass can have: each is a sum of two second moments of place.
bool are_moments(const Vec3& of) {
  return of[0] > 0.0 && of[2] <= of[0] + of[1] + kRounding * of[2];
}

std::string name_of(std::size_t body, const char* field) {
  return "bodies[" + std::to_string(body) + "]." + field;
}

void check(const Body& body, std::size_t b) {
  if (!(body.mass > 0.0) || !std::isfinite(body.mass))
    throw InvalidInput(name_of(b, "mass"), std::to_string(body.mass), "a positive number");
  if (!body.inertia.allFinite())
    throw InvalidInput(name_of(b, "inertia"), "not finite", "finite moments and products");
  if (!is_symmetric(body.inertia))
    throw InvalidInput(name_of(b, "inertia"), "not symmetric", "a symmetric matrix");
  const auto finite = [&](const char* field, const Vec3& v) {
    if (!is_finite(v)) throw InvalidInput(name_of(b, field), "not finite", "finite coordinates");
  };
  finite("position", body.position);
  finite("velocity", body.velocity);
  finite("spin", body.spin);
  if (!is_rotation(body.rotation))
    throw InvalidInput(name_of(b, "rotation"), "not orthonormal, or mirrored", "a rotation to 1e-9");
}

RigidBody made_of(const Body& body, std::size_t b) {
  const Mat3 inertia = 0.5 * (body.inertia + body.inertia.transpose());
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  const Vec3 moments = solver.eigenvalues();
  if (!are_moments(moments))
    throw InvalidInput(name_of(b, "inertia"),
                       "principal moments " + std::to_string(moments[0]) + ", " + std::to_string(moments[1]) +
                           ", " + std::to_string(moments[2]),
                       "positive ones, none larger than the sum of the two others");
  const Mat3& axes = solver.eigenvectors();
  const Mat3 inverse = axes * moments.cwiseInverse().asDiagonal() * axes.transpose();
  return {body.mass,
          inertia,
          0.5 * (inverse + inverse.transpose()),
          axes,
          moments,
          moments[2] - moments[0] <= kRounding * moments[2],
          std::sqrt(moments.mean() / body.mass)};
}

}  // namespace

std::vector<RigidBody> checked_bodies(const std::vector<Body>& bodies) {
  std::vector<RigidBody> all;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    check(bodies[b], b);
    all.push_back(made_of(bodies[b], b));
  }
  return all;
}

bool is_rotation(const Mat3& r) {
  return (r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff() <= 1e-9 &&
         r.col(0).cross(r.col(1)).dot(r.col(2)) > 0.0;
}

/// Newton's iteration for the polar factor: from 1e-9 to rounding in one step.
Mat3 nearest_rotation(const Mat3& r) {
  return 0.5 * r * (3.0 * Mat3::Identity() - r.transpose() * r);
}

}  // namespace tendril
