#include <tendril/base/error.h>

#include "dynamics/body/bodies.h"
#include "dynamics/rhs/elastic.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/rhs/pull_back.h"
#include "dynamics/rhs/rates.h"
#include "dynamics/tiles/tiles.h"
#include "dynamics/vector/finite.h"

namespace tendril {
namespace {

using Workspace = System::Workspace;

std::unique_ptr<const Model> make_model(Scene scene, double from) {
  auto model = std::make_unique<Model>(std::move(scene), from);
  model->tiles = tiles_for(*model);
  return model;
}

}  // namespace

System::System(Scene scene, double from) : model_(make_model(std::move(scene), from)) {}
System::~System() = default;
System::System(System&&) noexcept = default;
System& System::operator=(System&&) noexcept = default;

System::WorkspacePtr System::make_workspace() const {
  return WorkspacePtr(new Workspace(*model_));
}

void System::Release::operator()(Workspace* work) const {
  delete work;
}

std::span<const NodeRange> System::rods() const {
  return model_->rods;
}
std::size_t System::node_count() const {
  return model_->nodes;
}
std::size_t System::twist_count() const {
  return model_->twist_nodes;
}
std::size_t System::body_count() const {
  return model_->bodies.size();
}
const Scene& System::scene() const {
  return model_->scene;
}
const std::vector<std::string>& System::left_out() const {
  return model_->left_out;
}

State System::rest_state(double time) const {
  State state;
  state.time = time;
  state.y = Eigen::VectorXd::Zero(model_->size());
  for (std::size_t i = 0; i < model_->nodes; ++i) {
    state.y.segment<3>(3 * static_cast<Eigen::Index>(i)) = model_->rest_p[i];
    state.tangent.push_back(model_->rest_frame[i].z);
    state.director.push_back(model_->rest_frame[i].y);
  }
  state.twist = model_->rest_twist;
  start_bodies(*model_, state);
  const auto work = make_workspace();
  if (!rebase(state, *work).ok())
    throw InvalidInput("anchors", "the poses at the start leave no frame at some node",
                       "poses near the rest shape");
  return state;
}

Evaluation System::derivative(const State& reference, double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy,
                              Workspace& work) const {
  return rates(*model_, reference, t, y, dy, work);
}

Evaluation System::elastic_gradient(const State& reference, double t, const Eigen::VectorXd& y,
                                    double& energy, Eigen::VectorXd& gradient, Workspace& work) const {
  const Model& model = *model_;
  auto& [kin, grad, loads, pull, tiles] = work;
  if (const Evaluation at = kinematics(model, reference, t, y, Motion::positions, kin); !at.ok()) return at;
  if (const Evaluation at = elastic_energy(model, reference, kin, grad, energy); !at.ok()) return at;
  no_loads(kin, loads);
  pull_back(model, kin, grad, loads, pull);
  gradient.resize(model.v_begin() + static_cast<Eigen::Index>(model.twist_nodes));
  for (std::size_t i = 0; i < model.nodes; ++i) {
    gradient.segment<3>(3 * static_cast<Eigen::Index>(i)) = -pull.force[i];
    if (model.has_twist(i)) gradient[model.v_begin() + model.twist_index[i]] = grad.spin[i];
  }
  return {};
}

Energies System::energies(const State& state, Workspace& work) const {
  const Model& model = *model_;
  Energies result;
  auto& [kin, grad, loads, pull, tiles] = work;
  const Motion what = model.acts_on_frames ? Motion::all : Motion::springs;
  if (!all_finite(state.y)) return result;
  if (!kinematics(model, state, state.time, state.y, what, kin).ok()) return result;
  if (!elastic_energy(model, state, kin, grad, result.elastic).ok()) return result;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    if (!model.holds_position(i)) result.kinetic += 0.5 * model.moved_mass[i] * kin.v[i].squaredNorm();
    if (model.has_twist(i) && !model.holds_frame(i))
      result.kinetic += 0.5 * model.inertia[i] * kin.spin[i] * kin.spin[i];
    result.potential -= model.mass[i] * model.gravity.dot(kin.p[i]);
  }
  for (const Model::Slider& slider : model.sliders)
    result.kinetic -=
        0.5 * model.moved_mass[slider.node] * slider.carried(kin.pose[slider.anchor]).squaredNorm();
  for (const Model::Swivel& swivel : model.swivels) {
    const double w = state.y[model.spin_begin() + model.twist_index[swivel.node]];
    result.kinetic += 0.5 * model.inertia[swivel.node] * w * w;
  }
  add_body_energies(model, kin.bodies, result);
  if (!model.loaded) return result;
  StateView seen = view(model, state.time, kin, loads);
  for (const Model::Acting& acting : model.acting) {
    if (!acting.has_energy) continue;
    seen.memory = memory_of(acting, state);
    result.potential += acting.force->energy(seen);
  }
  return result;
}

std::vector<BodyView> System::bodies(const State& state) const {
  std::vector<BodyView> bodies(body_count());
  if (const Evaluation at = place_bodies(*model_, state, state.y, bodies); !at.ok()) return {};
  return bodies;
}

void System::set_body(State& state, std::size_t body, const BodyView& to) const {
  if (body >= body_count())
    throw InvalidInput("body", std::to_string(body), "less than " + std::to_string(body_count()));
  if (!is_rotation(to.rotation))
    throw InvalidInput("rotation", "not orthonormal, or mirrored", "a rotation to 1e-9");
  put_body(*model_, body, to, state);
}

Evaluation System::refusal(const State& state, Workspace& work) const {
  return tendril::refusal(*model_, state, work);
}

}  // namespace tendril
