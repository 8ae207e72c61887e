#include "stiff_solver.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <optional>

#include "body_blocks.h"
#include "differences.h"
#include "dynamics/coupling/elimination.h"
#include "dynamics/linear/block_route.h"
#include "dynamics/rhs/elastic.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/rhs/pull_back.h"
#include "dynamics/rhs/rates.h"
#include "dynamics/scene/free_bodies.h"
#include "dynamics/scene/words.h"
#include "dynamics/stiffness/spring_stiffness.h"
#include "dynamics/stiffness/stiffness_elements.h"
#include "dynamics/stiffness/turning.h"
#include "dynamics/stiffness/viscous_turning.h"
#include "local_forces.h"
#include "pivot_layout.h"

namespace tendril {
namespace {

bool depends_on_state(const Model& model) {
  for (const Model::Acting& acting : model.acting)
    if (acting.couplings.any()) return true;
  return false;
}

std::vector<Undifferentiated> without_derivatives(const Model& model) {
  std::vector<Undifferentiated> all;
  for (const Model::Acting& acting : model.acting)
    if (acting.by_differences() && !acting.varies()) all.push_back({&acting, {}});
  return all;
}

bool depends_on_time(const Model& model) {
  for (const Anchor& anchor : model.anchors)
    if (anchor.motion) return true;
  for (const Model::Acting& acting : model.acting)
    if (acting.force->depends_on_time()) return true;
  return false;
}

bool resists(const Model& model) {
  for (const Model::Segment& s : model.segments)
    if (s.viscous) return true;
  return false;
}

/// What the connection term of a node is derived by: theta' = w + by . (p_{i-1}, p_i, p_{i+1}).
struct Connection {
  std::size_t node;
  std::array<std::size_t, 3> from;  ///< carriers; EdgeStiffness::kNone for what is not there
  std::array<Vec3, 3> by;
};

/// The derivatives that a force gives of its own, under the nodes that carry and feel them.
template <int B>
class OwnDerivatives : public LoadDerivatives {
 public:
  OwnDerivatives(const Model& model, std::size_t force, BlockMatrix<B>& by_x, BlockMatrix<B>& by_u)
      : model_(model), force_(force), by_x_(by_x), by_u_(by_u) {}
  void add_by_position(std::size_t i, std::size_t j, const Mat3& k) override { add(by_x_, i, j, k); }
  void add_by_velocity(std::size_t i, std::size_t j, const Mat3& k) override { add(by_u_, i, j, k); }

 private:
  void add(BlockMatrix<B>& to, std::size_t i, std::size_t j, const Mat3& k) {
    if (std::max(i, j) >= model_.index_count()) refuse(i, j);
    if (!model_.feels[i]) return;
    auto* block = to.find(model_.carrier[i], model_.carrier[j]);
    if (!block) refuse(i, j);
    block->add(k);
  }
  [[noreturn]] void refuse(std::size_t i, std::size_t j) const {
    throw InvalidInput(name_of_force(force_), sentence("derives the force on node ", i, " by node ", j),
                       "its couplings to name that pair");
  }
  const Model& model_;
  std::size_t force_;
  BlockMatrix<B>&by_x_, &by_u_;
};

template <int B>
class BlockSolver : public StiffSolver {
 public:
  BlockSolver(const System& system, System::Workspace& work, const LocalForces* local)
      : system_(system),
        model_(model_of(system)),
        work_(work),
        local_(local),
        undifferentiated_(without_derivatives(model_)),
        loaded_(depends_on_state(model_)),
        rates_matter_(B == 4 || loaded_ || !model_.bodies.empty()),
        timed_(depends_on_time(model_)),
        pattern_(local ? *local->pattern : pattern_of_equations(model_)),
        by_x_(pattern_, !rates_matter_),
        to_x_(by_x_),
        matrix_(pattern_, !rates_matter_),
        b_(4 * pattern_.size()),
        x_(4 * pattern_.size()),
        rigid_(model_, pattern_) {
    if (rates_matter_) {
      by_u_.emplace(pattern_, false);
      to_u_.emplace(*by_u_);
    }
    if (resists(model_)) turning_.emplace(model_);
    if (!undifferentiated_.empty())
      differences_.emplace(model_, neighbours_in(local ? pattern_of_equations(model_) : pattern_));
    if (local && !local->neighbours.empty()) local_differences_.emplace(model_, local->neighbours);
    lay_out();
    if (!loaded_) bodies_.emplace(model_, pattern_.nodes());  // loads that depend on the state do not cancel
  }

