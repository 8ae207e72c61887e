#pragma once

#include <tendril/contact/collider.h>
#include <tendril/contact/law.h>

namespace tendril::contact {

/// The colliders of a force, checked.
struct Solids {
  /// \param thickest  radius of a ball that has to fit in their hollows
  Solids(std::vector<Collider> colliders, double thickest);

  std::vector<Collider> all;
  bool driven = false;              ///< some collider is
  std::vector<std::size_t> bodies;  ///< of the scene that are colliders, ascending

  std::size_t size() const { return all.size(); }
  const Collider& operator[](std::size_t i) const { return all[i]; }
  std::vector<Placement> place(const StateView& state) const;
  std::vector<double> breaks() const;  ///< times where a velocity jumps, ascending
  /// InvalidInput where a body is not of the scene.
  void check_bodies(std::size_t bodies) const;
  /// "collider 3 (floor)"
  std::string named(std::size_t i) const;
};

}  // namespace tendril::contact
