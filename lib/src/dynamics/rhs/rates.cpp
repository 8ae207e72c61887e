#include "rates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dynamics/vector/column_access.h"
#include "elastic.h"
#include "kinematics.h"
#include "pull_back.h"

namespace tendril {

StateView view(const Model& model, double t, System::Workspace& work) {
  for (std::size_t i = 0; i < model.nodes; ++i) {
    work.seen_p[i] = work.p[i];
    work.seen_v[i] = work.v[i];
    work.seen_t[i] = work.frame.z[i];
    work.seen_m[i] = model.has_twist(i) ? work.frame.y[i] : Vec3(Vec3::Zero());
    work.seen_spin[i] = work.spin[i];
  }
  return {t,          work.seen_p, work.seen_v, work.seen_t, work.seen_spin,
          model.mass, model.width, model.rods,  work.seen_m};
}

Loads no_loads(System::Workspace& work) {
  std::fill(work.load.begin(), work.load.end(), Vec3::Zero());
  std::fill(work.torque.begin(), work.torque.end(), Vec3::Zero());
  return {work.load, work.torque};
}

namespace {

using Outcome = Evaluation::Outcome;
using Workspace = System::Workspace;

/// Adds the acting forces to the workspace's loads; returns the power of those without an
/// energy.
double add_external(const Model& model, double t, Workspace& work) {
  const StateView state = view(model, t, work);
  const Loads loads = no_loads(work);
  for (const Model::Acting& acting : model.acting)
    if (!acting.has_energy) acting.force->add(state, loads);
  double power = 0.0;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const Vec3 turning = Vec3(work.turning[i]) + work.spin[i] * work.seen_t[i];
    power += work.load[i].dot(work.seen_v[i]) + work.torque[i].dot(turning);
  }
  for (const Model::Acting& acting : model.acting)
    if (acting.has_energy) acting.force->add(state, loads);
  return power;
}

/// Torques across the tangent act through the tangent; see pull_back.
void add_torques(const Model& model, Workspace& work) {
  for (std::size_t i = 0; i < model.nodes; ++i)
    if (!work.torque[i].isZero(0.0)) work.g_tangent.add(i, -work.torque[i].cross(work.seen_t[i]));
}

/// Forces along all edges, and on the masses that anchors hold.
void pull_on_held_nodes(const Model& model, Workspace& work) {
  pull_on_edges(model, work);
  for (const std::size_t i : model.driven_positions)
    work.force.set(i, Vec3(work.edge_force[i]) - Vec3(work.edge_force[i - 1]));
}

/// Power that anchors put in: against the whole force on a held position and the whole torque on a held
/// frame.
double anchor_power(const Model& model, const Workspace& work) {
  double power = 0.0;
  for (const std::size_t i : model.driven_frames)
    power += work.g_tangent[i].dot(work.t_rate(i)) +
             (work.g_spin[i] - (model.loaded ? work.torque[i].dot(work.frame.z[i]) : 0.0)) * work.spin[i];
  for (const std::size_t i : model.driven_positions)
    power -= (work.force[i] + model.moved_mass[i] * model.gravity).dot(work.v[i]);
  return power;
}

/// In eight sums, each in the order of the nodes, so that it may be vector code.
TENDRIL_LANES double damping_power(const Model& model, const Workspace& work) {
  const double *__restrict vx = work.v.x.data(), *__restrict vy = work.v.y.data(),
               *__restrict vz = work.v.z.data(), *__restrict spin = work.spin.data();
  const double* __restrict mass = model.damped_mass.data(), * __restrict inertia =
                                                                model.damped_inertia.data();
  constexpr std::size_t kSums = 8;
  double sums[kSums] = {};
  std::size_t i = 0;
  for (; i + kSums <= model.nodes; i += kSums)
    for (std::size_t k = 0; k < kSums; ++k) {
      const std::size_t j = i + k;
      sums[k] += mass[j] * (vx[j] * vx[j] + vy[j] * vy[j] + vz[j] * vz[j]) + inertia[j] * (spin[j] * spin[j]);
    }
  double power = 0.0;
  for (; i < model.nodes; ++i) power += mass[i] * work.v[i].squaredNorm() + inertia[i] * (spin[i] * spin[i]);
  for (const double sum : sums) power += sum;
  return -power;
}

TENDRIL_INLINE std::int64_t no_number(double x) {
  return std::fabs(x) <= std::numeric_limits<double>::max() ? 0 : 1;
}

/// v' of all nodes, from the forces on them, or from those along the edges where there is nothing else; 0
/// where the position is held. False where one is not finite.
template <bool ByEdges>
TENDRIL_INLINE bool accelerate(const Model& model, const Workspace& work, double* __restrict dv) {
  const lanes::Reader force(ByEdges ? work.edge_force : work.force), v(work.v);
  const double* __restrict inverse_mass = model.inverse_mass.data(), * __restrict damping =
                                                                         model.damping.data();
  const lanes::V3 gravity{model.gravity.x(), model.gravity.y(), model.gravity.z()};
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const double s = inverse_mass[i];
    const double free = s > 0.0 ? 1.0 : 0.0;
    lanes::V3 f = force.at(i);
    if constexpr (ByEdges) f = f - force.at(i - 1);
    const lanes::V3 a = s * f + free * (gravity - damping[i] * v.at(i));
    dv[3 * i] = a.x;
    dv[3 * i + 1] = a.y;
    dv[3 * i + 2] = a.z;
    bad |= no_number(a.x) | no_number(a.y) | no_number(a.z);
  }
  return bad == 0;
}

