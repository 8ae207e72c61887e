#include "statics_problem.h"

#include <tendril/base/error.h>
#include <tendril/dynamics/stiffness.h>

#include <algorithm>
#include <cmath>

#include "dynamics/rhs/workspace.h"

namespace tendril {
namespace {

constexpr double kBalanced = 1e-9;       // of an unbalanced force, over the loads and reactions
constexpr double kHalfUnit = 0x1.0p-53;  // in the last place, relative

/// Nothing holds a free body: it comes to rest nowhere but by chance.
const System& without_bodies(const System& system) {
  if (system.body_count() > 0)
    throw InvalidInput("bodies", std::to_string(system.body_count()) + " free bodies",
                       "a scene of rods alone: a body that nothing holds has no equilibrium to be found");
  return system;
}

}  // namespace

StaticProblem::StaticProblem(const System& system)
    : system_(without_bodies(system)),
      work_(system.make_workspace()),
      coordinates_(system),
      loads_(system, coordinates_),
      conservative_(loads_.conservative()) {
  for (const Joint& joint : system.scene().joints) conservative_ = conservative_ && joint.reaction;
  // With what has let go, so that the state is laid out alike.
  Scene turning = system.scene();
  bool any = false;
  for (Anchor& anchor : turning.anchors) {
    if (!anchor.motion) continue;
    any = true;
    anchor.motion = [motion = anchor.motion, clock = clock_](double time) {
      AnchorPose pose = motion(time);
      pose.position = motion(*clock).position;
      return pose;
    };
  }
  if (!any) return;
  turning_.emplace(std::move(turning), model_of(system).from);
  turning_work_ = turning_->make_workspace();
}

Evaluation StaticProblem::evaluate(StaticState& at) {
  if (const Evaluation e = system_.rebase(at.state, *work_); !e.ok()) return e;
  coordinates_.stop(at.state);
  if (const Evaluation e =
          system_.elastic_gradient(at.state, at.state.time, at.state.y, at.elastic, at.gradient, *work_);
      !e.ok())
    return e;
  if (const Evaluation e = loads_.add(at.state, at.loads, at.potential, *work_); !e.ok()) return e;
  at.pushed = loads_.sum();
  at.residual.resize(size());
  for (Eigen::Index k = 0; k < size(); ++k)
    at.residual[k] = coordinates_.in(at.gradient, k) - at.load * at.loads[k];
  if (std::isfinite(at.energy()) && at.residual.allFinite()) return {};
  return {Evaluation::Outcome::not_finite, 0};
}

Evaluation StaticProblem::move(const StaticState& from, const Eigen::VectorXd& x, double time, double load,
                               StaticState& to) {
  to.state = from.state;
  to.load = load;
  coordinates_.displace(to.state, x, time);
  return evaluate(to);
}

/// Positions of moving anchors go by the columns of the Hessian: differences of a stiff rod's forces would
/// drown in rounding. Their frames go by differences, at positions that stay, where the tensions cancel.
Evaluation StaticProblem::drift(const StaticState& at, double by_load, double by_time,
                                Eigen::VectorXd& rate) {
  rate = -by_load * at.loads;
  if (by_time == 0.0) return {};
  const double share = 1e-6;
  State there = at.state;
  there.time += share * by_time;
  double energy = 0.0;
  Eigen::VectorXd before, after, loads;
  *clock_ = at.state.time;
  const auto bent = [&](double time, Eigen::VectorXd& gradient) {
    return turning_ ? turning_->elastic_gradient(at.state, time, at.state.y, energy, gradient, *turning_work_)
                    : system_.elastic_gradient(at.state, at.state.time, at.state.y, energy, gradient, *work_);
  };
  if (const Evaluation e = bent(at.state.time, before); !e.ok()) return e;
  if (const Evaluation e = bent(there.time, after); !e.ok()) return e;
  if (const Evaluation e = loads_.add(there, loads, energy, *work_); !e.ok()) return e;
  for (const Anchor& anchor : model_of(system_).anchors) {
    if (!anchor.motion || !anchor.holds_position || elastic_.cols() != at.gradient.size()) continue;
    const auto node = static_cast<Eigen::Index>(system_.rods()[anchor.rod].first + anchor.node);
    const Vec3 move =
        coordinates_.held(static_cast<std::size_t>(node),
                          anchor.motion(there.time).position - anchor.motion(at.state.time).position);
    for (Eigen::Index axis = 0; axis < 3; ++axis) after += move[axis] * elastic_.col(3 * node + axis);
  }
  for (Eigen::Index k = 0; k < size(); ++k) {
    const double grown = coordinates_.in(after, k) - coordinates_.in(before, k);
    rate[k] += (grown - at.load * (loads[k] - at.loads[k])) / share;
  }
  return {};
}

Evaluation StaticProblem::tangent(const StaticState& at, Eigen::SparseMatrix<double>& k) {
  Eigen::SparseMatrix<double>& elastic = elastic_;
  if (const Evaluation e = elastic_stiffness(system_, at.state, elastic, *work_); !e.ok()) return e;
  Eigen::SparseMatrix<double> turned;
  if (coordinates_.any_slides()) coordinates_.turn_to_axes(turned = elastic);
  const Eigen::SparseMatrix<double>& along = coordinates_.any_slides() ? turned : elastic;
  std::vector<std::pair<Eigen::Index, double>> column;
  k.resize(size(), size());
  k.setZero();
  k.reserve(conservative_ ? along.nonZeros() * 11 / 20 + size() : along.nonZeros());
  for (Eigen::Index c = 0; c < size(); ++c) {
    column.clear();
    for (Eigen::SparseMatrix<double>::InnerIterator entry(along, coordinates_.in_gradient(c)); entry; ++entry)
      if (const Eigen::Index r = coordinates_.row_of(entry.row()); r >= (conservative_ ? c : 0))
        column.emplace_back(r, entry.value());
    std::sort(column.begin(), column.end());
    k.startVec(c);
    for (const auto& [r, value] : column) k.insertBack(r, c) = value;
  }
  k.finalize();
  if (!loads_.depends_on_state() || at.load == 0.0) return {};
  std::vector<Eigen::Triplet<double>> triplets;
  if (const Evaluation e = loads_.differentiate(at.state, elastic, triplets, *work_); !e.ok()) return e;
  for (auto& entry : triplets) entry = {entry.row(), entry.col(), -at.load * entry.value()};
  if (!conservative_) add_turning(at, triplets);
  Eigen::SparseMatrix<double> by_loads(size(), size());
  by_loads.setFromTriplets(triplets.begin(), triplets.end());
  if (conservative_)
    k += Eigen::SparseMatrix<double>(by_loads.triangularView<Eigen::Lower>());
  else
    k += by_loads;
  return {};
}

/// The Hessian is that of E(p, theta), whose directors are carried along; forces are its gradient with
/// directors that do not spin. Where springs twist a node by g, as a torque about its tangent makes them,
/// that differs by 1/2 g R_k^T (t x R_j), antisymmetric, with R_k = dt / dd_k.
void StaticProblem::add_turning(const StaticState& at, std::vector<Eigen::Triplet<double>>& out) const {
  const auto place = [&](std::size_t i) {
    return Vec3(at.state.y.segment<3>(3 * static_cast<Eigen::Index>(i)));
  };
  for (const NodeRange& rod : system_.rods())
    for (std::size_t i = rod.first; i < rod.first + rod.count; ++i) {
      const Eigen::Index turn = coordinates_.row(i, 3);
      if (turn < 0 || coordinates_.holds_frame(i)) continue;  // a swivel's axis does not follow the edges
      const double g = at.gradient[coordinates_.in_gradient(turn)];
      const std::size_t from = i > rod.first ? i - 1 : i;
      const std::size_t to = i + 1 < rod.first + rod.count ? i + 1 : i;
      Vec3 sum = Vec3::Zero();
      for (std::size_t e = from; e < to; ++e) sum += (place(e + 1) - place(e)).normalized();
      const Vec3 t = sum.normalized();
      for (std::size_t k = from; k < to; ++k)
        for (std::size_t j = from; j < to; ++j)
          put_turning(k, j, 0.5 * g / sum.squaredNorm(), t, place(k + 1) - place(k), place(j + 1) - place(j),
                      out);
    }
}

/// c U_k [t]x U_j by the vectors along edges k and j, U = (1 - e e^T) / |d|.
void StaticProblem::put_turning(std::size_t k, std::size_t j, double c, const Vec3& t, const Vec3& dk,
                                const Vec3& dj, std::vector<Eigen::Triplet<double>>& out) const {
  const auto across = [](const Vec3& d) {
    return Mat3((Mat3::Identity() - d * d.transpose() / d.squaredNorm()) / d.norm());
  };
  Mat3 turned;
  turned << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  const Mat3 by = c * across(dk) * turned * across(dj);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b)
      for (int r = 0; r < 3; ++r)
        for (int q = 0; q < 3; ++q) {
          const Eigen::Index row = coordinates_.row(k + a, r), column = coordinates_.row(j + b, q);
          if (row < 0 || column < 0) continue;
          const Vec3 of_column(coordinates_.along(j + b, q, by.row(0)),
                               coordinates_.along(j + b, q, by.row(1)),
                               coordinates_.along(j + b, q, by.row(2)));
          const double entry = coordinates_.along(k + a, r, of_column);
          out.emplace_back(row, column, a == b ? entry : -entry);
        }
}

