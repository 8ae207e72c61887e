#include "obj_attributes.h"

namespace tendril::bind {
namespace {

using Ids = std::vector<std::uint32_t>;
constexpr std::uint32_t kNone = ObjAttributes::kNone;

/// The entry of each point that is in a face, where all its corners name the same value.
/// \param odd  gets a point whose corners do not
template <class Value>
bool by_point(const PolygonMesh& mesh, const Ids& of_corner, const std::vector<Value>& values, Ids& of_point,
              std::uint32_t& odd) {
  of_point.assign(mesh.points.size(), kNone);
  for (std::size_t c = 0; c < of_corner.size(); ++c) {
    std::uint32_t& mine = of_point[mesh.corners[c]];
    if (mine == kNone) mine = of_corner[c];
    if (mine == of_corner[c] || of_corner[c] == kNone || values[mine] == values[of_corner[c]]) continue;
    odd = mesh.corners[c];
    return false;
  }
  return true;
}

void give_normals(const ObjAttributes& from, PolygonMesh& mesh, const std::string& name, const Notes& notes) {
  Ids of_corner = from.normal_of_corner, of_point;
  if (of_corner.empty()) return;
  of_corner.resize(mesh.corners.size(), kNone);
  std::uint32_t odd = 0;
  const auto drop = [&](const char* why) {
    notes.mention(name + ": vertex " + std::to_string(odd) + why + ": normals dropped");
  };
  if (!by_point(mesh, of_corner, from.normals, of_point, odd)) return drop(" has several normals");
  for (const std::uint32_t corner : mesh.corners)
    if (of_point[odd = corner] == kNone) return drop(" has no normal");
  for (const std::uint32_t id : of_point)
    mesh.point_normals.push_back(id == kNone ? Vec3(0, 0, 0) : from.normals[id]);
}

void give_texture(const ObjAttributes& from, PolygonMesh& mesh, const std::string& name, const Notes& notes) {
  Ids of_corner = from.texture_of_corner, of_point;
  if (of_corner.empty()) return;
  of_corner.resize(mesh.corners.size(), kNone);
  const auto missing = std::count(of_corner.begin(), of_corner.end(), kNone);
  if (missing > 0)
    notes.mention(name + ": " + std::to_string(missing) + " corners without texture coordinates: 0 0");
  const auto value = [&](std::uint32_t id) { return id == kNone ? TextureCoordinate{} : from.textures[id]; };
  std::uint32_t odd = 0;
  if (missing == 0 && by_point(mesh, of_corner, from.textures, of_point, odd))
    std::transform(of_point.begin(), of_point.end(), std::back_inserter(mesh.point_texture), value);
  else
    std::transform(of_corner.begin(), of_corner.end(), std::back_inserter(mesh.corner_texture), value);
}

}  // namespace

void ObjAttributes::give(PolygonMesh& mesh, const std::string& name, const Notes& notes) const {
  give_normals(*this, mesh, name, notes);
  give_texture(*this, mesh, name, notes);
}

}  // namespace tendril::bind
