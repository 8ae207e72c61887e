#pragma once

#include "ply_header.h"

/// What the properties of a PLY file's vertices and faces are used for.
namespace tendril::bind::ply {

/// What the value of a property is used for.
enum Slot : std::size_t {
  x,
  y,
  z,
  nx,
  ny,
  nz,
  red,
  green,
  blue,
  alpha,
  tex_s,
  tex_t,
  slot_count,
  indices,
  texcoord,
  unused
};
inline constexpr std::array<std::string_view, alpha + 1> slot_names{"x",  "y",   "z",     "nx",   "ny",
                                                                    "nz", "red", "green", "blue", "alpha"};

/// Which slot each property of an element fills.
struct Plan {
  std::vector<Slot> slots;
  std::array<bool, slot_count> has{};
  bool has_indices = false;

  bool normals() const { return has[nx] && has[ny] && has[nz]; }
  bool colors() const { return has[red] && has[green] && has[blue]; }
  bool texture() const { return has[tex_s] && has[tex_t]; }
};

Slot slot_of(const PlyProperty& property, bool face);
Plan make_plan(const PlyElement& element, bool face);

}  // namespace tendril::bind::ply
