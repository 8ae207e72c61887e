#pragma once

#include <tendril/base/types.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/dynamics/anchor.h>
#include <tendril/dynamics/rod_points.h>

#include <array>
#include <functional>
#include <optional>
#include <string>

/// Solids of a scene, and where rods are in contact with them. In the scene's units.
namespace tendril::scene {

/// The shape of a solid in its own frame, as the file has it.
struct SolidShape {
  /// half_space z <= 0; the others about the origin, those with an axis about z.
  enum class Type { half_space, ball, capsule, box, cylinder, tube, mesh };
  Type type = Type::ball;    ///< which of them
  double radius = 0.0;       ///< of a ball, a capsule, a cylinder; outside of a tube
  double inner = 0.0;        ///< radius, of a tube
  double half = 0.0;         ///< length of a capsule's line, a cylinder or a tube, over 2
  Vec3 size = Vec3::Zero();  ///< half the edges of a box
  std::shared_ptr<const bind::PolygonMesh> mesh = {};  ///< the surface of a mesh; else null
};

/// A solid of the scene: fixed, driven or free.
struct SceneBody {
  std::string name;                               ///< of its own
  SolidShape shape;                               ///< in its frame
  AnchorPose pose;                                ///< at the start; the frame's axes x, y, z in the world
  std::optional<std::size_t> free;                ///< index among Scene::bodies
  std::function<AnchorPose(double)> motion = {};  ///< of what is driven
  std::string pointer;                            ///< its JSON pointer
};

/// Where the frame of a solid is at a moment.
struct SolidPose {
  Mat3 rotation = Mat3::Identity();  ///< its axes, as columns
  Vec3 position = Vec3::Zero();      ///< its origin
};

/// A point of a rod's line in contact with a solid.
struct ContactPoint {
  std::size_t curve_pair;  ///< index
  std::size_t node;        ///< the point is p_node + fraction (p_(node + 1) - p_node)
  double fraction;         ///< in [0, 1]
  std::size_t body;        ///< index
  double gap;              ///< between the surfaces [length]
  Vec3 point;              ///< on the rod's line
  Vec3 normal;             ///< away from the solid, unit
  Vec3 force;              ///< on the rod, friction included
  Vec3 friction;           ///< of it
  bool sticks;             ///< friction below mu N
};

/// Two points of rods' lines in contact with each other.
struct RodContactPoint {
  std::array<std::size_t, 2> curve_pair;  ///< indices; the same where a rod meets itself
  std::array<std::size_t, 2> node;        ///< points are p_node + fraction (p_(node + 1) - p_node)
  std::array<double, 2> fraction;         ///< in [0, 1]
  double gap;                             ///< between the surfaces [length]
  Vec3 point;                             ///< between them
  Vec3 normal;                            ///< from the second to the first, unit
  Vec3 force;                             ///< on the first, friction included
  Vec3 friction;                          ///< of it
  bool sticks;                            ///< friction below mu N
};

/// A point of the scene's mesh in contact with a solid.
struct MeshContactPoint {
  std::size_t face;  ///< of the mesh
  std::size_t body;  ///< index
  double gap;        ///< between the solid and the skin [length]
  Vec3 point;        ///< on the face
  Vec3 normal;       ///< away from the solid, unit
  Vec3 force;        ///< on the mesh, friction included
  Vec3 friction;     ///< of it
  bool sticks;       ///< friction below mu N
};

/// Two places of the scene's mesh in contact with each other.
struct MeshSelfContactPoint {
  std::array<std::size_t, 2> face;  ///< of the mesh: one that each is on
  double gap;                       ///< between the two skins [length]
  Vec3 point;                       ///< half way
  Vec3 normal;                      ///< from the second to the first, unit
  Vec3 force;                       ///< on the first, friction included
  Vec3 friction;                    ///< of it
  bool sticks;                      ///< friction below mu N
};

/// A contact of a mesh, made once the mesh is bound: of vertices, where they rest, and triangles.
using MeshContact =
    std::function<std::shared_ptr<const Force>(std::shared_ptr<const RodPoints>, const std::vector<Vec3>&,
                                               const std::vector<std::array<std::uint32_t, 3>>&)>;

/// A contact of the scene's mesh, which waits for it.
struct MeshForce {
  MeshContact make = {};                  ///< empty where there is none
  std::string place = {};                 ///< its JSON pointer
  std::optional<std::size_t> force = {};  ///< its index among the scene's forces, once a SceneRun made it
};

}  // namespace tendril::scene