double StaticProblem::largest(const Eigen::VectorXd& residual) const {
  double most = 0.0;
  for (Eigen::Index k = 0; k < size(); ++k)
    most = std::max(most, std::abs(residual[k]) / (coordinates_.axis(k) == 3 ? coordinates_.length() : 1.0));
  return most;
}

/// The larger of the loads and the reactions.
double StaticProblem::pushed(const StaticState& at) const {
  double most = std::abs(at.load) * at.pushed;
  for (std::size_t i = 0; i < system_.node_count(); ++i)
    if (coordinates_.holds_position(i) || coordinates_.axes(i))
      most = std::max(most, coordinates_.held(i, tendril::at(at.gradient, i)).norm());
  return most;
}

/// What half a unit in the last place of every position and director may make of a force, by the last
/// Hessian: in a stiff rod more than the goal.
double StaticProblem::rounding(const StaticState& at) const {
  if (elastic_.cols() != at.gradient.size()) return 0.0;
  const Eigen::Index positions = 3 * static_cast<Eigen::Index>(system_.node_count());
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(elastic_.rows());
  for (Eigen::Index c = 0; c < elastic_.cols(); ++c) {
    const double size = c < positions ? std::abs(at.state.y[c]) : 1.0;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(elastic_, c); entry; ++entry)
      sums[entry.row()] += std::abs(entry.value()) * size;
  }
  double most = 0.0;
  for (Eigen::Index k = 0; k < size(); ++k)
    most = std::max(
        most, sums[coordinates_.in_gradient(k)] / (coordinates_.axis(k) == 3 ? coordinates_.length() : 1.0));
  return kHalfUnit * most;
}

