#include "rates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dynamics/body/bodies.h"
#include "dynamics/vector/column_access.h"
#include "dynamics/vector/finite.h"
#include "elastic.h"
#include "kinematics.h"
#include "pull_back.h"

namespace tendril {

namespace {

void put(const Columns3& from, std::size_t first, std::size_t end, std::vector<Vec3>& to) {
  const double* __restrict x = from.x.data(), * __restrict y = from.y.data(), * __restrict z = from.z.data();
  double* __restrict out = to.data()->data();
  for (std::size_t i = first; i < end; ++i) {
    out[3 * i] = x[i];
    out[3 * i + 1] = y[i];
    out[3 * i + 2] = z[i];
  }
}

}  // namespace

StateView view(const Model& model, double t, const Kinematics& kin, LoadColumns& loads) {
  assert(kin.has_rates() && (kin.has_frames() || !model.acts_on_frames));
  const std::size_t n = model.nodes;
  if (n > 0) {
    put(kin.p, 0, n, loads.p);
    put(kin.v, 0, n, loads.v);
  }
  if (n > 0 && model.acts_on_frames) {
    put(kin.frame.z, 0, n, loads.t);
    put(kin.rate.turning, 0, n, loads.turn);
    for (const Model::Segment& segment : model.segments)
      if (segment.twist) put(kin.frame.y, segment.first, segment.end, loads.m);
    std::copy_n(kin.spin.data(), n, loads.spin.begin());
    for (std::size_t i = 0; i < n; ++i) loads.turn[i] += loads.spin[i] * loads.t[i];
  }
  return {t,           loads.p,    loads.v, loads.t, loads.spin, model.mass,
          model.width, model.rods, loads.m, nullptr, kin.bodies, loads.turn};
}

Loads no_loads(const Kinematics& kin, LoadColumns& loads) {
  loads.made.from(kin);
  std::fill(loads.load.begin(), loads.load.end(), Vec3::Zero());
  std::fill(loads.torque.begin(), loads.torque.end(), Vec3::Zero());
  std::fill(loads.on_bodies.begin(), loads.on_bodies.end(), Wrench{});
  return {loads.load, loads.torque, nullptr, loads.on_bodies};
}

namespace {

using Outcome = Evaluation::Outcome;

Evaluation outcome_of(std::size_t refused) {
  return refused == Loads::kNone ? Evaluation{} : Evaluation{Outcome::refused, refused};
}

/// Puts the acting forces into the loads, and into the total the power of those without an energy. Stops
/// where one refuses the state.
Evaluation add_external(const Model& model, const State& reference, double t, const Kinematics& kin,
                        LoadColumns& loads, double& total) {
  StateView state = view(model, t, kin, loads);
  Loads to = no_loads(kin, loads);
  std::size_t refused = Loads::kNone;
  to.refused = &refused;
  const auto add = [&](bool has_energy) {
    for (const Model::Acting& acting : model.acting) {
      if (acting.has_energy != has_energy) continue;
      state.memory = memory_of(acting, reference);
      acting.force->add(state, to);
    }
  };
  add(false);
  double power = 0.0;
  for (std::size_t i = 0; i < model.nodes; ++i) power += loads.load[i].dot(loads.v[i]);
  for (std::size_t i = 0; i < model.nodes && model.acts_on_frames; ++i)
    power += loads.torque[i].dot(loads.turn[i]);
  power += power_on_bodies(kin.bodies, loads.on_bodies);
  add(true);
  total += power;
  return outcome_of(refused);
}

/// Torques across the tangent act through the tangent; see pull_back.
void add_torques(const Model& model, const LoadColumns& loads, Gradient& grad) {
  assert(loads.made.number == grad.made.number);
  for (std::size_t i = 0; i < model.nodes; ++i)
    if (!loads.torque[i].isZero(0.0)) grad.tangent.add(i, -loads.torque[i].cross(loads.t[i]));
}

/// Forces along all edges, and on the masses that anchors hold.
void pull_on_held_nodes(const Model& model, const Kinematics& kin, Gradient& grad, LoadColumns& loads,
                        Pull& pull) {
  pull_on_edges(model, kin, grad, loads, pull);
  const auto put = [&](std::size_t i) {
    pull.force.set(i, Vec3(pull.edge_force[i]) - Vec3(pull.edge_force[i - 1]));
  };
  for (const std::size_t i : model.driven_positions) put(i);
  for (const Model::Slider& slider : model.sliders) put(slider.node);
}

/// Power that anchors put in: against the whole force on a held position and the whole torque on a held
/// frame.
double anchor_power(const Model& model, const Kinematics& kin, const Gradient& grad, const Pull& pull,
                    const LoadColumns& loads) {
  assert(grad.made.fits(kin));
  double power = 0.0;
  for (const std::size_t i : model.driven_frames)
    power +=
        grad.tangent[i].dot(kin.t_rate(i)) +
        (grad.spin[i] - (model.acts_on_frames ? loads.torque[i].dot(kin.frame.z[i]) : 0.0)) * kin.spin[i];
  for (std::size_t k = 0; k < model.swivels.size(); ++k) {
    const Vec3 turning = kin.pose[model.swivels[k].anchor].angular_velocity;
    const Vec3 axis = model.swivels[k].of(kin.frame[model.swivels[k].node]);
    power += grad.swivel[k].dot(turning - axis.dot(turning) * axis);
  }
  for (const std::size_t i : model.driven_positions)
    power -= (pull.force[i] + model.moved_mass[i] * model.gravity).dot(kin.v[i]);
  for (const Model::Slider& slider : model.sliders)
    power -= (pull.force[slider.node] + model.moved_mass[slider.node] * model.gravity)
                 .dot(slider.carried(kin.pose[slider.anchor]));
  return power;
}

/// In eight sums, each in the order of the nodes, so that it may be vector code.
TENDRIL_LANES double damping_power(const Model& model, const Kinematics& kin) {
  const double *__restrict vx = kin.v.x.data(), *__restrict vy = kin.v.y.data(),
               *__restrict vz = kin.v.z.data(), *__restrict spin = kin.spin.data();
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
  for (; i < model.nodes; ++i) power += mass[i] * kin.v[i].squaredNorm() + inertia[i] * (spin[i] * spin[i]);
  for (const double sum : sums) power += sum;
  for (const Model::Slider& slider : model.sliders)
    power += model.damping[slider.node] * model.moved_mass[slider.node] *
             (slider.free * Vec3(kin.v[slider.node])).squaredNorm();
  for (std::size_t k = 0; k < model.swivels.size(); ++k) {
    const std::size_t node = model.swivels[k].node;
    power += model.damping[node] * model.inertia[node] * kin.swivel_spin[k] * kin.swivel_spin[k];
  }
  return -power;
}

/// v' of all nodes, from the forces on them, or from those along the edges where there is nothing else; 0
/// where the position is held. False where one is not finite.
template <bool ByEdges>
TENDRIL_INLINE bool accelerate(const Model& model, const Kinematics& kin, const Pull& pull,
                               double* __restrict dv) {
  const lanes::Reader force(ByEdges ? pull.edge_force : pull.force), v(kin.v);
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

TENDRIL_LANES bool accelerate_by_edges(const Model& model, const Kinematics& kin, const Pull& pull,
                                       double* dv) {
  return accelerate<true>(model, kin, pull, dv);
}
TENDRIL_LANES bool accelerate_by_masses(const Model& model, const Kinematics& kin, const Pull& pull,
                                        double* dv) {
  return accelerate<false>(model, kin, pull, dv);
}

/// p' of all nodes; 0 where the position is held.
void move(const Model& model, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
  std::copy_n(y.data() + model.v_begin(), model.v_begin(), dy.data());
  for (const std::size_t i : model.held_positions) dy.segment<3>(3 * static_cast<Eigen::Index>(i)).setZero();
}

/// Nothing pushes a sliding node off its line or plane.
void slide(const Model& model, Eigen::VectorXd& dy) {
  for (const Model::Slider& slider : model.sliders)
    for (const Eigen::Index begin : {Eigen::Index{0}, model.v_begin()}) {
      auto rate = dy.segment<3>(begin + 3 * static_cast<Eigen::Index>(slider.node));
      rate = (slider.free * rate).eval();
    }
}

/// theta' and w' of the nodes of a segment; 0 where the frame is held. False where one is not finite.
TENDRIL_LANES bool turn(const Model& model, const Model::Segment& segment, const Kinematics& kin,
                        const Gradient& grad, double* __restrict turned, double* __restrict spun) {
  const double *__restrict spin = kin.spin.data(), *__restrict connection = kin.rate.connection.data(),
               *__restrict g_spin = grad.spin.data();
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
bool add_spin_torques(const Model& model, const LoadColumns& loads, Eigen::VectorXd& dy) {
  bool finite = true;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    if (!model.has_twist(i)) continue;
    double& spun = dy[model.spin_begin() + model.twist_index[i]];
    spun += model.inverse_inertia[i] * loads.torque[i].dot(loads.t[i]);
    finite &= std::isfinite(spun);
  }
  return finite;
}

}  // namespace

Evaluation rates(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                 Eigen::VectorXd& dy, System::Workspace& work) {
  auto& [kin, grad, loads, pull, tiles] = work;
  const Motion what = model.acts_on_frames ? Motion::all : Motion::springs;
  if (const Evaluation at = kinematics(model, reference, t, y, what, kin); !at.ok()) return at;
  double heat = 0.0;
  if (const Evaluation at = elastic(model, reference, {true, true}, kin, grad, heat); !at.ok()) return at;
  double power = -heat;
  if (model.loaded) {
    if (const Evaluation at = add_external(model, reference, t, kin, loads, power); !at.ok()) return at;
    if (model.acts_on_frames) add_torques(model, loads, grad);
  }
  const bool by_edges = !model.loaded && model.attachments.empty();
  if (by_edges)
    pull_on_held_nodes(model, kin, grad, loads, pull);
  else
    pull_back(model, kin, grad, loads, pull);
  if (model.driven) power += anchor_power(model, kin, grad, pull, loads);
  if (model.damped) power += damping_power(model, kin);

  dy.resize(model.size());
  move(model, y, dy);
  bool finite = std::isfinite(power);
  const auto accelerate_all = by_edges ? accelerate_by_edges : accelerate_by_masses;
  finite &= accelerate_all(model, kin, pull, dy.data() + model.v_begin());
  if (!model.sliders.empty()) slide(model, dy);
  for (const Model::Segment& s : model.segments) {
    if (!s.twist) continue;
    const Eigen::Index k = model.twist_index[s.first];
    finite &=
        turn(model, s, kin, grad, dy.data() + model.theta_begin() + k, dy.data() + model.spin_begin() + k);
  }
  for (std::size_t k = 0; k < model.swivels.size(); ++k) {  // damped about the axis, not the tangent
    const std::size_t node = model.swivels[k].node;
    dy[model.spin_begin() + model.twist_index[node]] +=
        model.damping[node] * (kin.spin[node] - kin.swivel_spin[k]);
  }
  if (model.acts_on_frames) finite &= add_spin_torques(model, loads, dy);
  if (!model.bodies.empty()) finite &= body_rates(model, y, kin.bodies, loads.on_bodies, dy);
  dy[model.work_index()] = power;
  return finite ? Evaluation{} : Evaluation{Outcome::not_finite, 0};
}

Evaluation power_of_loads(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                          double& power, System::Workspace& work) {
  auto& [kin, grad, loads, pull, tiles] = work;
  power = 0.0;
  if (!model.loaded) {
    take_velocities(model, y, kin);
  } else {
    if (const Evaluation at = kinematics(model, reference, t, y, Motion::all, kin); !at.ok()) return at;
    if (const Evaluation at = add_external(model, reference, t, kin, loads, power); !at.ok()) return at;
  }
  if (model.damped) power += damping_power(model, kin);
  return std::isfinite(power) ? Evaluation{} : Evaluation{Outcome::not_finite, 0};
}

Evaluation refusal(const Model& model, const State& state, System::Workspace& work) {
  const auto asked = [](const Model::Acting& acting) { return acting.refuses; };
  if (std::none_of(model.acting.begin(), model.acting.end(), asked)) return {};
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::all, work.kinematics);
      !at.ok())
    return at;
  StateView seen = view(model, state.time, work.kinematics, work.loads);
  Loads to = no_loads(work.kinematics, work.loads);
  std::size_t refused = Loads::kNone;
  to.refused = &refused;
  for (const Model::Acting& acting : model.acting) {
    if (!acting.refuses) continue;
    seen.memory = memory_of(acting, state);
    acting.force->add(seen, to);
  }
  return outcome_of(refused);
}

