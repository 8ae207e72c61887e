#include "turning.h"

#include "spring_stiffness.h"

namespace tendril {
namespace {

Mat3 projector(const Vec3& n) {
  return Mat3::Identity() - n * n.transpose();
}

/// Derivative, by the vector that n is the unit of, of n' = (1 - n n^T) r / |.|; `inverse` the inverse
/// length, `along` and `rate` the parts n.r / |.| and n'.
Mat3 rate_by_vector(const Vec3& n, double inverse, double along, const Vec3& rate) {
  return -inverse * (along * projector(n) + rate * n.transpose() + n * rate.transpose());
}

}  // namespace

TurningTerms turning_terms(const System::Model& model, std::size_t i, double g_spin,
                           const System::Workspace& work) {
  const Vec3 t = work.frame.z[i];
  const Vec3 t_rate = work.t_rate[i];
  const double s = work.inverse_bisector[i];
  const double inertia = model.inertia[i];
  const double momentum = inertia * work.spin[i];
  const Vec3 sum_rate = work.e_rate[i - 1] + work.e_rate[i];
  const Vec3 g = t.cross(t_rate);
  const Mat3 share = s * projector(t);
  const Mat3 bend = rate_by_vector(t, s, s * t.dot(sum_rate), t_rate);
  const Mat3 curvature = curvature_of_unit(t, s, g);

  Mat3 unit[2], turn[2], turn_rate[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t edge = i + k - 1;
    const Vec3 e = work.e[edge];
    const double inverse = work.inverse_length[edge];  // 0 where there is no edge
    unit[k] = inverse * projector(e);
    turn[k] = share * unit[k];
    turn_rate[k] = bend * unit[k] +
                   share * rate_by_vector(e, inverse, inverse * work.length_rate[edge], work.e_rate[edge]);
  }
  const Mat3 cross = cross_matrix(t);
  const Mat3 cross_rate = cross_matrix(t_rate);
  TurningTerms to;
  for (std::size_t k = 0; k < 2; ++k) {
    const Mat3 crossed = turn[k].transpose() * cross;
    for (std::size_t j = 0; j < 2; ++j) {
      const Mat3 turned = crossed * turn[j];
      to.by_v[k][j] = momentum * turned;
      to.by_x[k][j] = -0.5 * g_spin * turned +
                      momentum * (crossed * turn_rate[j] - turn[k].transpose() * cross_rate * turn[j] +
                                  unit[k] * curvature * unit[j]);
    }
    const std::size_t edge = i + k - 1;
    to.by_x[k][k] += momentum * curvature_of_unit(work.e[edge], work.inverse_length[edge], share * g);
    to.by_spin[k] = inertia * turn[k].transpose() * g;
    to.connection[k] = 0.5 * turn[k].transpose() * t_rate.cross(t);
  }
  return to;
}

}  // namespace tendril