double StaticProblem::goal(const StaticState& at) const {
  return std::max(kBalanced * pushed(at), 2.0 * rounding(at));
}

double StaticProblem::force_scale(const StaticState& at) const {
  return std::max({coordinates_.energy_scale() / coordinates_.length(), pushed(at), goal(at) / kBalanced});
}

/// On held frames, by the springs.
std::vector<Vec3> StaticProblem::elastic_torques(const StaticState& at) {
  std::vector<Vec3> torques(system_.node_count(), Vec3::Zero());
  const Model& model = model_of(system_);
  double energy = 0.0;
  Eigen::VectorXd gradient;
  if (!system_.elastic_gradient(at.state, at.state.time, at.state.y, energy, gradient, *work_).ok())
    return {};
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (!coordinates_.holds_frame(i)) continue;
    const Vec3 t = work_->kinematics.frame.z[i];
    torques[i] = -t.cross(work_->gradient.tangent[i]);
    if (model.has_twist(i)) torques[i] -= work_->gradient.spin[i] * t;
  }
  for (std::size_t k = 0; k < model.swivels.size(); ++k)
    torques[model.swivels[k].node] = -work_->gradient.swivel[k];
  return torques;
}

std::vector<Support> StaticProblem::supports(const StaticState& at) {
  const std::vector<Vec3> torques = elastic_torques(at);
  Eigen::VectorXd loads;
  double unused = 0.0;
  if (torques.empty() || !loads_.add(at.state, loads, unused, *work_).ok()) return {};
  const double share = loads_.any() ? at.load : 0.0;
  std::vector<Support> supports;
  for (const Anchor& anchor : system_.scene().anchors) {
    const std::size_t i = system_.rods()[anchor.rod].first + anchor.node;
    const Vec3 elastic = at.gradient.segment<3>(3 * static_cast<Eigen::Index>(i));
    Support& support = supports.emplace_back();
    support.force = coordinates_.held(i, elastic - share * loads_.force()[i]);
    if (coordinates_.holds_frame(i)) support.torque = -torques[i] - share * loads_.torque()[i];
  }
  return supports;
}

}  // namespace tendril
