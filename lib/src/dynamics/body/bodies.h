#pragma once

#include "dynamics/scene/model.h"

namespace tendril {

// The part of the equations of motion that free bodies are: each function is called where a model has any.

/// The bodies at y, as forces see them.
Evaluation place_bodies(const Model& model, const State& reference, const Eigen::VectorXd& y,
                        std::vector<BodyView>& bodies);

/// Their part of y', from what acts on them beside the gravity of the model. False where it is not finite.
bool body_rates(const Model& model, const Eigen::VectorXd& y, const std::vector<BodyView>& bodies,
                const std::vector<Wrench>& loads, Eigen::VectorXd& dy);

/// Forces and torques, laid out like u' and omega' in y'.
void put_body_loads(const Model& model, const std::vector<Wrench>& loads, Eigen::VectorXd& out);

/// The power of loads.
double power_on_bodies(const std::vector<BodyView>& bodies, const std::vector<Wrench>& loads);

/// Adds their kinetic energy, and their potential one in the gravity of the model.
void add_body_energies(const Model& model, const std::vector<BodyView>& bodies, Energies& to);

/// Puts them into a state as the scene says.
void start_bodies(const Model& model, State& state);

/// Writes a body into a state, as its own reference.
void put_body(const Model& model, std::size_t body, const BodyView& to, State& state);

/// Makes the present rotations the reference.
void rebase_bodies(const Model& model, const std::vector<BodyView>& bodies, State& state);

/// Puts phi and omega half-way through a step into `middle`: of the cubic in phi through both ends. Where it
/// begins phi is 0.
void bend_turns(const Model& model, double h, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                Eigen::VectorXd& middle);

/// What phi moved by about the principal axes (those of the state's reference), counted from the state's own,
/// as a move about the world's axes.
void turn_from_principal_axes(const Model& model, const State& state, Eigen::VectorXd& y);

/// omega' about the principal axes.
void turn_to_principal_axes(const Model& model, const State& state, Eigen::VectorXd& dy);

/// An upper bound of the frequency at which spinning bodies nutate: twice the spin [rad / time]. One of equal
/// moments does not.
double fastest_nutation(const Model& model, const State& state);

}  // namespace tendril