  long differentiate(const State& state, const Eigen::VectorXd& rate) override {
    to_x_.restart();
    if (to_u_) to_u_->restart();
    if (fails(take_gradient(state))) return -1;
    visit_stiffness(model_, state, work_.kinematics, work_.gradient, turning_.has_value(), -1.0, to_x_);
    long evaluations = 1;
    if constexpr (B == 4) {
      if (turning_) visit_resistance(model_, work_.kinematics, *to_u_);
      add_turning();
      if (turning_ && fails(turning_->add(state, rate, work_.kinematics, to_x_))) return -1;
    }
    if (by_u_) rigid_.add(work_.kinematics.bodies, rate, by_x_, *by_u_);
    if (loaded_) {
      StateView seen = view(model_, state.time, work_.kinematics, work_.loads);
      for (const Model::Acting& acting : model_.acting) {
        if (!acting.couplings.any() || !acting.couplings.derivatives()) continue;
        seen.memory = memory_of(acting, state);
        OwnDerivatives<B> own(model_, acting.index, by_x_, *by_u_);
        acting.couplings.derivatives()(seen, own);
      }
    }
    if (differences_) {
      if (fails(differences_->add(state, undifferentiated_, work_, by_x_, *by_u_))) return -1;
      evaluations += differences_->cost();
    }
    if (local_differences_ && !local_->undifferentiated.empty()) {
      if (fails(local_differences_->add(state, local_->undifferentiated, work_, by_x_, *by_u_))) return -1;
      evaluations += local_differences_->cost();
    }
    for (const Held& held : held_) {
      by_x_.release(held.node, held.coordinate);
      if (by_u_) by_u_->release(held.node, held.coordinate);
    }
    for (const Model::Slider& slider : model_.sliders)
      if (by_u_) by_u_->project(slider.node, slider.free);
    if (timed_ && fails(take_time(state, rate))) return -1;
    return evaluations + (timed_ ? 1 : 0);
  }

  bool factor(double s) override {
    matrix_.set_negative(by_x_, s, by_u_ ? &*by_u_ : nullptr);
    for (std::size_t k = 0; k < pattern_.size(); ++k) {
      auto* diagonal = matrix_.find(pattern_.node(k), pattern_.node(k));
      for (std::size_t c = 0; c < B; ++c)
        diagonal->column[c][c] += s * (s * at_.mass[4 * k + c] + at_.damping[4 * k + c]);
    }
    if (by_u_) rigid_.add_inertia(s, *by_u_, matrix_);
    if constexpr (B == 4) add_connections(s);
    for (const Held& held : held_) {
      if (!connections_.empty()) matrix_.release(held.node, held.coordinate);
      matrix_.entry(held.node, held.node, held.coordinate, held.coordinate) = 1.0;
    }
    for (const Model::Slider& slider : model_.sliders) hold(slider);
    return matrix_.factor();
  }

  void solve(double s, const Eigen::VectorXd& r, Eigen::VectorXd& result) override {
    put_right(at_, s, r, x_.data(), b_.data());
    rigid_.put_right(s, r, b_.data());
    if (bodies_) bodies_->keep(b_.data());
    if (by_u_) by_u_->subtract_product(x_.data(), b_.data());
    for (const Held& held : held_) b_[4 * pattern_.pivot(held.node) + held.coordinate] = 0.0;
    matrix_.solve(b_.data());
    if (bodies_)
      bodies_->restore([&](std::size_t i) { return s * (s * at_.mass[i] + at_.damping[i]); }, b_.data());
    take_solution(at_, s, b_.data(), x_.data(), r.size(), result);
    rigid_.take_turning(b_.data(), result);
    for (const Connection& c : connections_)
      result[model_.spin_begin() + model_.twist_index[c.node]] -= turned_by(c);
  }

 private:
  struct Held {
    std::size_t node, coordinate;
  };