TENDRIL_LANES bool accelerate_by_edges(const Model& model, const Workspace& work, double* dv) {
  return accelerate<true>(model, work, dv);
}
TENDRIL_LANES bool accelerate_by_masses(const Model& model, const Workspace& work, double* dv) {
  return accelerate<false>(model, work, dv);
}

/// p' of all nodes; 0 where the position is held.
void move(const Model& model, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
  std::copy_n(y.data() + model.v_begin(), model.v_begin(), dy.data());
  for (const std::size_t i : model.held_positions) dy.segment<3>(3 * static_cast<Eigen::Index>(i)).setZero();
}

/// theta' and w' of the nodes of a segment; 0 where the frame is held. False where one is not finite.
TENDRIL_LANES bool turn(const Model& model, const Model::Segment& segment, const Workspace& work,
                        double* __restrict turned, double* __restrict spun) {
  const double *__restrict spin = work.spin.data(), *__restrict connection = work.connection.data(),
               *__restrict g_spin = work.g_spin.data();
  const double* __restrict inverse_inertia = model.inverse_inertia.data(), * __restrict damping =
                                                                               model.damping.data();
  std::int64_t bad = 0;
  TENDRIL_LOOP
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    const double s = inverse_inertia[i];
    const double free = s > 0.0 ? 1.0 : 0.0;
    const double by = free * (spin[i] + connection[i]);
    const double to = -s * g_spin[i] - free * damping[i] * spin[i];
    turned[i - segment.first] = by;
    spun[i - segment.first] = to;
    bad |= no_number(by) | no_number(to);
  }
  return bad == 0;
}

/// What external torques give the spins. False where one is not finite.
bool add_spin_torques(const Model& model, const Workspace& work, Eigen::VectorXd& dy) {
  bool finite = true;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    if (!model.has_twist(i)) continue;
    double& spun = dy[model.spin_begin() + model.twist_index[i]];
    spun += model.inverse_inertia[i] * work.torque[i].dot(work.seen_t[i]);
    finite &= std::isfinite(spun);
  }
  return finite;
}

}  // namespace

Evaluation rates(const Model& model, const State& reference, double t, const Eigen::VectorXd& y, bool springs,
                 Eigen::VectorXd& dy, Workspace& work) {
  const Motion what = model.loaded ? Motion::all : Motion::springs;
  if (const Evaluation at = kinematics(model, reference, t, y, what, work); !at.ok()) return at;
  double heat = 0.0;
  if (!springs)
    relax(model, true, work);
  else if (const Evaluation at = elastic(model, reference, {true, true}, work, heat); !at.ok())
    return at;
  double power = -heat;
  if (model.loaded) {
    power += add_external(model, t, work);
    add_torques(model, work);
  }
  const bool by_edges = !model.loaded && model.rides.empty();
  if (by_edges)
    pull_on_held_nodes(model, work);
  else
    pull_back(model, work);
  power += anchor_power(model, work);
  if (model.damped) power += damping_power(model, work);

  dy.resize(model.size());
  move(model, y, dy);
  bool finite = std::isfinite(power);
  const auto accelerate_all = by_edges ? accelerate_by_edges : accelerate_by_masses;
  finite &= accelerate_all(model, work, dy.data() + model.v_begin());
  for (const Model::Segment& s : model.segments) {
    if (!s.twist) continue;
    const Eigen::Index k = model.twist_index[s.first];
    finite &= turn(model, s, work, dy.data() + model.theta_begin() + k, dy.data() + model.spin_begin() + k);
  }
  if (model.loaded) finite &= add_spin_torques(model, work, dy);
  dy[model.work_index()] = power;
  return finite ? Evaluation{} : Evaluation{Outcome::not_finite, 0};
}

Evaluation undifferentiated_loads(const Model& model, const State& reference, const Eigen::VectorXd& y,
                                  Eigen::VectorXd& loads, Workspace& work) {
  if (const Evaluation at = kinematics(model, reference, reference.time, y, Motion::all, work); !at.ok())
    return at;
  relax(model, false, work);
  const StateView state = view(model, reference.time, work);
  const Loads to = no_loads(work);
  for (const auto& force : model.scene.forces)
    if (force->depends_on_state() && !force->has_derivatives()) force->add(state, to);
  add_torques(model, work);
  pull_back(model, work);
  loads.setZero(model.size());
  for (std::size_t i = 0; i < model.nodes; ++i) {
    loads.segment<3>(model.v_begin() + 3 * static_cast<Eigen::Index>(i)) = work.force[i];
    if (model.has_twist(i))
      loads[model.spin_begin() + model.twist_index[i]] = work.torque[i].dot(work.seen_t[i]) - work.g_spin[i];
  }
  return {};
}

}  // namespace tendril
