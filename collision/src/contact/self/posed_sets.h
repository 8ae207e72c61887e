#pragma once

#include <tendril/collision/box_tree.h>

#include <array>
#include <memory>

#include "self_mesh.h"

namespace tendril::contact {

/// A direction, near enough of length 1; 0 where none is known.
using Direction = std::array<float, 3>;

/// Sets of vertices where they are, or at the beginning and the end of their ways: boxes about them, and what
/// single precision makes of the way to each from the set's first. What belongs to a set lies together, as
/// reading it takes longer than what is done with it.
class PosedSets {
 public:
  /// Of no set so far.
  /// \param sets  kept by reference
  /// \param at, after  where all vertices are at the beginning and the end, kept by reference; the same where
  /// they stay
  PosedSets(const VertexSets& sets, std::span<const Vec3> at, std::span<const Vec3> after);
  /// Sets [begin, end).
  void take(std::size_t begin, std::size_t end);

  /// 1 where they stay, 2 where they go.
  std::size_t ends() const { return ends_; }
  const collision::Box& box(std::size_t set, std::size_t end) const { return about(set, end).box; }
  /// Of the boxes.
  Vec3 middle(std::size_t set) const;

  /// How far set q lies behind set p along n at an end, or less.
  struct Along {
    double apart;
    Vec3 way;  ///< to the vertex of p that says so from that of q
  };
  Along along(std::size_t p, std::size_t q, const Direction& n, std::size_t end) const;
  /// Whether it lies farther than that at each end.
  bool part(std::size_t p, std::size_t q, const Direction& n, double far) const;

 private:
  static constexpr std::size_t kLane = VertexSets::kLane;
  using Some = Eigen::Array<float, kLane, 1>;
  struct Block {
    Some x, y, z;
  };
  struct About {
    collision::Box box;
    Vec3 first;
    double size;  ///< the box' diagonal; infinite where single precision might overflow
  };
  struct Nearest {
    float reach;
    std::uint32_t vertex;
  };

  const About& about(std::size_t set, std::size_t end) const { return about_[set * ends() + end]; }
  std::size_t blocks(std::size_t set) const { return (sets_.begin[set + 1] - sets_.begin[set]) / kLane; }
  const Block* block(std::size_t set, std::size_t end) const {
    return &blocks_[sets_.begin[set] / kLane * ends() + end * blocks(set)];
  }
  static Some reach(const Block& of, const Direction& n);
  /// How little a set reaches along n from its first at an end, and which of it.
  float least(std::size_t set, std::size_t end, const Direction& n) const;
  Nearest nearest(std::size_t set, std::size_t end, const Direction& n) const;
  /// What is left of how far they are apart where both reach so far along n and back.
  double apart(const About& p, const About& q, const Direction& n, double both) const;

  const VertexSets& sets_;
  std::array<std::span<const Vec3>, 2> at_;
  std::size_t ends_;
  std::vector<About> about_;
  std::unique_ptr<Block[]> blocks_;
};

}  // namespace tendril::contact
