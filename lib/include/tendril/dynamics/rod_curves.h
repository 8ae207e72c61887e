#pragma once

#include <tendril/curve/control_forces.h>
#include <tendril/curve/curve_pair.h>
#include <tendril/dynamics/force.h>
#include <tendril/dynamics/system.h>

namespace tendril {

/// The axial curve-pairs of rods: primary curves through the masses p_i, orientation curves through the
/// orientation masses q_i = p_i + a_i m_i + b_i t_i, which move with the node frames as the rest shape has
/// them. Knots and parameters come from the rest shape and stay (Interpolator). A rod of fewer masses has a
/// lower degree. Where an edge is twisted by more than 60 degrees, and more than at rest, the curves of a
/// State have a turn (CurvePair::set_turn), so that frames follow the unwrapped twist, whatever it is.
/// World frame, the scene's units; a pair costs O(nodes of its rod).
class TENDRIL_CORE_API RodCurves {
 public:
  /// Throws InvalidInput, naming the rod, where the rest shape has no frames or no curve passes through it.
  /// \param rods    not kept
  /// \param degree  1 to kMaxDegree
  /// \param how     gives the parameters
  explicit RodCurves(std::span<const Rod> rods, int degree = 3,
                     Parametrisation how = Parametrisation::centripetal);
  /// Of the rods of a system, which is not kept.
  explicit RodCurves(const System& system, int degree = 3, Parametrisation how = Parametrisation::centripetal)
      : RodCurves(system.scene().rods, degree, how) {}

  std::size_t size() const { return rods_.size(); }  ///< of rods
  /// Of the masses on their rod's curve, in [0, 1].
  std::span<const double> parameters(std::size_t rod) const { return rods_.at(rod).fit.parameters(); }

  /// Of a rod's curve-pair, in every state.
  const KnotVector& knots(std::size_t rod) const { return rods_.at(rod).fit.knots(); }

  /// The curve-pair of a rod through masses p and orientation masses q, as many as it has nodes.
  CurvePair through(std::size_t rod, Points p, Points q) const;

  /// The curve-pairs at a state of a system of these rods, directors of rods without twist state included.
  /// Throws InvalidInput where the state has no frames.
  std::vector<CurvePair> pairs(const System& system, const State& state, System::Workspace& work) const;
  /// The same into pairs made before.
  void update(const System& system, const State& state, System::Workspace& work,
              std::span<CurvePair> pairs) const;

  /// The curve-pair of a rod at what a force sees, without turns. Throws InvalidInput where the rod's twist
  /// state is left out: it has no directors then, and a force that asks for them says twists().
  CurvePair pair(const StateView& state, std::size_t rod) const;

  /// How fast the control points of pair(state, rod) move, on the same knots: c' = sum N_i(t) of those of the
  /// primary curve is the velocity of the point c. Throws as pair() does.
  CurvePair rates(const StateView& state, std::size_t rod) const;
  /// Of each node of a rod, its orientation mass less its mass at what a force sees. Throws as pair() does.
  std::vector<Vec3> arms(const StateView& state, std::size_t rod) const;
  /// The control points of a rod's curve from the masses it passes through: row by row, each as weights of
  /// the masses that sum to 1. O(n^2).
  std::vector<std::vector<double>> interpolation(std::size_t rod) const;
  /// By how much control points move at most, in units of how far the farthest mass of the rod does: the
  /// largest row sum of |N^-1|, N the matrix of the interpolation. O(n^2).
  double gain(std::size_t rod) const;

  /// Adds what forces on the control points of pair(state, rod) mean for the masses (loads_on_masses): loads
  /// that do the same work when the masses move and their frames turn. Throws as pair() does, and on a wrong
  /// number of control points.
  void add_loads(const StateView& state, std::size_t rod, const ControlForces& forces,
                 const Loads& loads) const;

 private:
  struct One {
    Interpolator fit;
    std::size_t first;               ///< flat index of its first node
    std::vector<double> by_m, by_t;  ///< q - p in the rest frames
    std::vector<double> twist;       ///< of each edge at rest [rad]
  };

  std::vector<One> rods_;
};

}  // namespace tendril