  /// Places in y, the masses of what is free, and what is held: there every rate is 0, and stays it.
  void lay_out() {
    at_.theta_begin = model_.theta_begin();
    at_.spin_begin = model_.spin_begin();
    at_.mass.assign(b_.size(), 0.0);
    at_.damping.assign(b_.size(), 0.0);
    for (std::size_t k = 0; k < pattern_.size(); ++k) {
      const std::size_t i = pattern_.node(k);
      at_.place.push_back(model_.offset_of(i));
      at_.rate.push_back(model_.rate_offset_of(i));
      if (i >= model_.nodes) {
        lay_out_body(k, (i - model_.nodes) % 2 == 0 ? model_.bodies[(i - model_.nodes) / 2].mass : 0.0);
        continue;
      }
      at_.angle.push_back(B == 4 ? model_.twist_index[i] : -1);
      for (std::size_t c = 0; c < 3; ++c) set(k, c, !model_.holds_position(i), model_.moved_mass[i]);
      if (B == 4) set(k, 3, model_.turns(i), model_.inertia[i]);
    }
  }
  /// The inertia of a turn is no number an axis: see BodyBlocks.
  void lay_out_body(std::size_t k, double mass) {
    at_.angle.push_back(-1);
    for (std::size_t c = 0; c < 3; ++c) at_.mass[4 * k + c] = mass;
    if (B == 4) held_.push_back({pattern_.node(k), 3});
  }
  /// What holds a sliding node is as stiff as what does not: no pivot is lost beside another.
  void hold(const Model::Slider& slider) {
    matrix_.project(slider.node, slider.free);
    auto* diagonal = matrix_.find(slider.node, slider.node);
    double trace = 0.0;
    for (std::size_t c = 0; c < 3; ++c) trace += diagonal->column[c][c];
    diagonal->add(trace * (Mat3::Identity() - slider.free));
  }
  void set(std::size_t k, std::size_t c, bool free, double mass) {
    if (!free) {
      held_.push_back({pattern_.node(k), c});
      return;
    }
    at_.mass[4 * k + c] = mass;
    at_.damping[4 * k + c] = mass * model_.damping[pattern_.node(k)];
  }

  Evaluation take_time(const State& state, const Eigen::VectorXd& rate) {
    const double step = 1e-7 * std::max(1e-3, std::abs(state.time));
    const Evaluation at = system_.derivative(state, state.time + step, state.y, by_time_, work_);
    if (at.ok()) by_time_ = (by_time_ - rate) / step;
    return at;
  }

  /// Nodes before, at and after i, by what carries them.
  std::array<std::size_t, 3> around(std::size_t i) const {
    return {model_.has_before(i) ? model_.carrier[i - 1] : EdgeStiffness::kNone, model_.carrier[i],
            model_.has_after(i) ? model_.carrier[i + 1] : EdgeStiffness::kNone};
  }

  /// Needs the springs' gradient and all rates.
  void add_turning() {
    constexpr std::size_t kPack = TurningPack::kNodes;
    connections_.clear();
    connections_.reserve(model_.twist_nodes);
    for (const NodeRange& rod : model_.rods) {
      if (!model_.has_twist(rod.first)) continue;
      const std::size_t count = rod.count < kPack ? 1 : kPack;
      const std::size_t end = rod.first + rod.count;
      for (std::size_t i = rod.first; i < end; i += count) add_turning(std::min(i, end - count), i, count);
    }
  }

  /// That of `count` nodes from `first` on, of which those before `from` have been.
  void add_turning(std::size_t first, std::size_t from, std::size_t count) {
    constexpr std::size_t kBlocks = TurningPack::kBlocks;
    turning_terms(model_, first, count, work_.kinematics, work_.gradient, turns_);
    const std::size_t skip = kBlocks * (from - first);
    const auto place = [&](std::size_t k) {
      return place_of_turning(model_, from + k / kBlocks, k % kBlocks);
    };
    to_x_.blocks(kBlocks * count - skip, &turns_.by_x[skip], place);
    to_u_->blocks(kBlocks * count - skip, &turns_.by_v[skip], place);
    for (std::size_t i = from; i < first + count; ++i) {
      if (model_.holds_frame(i)) continue;
      const auto& by = turns_.connection[i - first];
      connections_.push_back(
          {i,
           around(i),
           {Eigen::Map<const Vec3>(by[0]), Eigen::Map<const Vec3>(by[1]), Eigen::Map<const Vec3>(by[2])}});
    }
  }

