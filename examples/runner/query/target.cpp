#include "query/target.h"

#include "query/still_points.h"
#include "read/axes.h"
#include "read/mesh_reader.h"

#include <tendril/base/file.h>
#include <tendril/bind/binding_points.h>
#include <tendril/scene/bound_mesh.h>

#include <algorithm>
#include <functional>
#include <numeric>

namespace tendril::runner {
namespace {

struct Fans {
  std::vector<collision::Triangle> triangles;
  std::vector<std::size_t> face;

  std::vector<std::uint32_t> corners() const {
    std::vector<std::uint32_t> out;
    for (const collision::Triangle& t : triangles) out.insert(out.end(), t.begin(), t.end());
    return out;
  }
};

Fans fans_of(const bind::PolygonMesh& mesh, const std::string& path) {
  if (mesh.face_count() == 0) throw InvalidInput(path, "no faces", "a mesh of at least one face");
  Fans out;
  out.triangles = bind::fan_triangles(mesh, &out.face);
  return out;
}

/// A point of each part that is connected by the corners its triangles share.
std::vector<std::uint32_t> parts_of(const Fans& fans, std::size_t points) {
  std::vector<std::uint32_t> above(points);
  std::iota(above.begin(), above.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (above[i] != i) i = above[i] = above[above[i]];
    return i;
  };
  for (const auto& [a, b, c] : fans.triangles) {
    above[root(a)] = root(b);
    above[root(b)] = root(c);
  }
  std::vector<std::uint32_t> out;
  for (const collision::Triangle& t : fans.triangles) out.push_back(root(t[0]));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Target standing(const std::string& path, const Fans& fans, const std::vector<Vec3>& points) {
  std::vector<Vec3> parts;
  for (const std::uint32_t i : parts_of(fans, points.size())) parts.push_back(points[i]);
  return {path, exact::Surface(points, fans.corners()), fans.face, parts};
}

/// \param at  where a point is in the pose
Target following(const std::string& path, const Fans& fans, const BoundPoints& points, const Axes& axes,
                 const std::function<Vec3(std::uint32_t)>& at) {
  std::vector<Vec3> parts;
  for (const std::uint32_t i : parts_of(fans, points.size())) parts.push_back(at(i));
  exact::BoundSurface surface(axes.rest, points, fans.triangles);
  surface.pose(axes.posed);
  return {path, std::move(surface), fans.face, parts};
}

Target following(const std::string& path, const Fans& fans, const bind::Binding& binding, Axes axes) {
  if (axes.posed.empty()) axes.posed = axes.rest;
  return following(path, fans, bind::BindingPoints(binding), axes,
                   [&](std::uint32_t i) { return binding.at(axes.posed, i); });
}

/// With points that are out of reach, and stay.
Target following(const std::string& path, const Fans& fans, const scene::BoundMesh& bound, const Axes& axes) {
  const std::vector<Vec3>& rest = bound.mesh().points;
  const auto still = bound.out_of_reach();
  Axes twice = axes;
  for (std::vector<CurvePair>* pairs : {&twice.rest, &twice.posed})
    pairs->insert(pairs->end(), axes.rest.begin(), axes.rest.end());
  Target out = following(path, fans, StillPoints(bound.binding(), still, rest), twice, [&](std::uint32_t i) {
    const bool stays = std::binary_search(still.begin(), still.end(), std::size_t{i});
    return stays ? rest[i] : bound.binding().at(axes.posed, i);
  });
  out.out_of_reach = still.size();
  return out;
}

/// The scene's curve-pairs as curve files would give them, so that poses fit their knots.
std::vector<scene::CurveFile> curves_of(const scene::SceneFile& file) {
  std::vector<scene::CurveFile> out;
  for (const Rod& rod : file.scene.rods) {
    const int degree = std::min(file.options.degree, static_cast<int>(rod.p.size()) - 1);
    const Interpolator fit(degree, rod.p, file.options.parametrisation);
    out.push_back({CurvePair(fit.knots(), fit.solve(rod.p), fit.solve(rod.q)), rod.p, fit, file.path});
  }
  return out;
}

std::vector<CurvePair> pose_of(const scene::SceneFile& file, const std::vector<scene::CurveFile>& rest,
                               const std::string& pose) {
  std::vector<CurvePair> out;
  if (pose.empty()) {
    for (const scene::CurveFile& curve : rest) out.push_back(curve.pair);
    return out;
  }
  for (const scene::CurveFile& curve : scene::read_curves(pose, rest)) {
    const std::size_t k = out.size();
    if (!(curve.pair.knots() == rest[k].pair.knots()))
      throw InvalidInput(curve.place,
                         "its knots or degree differ from those of the scene's '" + file.names[k] + "'",
                         "the same, or a chain of its " + std::to_string(rest[k].masses.size()) + " masses");
    out.push_back(curve.pair);
  }
  return out;
}

Target of_scene(const std::string& path, const Posing& posing) {
  const scene::SceneFile file = scene::read_scene(path);
  if (file.mesh.empty()) throw InvalidInput(path + "#", "the key 'mesh' is missing", "a scene with a mesh");
  bind::PolygonMesh mesh = read_mesh(file);
  const Fans fans = fans_of(mesh, file.mesh);
  const std::vector<scene::CurveFile> rest = curves_of(file);
  const std::vector<CurvePair> posed = pose_of(file, rest, posing.pose);
  const scene::BoundMesh bound(file, std::move(mesh), posing.mode);
  Axes axes;
  for (const std::size_t k : file.bound_to) {
    axes.rest.push_back(rest[k].pair);
    axes.posed.push_back(posed[k]);
  }
  return bound.out_of_reach().empty() ? following(file.mesh, fans, bound.binding(), axes)
                                      : following(file.mesh, fans, bound, axes);
}

Target of_mesh(const std::string& path, const Posing& posing) {
  const bind::PolygonMesh mesh = read_mesh(path);
  const Fans fans = fans_of(mesh, path);
  if (posing.axis.empty()) return standing(path, fans, mesh.points);
  const Axes axes =
      read_axes({posing.axis}, posing.pose.empty() ? std::vector<std::string>{} : std::vector{posing.pose});
  return following(path, fans, bind::Binding(axes.rest, mesh, {.mode = posing.mode}), axes);
}

}  // namespace

bool is_json(const std::string& path) {
  if (path.ends_with(".json")) return true;
  for (const char* mesh : {".off", ".ply", ".obj", ".stl"})
    if (path.ends_with(mesh)) return false;
  const std::string bytes = read_file(path);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string::npos && bytes[first] == '{';
}

Target read_target(const std::string& path, const Posing& posing) {
  if (is_json(path)) {
    if (!posing.axis.empty()) throw InvalidInput("--axis", "with a scene", "a mesh, or no --axis");
    return of_scene(path, posing);
  }
  if (posing.axis.empty() && !posing.pose.empty())
    throw InvalidInput("--pose", "a mesh without --axis", "--axis too, or a scene");
  return of_mesh(path, posing);
}

}  // namespace tendril::runner
