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
  /// Answers for the nodes [first, end) of the scene; those of `part` begin at the scene's node `begin`.
  struct Tile {
    std::size_t first, end, begin;
    std::shared_ptr<const Model> part;
    std::vector<NumbersAt> all;     ///< of the scene's y, for the part's; not the work
    std::vector<NumbersAt> own;     ///< of the part's y, what it answers for: for the scene's
    std::vector<NumbersAt> before;  ///< of the scene's y, what it feels before its own: for the part's
    std::vector<NumbersAt> after;   ///< of the next tile's y, what it feels behind them: for the part's
    std::size_t workspace;          ///< which of a scratch's it may use: tiles alike share one
  };

  explicit Tiles(const Model& model);

  const std::vector<Tile>& all() const { return tiles_; }

 private:
  void number_workspaces();
  void join(const Model& model);

  std::vector<Tile> tiles_;
};

/// Those of a scene that is worth it; else null.
std::shared_ptr<const Tiles> tiles_for(const Model& model);

/// Scratch arrays for one tile after the other.
class TileScratch {
 public:
  /// \param whole  with tiles
  /// \param work  of the whole; keeps it
  static TileScratch& of(const Model& whole, System::Workspace& work);

  /// The tile's part of a state, until the next is asked for; its work is 0.
  const State& take(const Tiles::Tile& tile, const State& from);
  /// The reference frames alone.
  const State& take_reference(const Tiles::Tile& tile, const State& from);
  System::Workspace& workspace(const Tiles::Tile& tile) { return *workspaces_[tile.workspace]; }

 private:
  explicit TileScratch(const Tiles& tiles);

  State state_;
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
std::shared_ptr<const Model> part_of(const Model& whole, const std::vector<AnchoredNode>& anchored,
                                     std::size_t first, std::size_t end, std::size_t own_first,
                                     std::size_t own_end);

}  // namespace tendril