  /// After it the workspace holds the kinematics, with rates where they matter, and the springs' gradient,
  /// with its viscous part.
  Evaluation take_gradient(const State& state) {
    double heat = 0.0;
    auto& [kin, grad, loads, pull, tiles] = work_;
    const Motion what = rates_matter_ || turning_ ? Motion::all : Motion::positions;
    if (const Evaluation e = kinematics(model_, state, state.time, state.y, what, kin); !e.ok()) return e;
    const Inner inner{.viscous = turning_.has_value(), .gyroscopic = false};
    if (const Evaluation e = elastic(model_, state, inner, kin, grad, heat); !e.ok()) return e;
    no_loads(kin, loads);
    pull_back(model_, kin, grad, loads, pull);
    return {};
  }

  /// What (F_u - s M) C adds to a block is a row's angle column of F_u times c.by[a]; in the row of the angle
  /// itself also the inertia.
  struct Own {
    Block<B>* to;
    std::size_t angle;
    const double* by;
  };

  /// Where a connection adds, as far as the pattern goes.
  void link(std::size_t connection) {
    const Connection& c = connections_[connection];
    const std::size_t own = pattern_.pivot(c.node);
    const auto add = [&](std::size_t row) {
      const auto* from = by_u_->find(row, c.node);
      for (std::size_t a = 0; a < 3; ++a) {
        auto* to = c.from[a] == EdgeStiffness::kNone ? nullptr : matrix_.find(row, c.from[a]);
        if (!to) continue;
        links_.push_back({from->column[B - 1].data(), c.by[a].data(), to});
        if (row == c.node) own_links_.push_back({to, 4 * own + 3, c.by[a].data()});
      }
    };
    add(c.node);
    for (std::size_t e = pattern_.begin(own); e < pattern_.begin(own + 1); ++e)
      add(pattern_.node(pattern_.later(e)));
    for (const std::size_t e : pattern_.earlier(own)) add(pattern_.node(pattern_.low(e)));
  }

  void add_connections(double s) {
    if (links_.empty())
      for (std::size_t k = 0; k < connections_.size(); ++k) link(k);
    add_products(links_.size(), links_.data());
    for (const Own& own : own_links_) {
      const double inertia = s * at_.mass[own.angle] + at_.damping[own.angle];
      for (std::size_t c = 0; c < 3; ++c) own.to->column[c][3] -= inertia * own.by[c];
    }
  }

  double turned_by(const Connection& c) const {
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      if (c.from[a] != EdgeStiffness::kNone)
        sum += c.by[a].dot(Eigen::Map<const Vec3>(&b_[4 * pattern_.pivot(c.from[a])]));
    return sum;
  }

  const System& system_;
  const Model& model_;
  System::Workspace& work_;
  const LocalForces* local_;  ///< or null
  std::vector<Undifferentiated> undifferentiated_;
  bool loaded_, rates_matter_, timed_;
  BlockPattern pattern_;
  BlockMatrix<B> by_x_;
  BlockRoute<B> to_x_;
  BlockMatrix<B> matrix_;
  std::optional<BlockMatrix<B>> by_u_;
  std::optional<BlockRoute<B>> to_u_;
  std::optional<Differences<B>> differences_, local_differences_;
  std::vector<Connection> connections_;
  std::vector<BlockProduct> links_;  ///< of the connections, which keep their addresses
  std::vector<Own> own_links_;
  std::vector<Held> held_;
  PivotLayout at_;
  std::optional<FreeBodies> bodies_;
  std::vector<double> b_, x_;  ///< per pivot four
  BodyBlocks<B> rigid_;
  std::optional<ViscousTurning> turning_;
  TurningPack turns_;
};

}  // namespace

std::unique_ptr<StiffSolver> make_block_solver(const System& system, System::Workspace& work,
                                               const LocalForces* local) {
  if (system.twist_count() > 0) return std::make_unique<BlockSolver<4>>(system, work, local);
  return std::make_unique<BlockSolver<3>>(system, work, local);
}

}  // namespace tendril
