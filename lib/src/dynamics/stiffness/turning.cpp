#include "turning.h"

#include "spring_stiffness.h"

namespace tendril {
namespace {

/// a (1 - e e^T)
Mat3 project_right(const Mat3& a, const Vec3& e) {
  const Vec3 along = a * e;
  return a - along * e.transpose();
}
/// (1 - e e^T) a
Mat3 project_left(const Mat3& a, const Vec3& e) {
  const Eigen::RowVector3d along = e.transpose() * a;
  return a - e * along;
}

}  // namespace

// With P = 1 - t t^T, s the inverse length of the tangent's bisector, U_k = (1 - e_k e_k^T) / |d_k|, the
// tangent turns by R_k = s P U_k. Since t' and g = t x t' are across t, P [t]x P = [t]x and P [t']x P = 0,
// and all that is left of the products of projectors are outer products:
//   R_k^T [t]x R_j = s^2 U_k [t]x U_j,
//   by positions   U_k (M U_j + s^2 I w [t]x V_j),
//   M = -s^2 ((g_s / 2 + I w t.b') [t]x + I w (2 g t^T + t g^T)),
// with b' = s (e_0' + e_1') and V_j = -(e_j.d_j' / |d_j| (1 - e e^T) + e' e^T + e e'^T) / |d_j| the
// derivative of e_j' by d_j.
TurningTerms turning_terms(const Model& model, std::size_t i, double g_spin, const Kinematics& kin) {
  assert(kin.has_rates());
  const Vec3 t = kin.frame.z[i];
  const Vec3 t_rate = kin.t_rate(i);
  const double s = kin.inverse_bisector[i];
  const double inertia = model.inertia[i];
  const double momentum = inertia * kin.spin[i];
  const Vec3 g = t.cross(t_rate);
  const double along = s * t.dot(kin.rate.e_rate[i - 1] + kin.rate.e_rate[i]);
  const Mat3 cross = cross_matrix(t);
  const Mat3 m = (-s * s) * ((0.5 * g_spin + momentum * along) * cross +
                             momentum * (2.0 * g * t.transpose() + t * g.transpose()));

  TurningTerms to;
  for (std::size_t j = 0; j < 2; ++j) {
    const std::size_t edge = i + j - 1;
    const Vec3 e = kin.e[edge];
    const Vec3 e_rate = kin.rate.e_rate[edge];
    const double inverse = kin.inverse_length[edge];  // 0 where there is no edge
    const Mat3 turned = (s * s * momentum * inverse) * project_right(cross, e);
    const Mat3 by_x =
        inverse * project_right(m, e) - (inverse * kin.rate.length_rate[edge]) * turned -
        (s * s * momentum * inverse) * (t.cross(e_rate) * e.transpose() + t.cross(e) * e_rate.transpose());
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3 other = kin.e[i + k - 1];
      const double other_inverse = kin.inverse_length[i + k - 1];
      to.by_v[k][j] = other_inverse * project_left(turned, other);
      to.by_x[k][j] = other_inverse * project_left(by_x, other);
    }
    const Vec3 across = (s * inverse) * (g - e.dot(g) * e);
    to.by_x[j][j] += momentum * curvature_of_unit(e, inverse, s * g);
    to.by_spin[j] = inertia * across;
    to.connection[j] = -0.5 * across;
  }
  return to;
}

}  // namespace tendril
