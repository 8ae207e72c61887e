#pragma once

#include <cassert>
#include <cstdint>
#include <memory>

#include "dynamics/scene/model.h"
#include "dynamics/vector/columns.h"

namespace tendril {

/// What kinematics are filled: positions and frames; what the springs need, with rates; or all, with rates.
enum class Motion { positions, springs, all };

// Scratch columns of one evaluation, one entry per node (edges by their first node). The edge entry of a
// rod's last node belongs to no edge: it is kept at 0, so that loops need not know where rods end.

/// Positions, velocities, edges and frames. The rates are those of edges and tangents.
struct Kinematics {
  std::vector<AnchorPose> pose;  ///< per anchor
  Columns3 p, v, e;
  FrameColumns frame;
  Column length, inverse_length;
  Column inverse_bisector;  ///< of the unit edges' sum; 0 where the frame is held
  Column spin;
  std::vector<double> swivel_spin;  ///< per swivel, about its axis
  std::vector<BodyView> bodies;     ///< whole with the positions

  struct Rates {
    Columns3 e_rate;
    Columns3 turning;  ///< of the tangents, t x t'
    Column length_rate, connection;
  };
  Rates rate;

  Vec3 t_rate(std::size_t i) const { return Vec3(rate.turning[i]).cross(Vec3(frame.z[i])); }

  /// Counts how often they were begun; what is made from them notes the number.
  std::uint64_t number = 0;
  bool whole = false;  ///< filled to the end
  Motion filled = Motion::positions;

  bool has_positions() const { return whole; }
  bool has_rates() const { return whole && filled != Motion::positions; }
  bool has_frames() const { return whole && filled != Motion::springs; }  ///< of rods without twist, too
};

/// Notes at which kinematics a part was filled.
struct Made {
  std::uint64_t number = 0;
  void from(const Kinematics& kin) { number = kin.number; }
  /// Whether it belongs to these kinematics: false where they were filled anew since.
  bool fits(const Kinematics& kin) const { return kin.whole && number == kin.number; }
};

/// Gradients of the energy (with the viscous part where asked for): by the unit edges, as the springs at
/// their two nodes give it and as the tangents pass it on, by the tangents and by the spins.
struct Gradient {
  Columns3 bend;           ///< by the edge after a free node, minus that by the edge before
  Columns3 before, after;  ///< by the edges at a held frame; elsewhere they stay 0
  Columns3 tangent;        ///< across the tangent
  Column spin, length;
  Columns3 twist_tangent;               ///< per edge: what its twist spring gives either tangent
  Column twist_torque;                  ///< per edge
  Column twist_strain;                  ///< per edge, where the viscous part was asked for and some resists
  std::vector<Vec3> swivel;             ///< per swivel, as a torque on its frame, minus it; loads count
  std::vector<EdgeAngles> child_edges;  ///< of the hubs' children in turn, their first edges
  Columns3 given;       ///< per child's root, what its hub gives way of (l, m, twist); elsewhere 0
  Column energy, heat;  ///< per edge or node, of one kind of springs at a time
  Made made;
};

/// What forces other than gravity see and give; empty without them, and what is of frames where none acts on
/// those.
struct LoadColumns {
  std::vector<Vec3> p, v, t, m, turn;
  std::vector<double> spin;
  std::vector<Vec3> load, torque;
  std::vector<Wrench> on_bodies;  ///< there also without forces, for the bodies' rates
  Made made;
};

/// Forces along the edges, and on the masses.
struct Pull {
  Columns3 edge_force, force;
};

/// What a tile needs beside; see tiles.h.
class TileScratch;

class System::Workspace {
 public:
  explicit Workspace(const Model& model);

  Kinematics kinematics;
  Gradient gradient;
  LoadColumns loads;
  Pull pull;
  std::shared_ptr<TileScratch> tiles;  ///< null until they are needed
};

}  // namespace tendril
