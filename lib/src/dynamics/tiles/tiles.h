#pragma once

#include "dynamics/rhs/workspace.h"
#include "dynamics/vector/combine.h"

namespace tendril {

/// The nodes of a large scene in ranges whose arrays the cache holds: all stages of a step go through one
/// range before the next, and numbers between them come from the cache and not from memory. A range has
/// beside its own nodes those that these feel within a step, which its neighbours compute again.
///
/// For scenes in which nothing but the rods' own springs passes on what a node feels: no loads, joints,
/// bodies, slides, swivels nor viscosity.
class Tiles {
 public:
  /// Answers for the nodes [first, end) of the scene; those of its part begin at the scene's node `begin`.
  struct Tile {
    std::size_t first, end, begin;
    std::size_t part;               ///< which of all parts
    std::vector<double> constants;  ///< its own, where other tiles may be that part, too
    std::vector<NumbersAt> all;     ///< of the scene's y, for the part's; not the work
    std::vector<NumbersAt> own;     ///< of the part's y, what it answers for: for the scene's
    std::vector<NumbersAt> before;  ///< of the scene's y, what it feels before its own: for the part's
    std::vector<NumbersAt> after;   ///< of the next tile's y, what it feels behind them: for the part's
    std::size_t workspace;          ///< which of a scratch's it may use: tiles alike share one
  };

  explicit Tiles(const Model& model);

  const std::vector<Tile>& all() const { return tiles_; }
  /// Tiles that differ in their constants alone are one part, with those of the first.
  const std::vector<std::shared_ptr<const Model>>& parts() const { return parts_; }

 private:
  const Model& shape_of(const Tile& tile) const { return *parts_[tile.part]; }
  std::size_t add(const std::shared_ptr<const Model>& part);
  void number_workspaces();
  void join(const Model& model);

  std::vector<Tile> tiles_;
  std::vector<std::shared_ptr<const Model>> parts_;
};

/// Those of a scene that is worth it; else null.
std::shared_ptr<const Tiles> tiles_for(const Model& model);

/// Scratch arrays for one tile after the other.
class TileScratch {
 public:
  /// \param whole  with tiles
  /// \param work  of the whole; keeps it
  static TileScratch& of(const Model& whole, System::Workspace& work);

  /// The tile's part of a state, until the next is asked for; its work is 0. Its model gets its constants.
  const State& take(const Tiles::Tile& tile, const State& from);
  /// The reference frames alone.
  const State& take_reference(const Tiles::Tile& tile, const State& from);
  System::Workspace& workspace(const Tiles::Tile& tile) { return *workspaces_[tile.workspace]; }
  /// With the constants of that of its tiles that was taken last.
  const Model& model(const Tiles::Tile& tile) const { return *parts_[tile.part]; }

 private:
  explicit TileScratch(const Tiles& tiles);

  State state_;
  std::vector<std::shared_ptr<const Model>> parts_;
  // Copies of those that several tiles may be, else null. Such a tile's constants are read in a row, once a
  // step, to where the cache holds them: columns of its own would be read from memory one by one.
  std::vector<std::shared_ptr<Model>> shared_;
  std::vector<std::unique_ptr<System::Workspace>> workspaces_;
};

/// A node that an anchor holds.
struct AnchoredNode {
  std::size_t node, anchor;
};
/// All of a scene, by node.
std::vector<AnchoredNode> anchored_nodes(const Model& model);

/// The nodes [first, end) as a scene of their own. Rods that go on there end; only what happens at the nodes
/// [own_first, own_end) counts in its power.
/// \param anchored  all of the whole
std::shared_ptr<Model> part_of(const Model& whole, const std::vector<AnchoredNode>& anchored,
                               std::size_t first, std::size_t end, std::size_t own_first,
                               std::size_t own_end);

/// What distinguishes a part from others of its shape: masses, springs and rest lengths, one column after the
/// other.
std::vector<double> constants_of(const Model& part);
void put_constants(const std::vector<double>& constants, Model& part);
/// Whether anchors hold nodes of it, which no other part has.
bool has_anchors(const Model& part);
/// Of parts without anchors.
bool alike_but_for_constants(const Model& a, const Model& b);

}  // namespace tendril