Evaluation undifferentiated_loads(const Model& model, const State& reference, const Eigen::VectorXd& y,
                                  std::span<const Undifferentiated> forces, Eigen::VectorXd& out,
                                  System::Workspace& work) {
  auto& [kin, grad, loads, pull, tiles] = work;
  if (const Evaluation at = kinematics(model, reference, reference.time, y, Motion::all, kin); !at.ok())
    return at;
  relax(kin, grad);
  StateView state = view(model, reference.time, kin, loads);
  Loads to = no_loads(kin, loads);
  std::size_t refused = Loads::kNone;
  to.refused = &refused;
  for (const Undifferentiated& force : forces) {
    state.memory = memory_of(*force.acting, reference);
    if (force.add)
      force.add(state, to);
    else
      force.acting->force->add(state, to);
  }
  if (const Evaluation at = outcome_of(refused); !at.ok()) return at;
  if (model.acts_on_frames) add_torques(model, loads, grad);
  pull_back(model, kin, grad, loads, pull);
  out.setZero(model.size());
  for (std::size_t i = 0; i < model.nodes; ++i) {
    out.segment<3>(model.v_begin() + 3 * static_cast<Eigen::Index>(i)) = pull.force[i];
    if (model.has_twist(i))
      out[model.spin_begin() + model.twist_index[i]] =
          (model.acts_on_frames ? loads.torque[i].dot(loads.t[i]) : 0.0) - grad.spin[i];
  }
  put_body_loads(model, loads.on_bodies, out);
  return {};
}

}  // namespace tendril
