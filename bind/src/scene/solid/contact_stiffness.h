#pragma once

#include <tendril/contact/collider.h>
#include <tendril/dynamics/scene.h>

#include <vector>

/// The stiffness of contact where a file names none: a barrier carries a share of what falls, or comes at the
/// speed that the file says, wherever it lands.
namespace tendril::scene {

/// What falls in a scene, or comes otherwise.
struct Falling {
  double g = 0.0;       ///< 0 without gravity
  double energy = 0.0;  ///< of a unit of mass; 0 where nothing falls and nothing is said to move
  double mass = 0.0, heaviest = 0.0;   ///< of all rods, and of one
  double length = 0.0, longest = 0.0;  ///< of the same
};
/// \param speed  at which things may meet besides
/// \param fall   how far; at least by the longest rod
Falling falling_of(const Scene& scene, double speed, double fall);

/// Per length of rods that meet solids.
/// \param radius  the least of rods
double solids_stiffness(const Scene& scene, const Falling& falling,
                        const std::vector<contact::Collider>& colliders, double range, double radius);
/// Per length of free bodies that meet solids and each other, corners among them.
double bodies_stiffness(const Scene& scene, const Falling& falling,
                        const std::vector<contact::Collider>& colliders, double range);
/// Per length of rods that meet each other.
double crossing_stiffness(const Scene& scene, const Falling& falling, double range, double radius);

/// Per area of a mesh that meets solids.
/// \param energy    of what falls
/// \param area      of the mesh at rest
/// \param vertices  it has
double surface_stiffness(double energy, const std::vector<contact::Collider>& colliders, double skin,
                         double range, double area, std::size_t vertices);
/// The same of balls with the solids' radii.
double balls_stiffness(double energy, const std::vector<contact::Collider>& colliders, double skin,
                       double range);
/// Per area of meshes that meet each other.
/// \param triangle  its mean area
double sheets_stiffness(double energy, double skin, double range, double triangle);

}  // namespace tendril::scene
