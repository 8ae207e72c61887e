#include <tendril/bind/import.h>
#include <tendril/curve/frame_jump.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/scene/bound_mesh.h>

#include <algorithm>

namespace tendril::scene {
namespace {

RodCurves curves_of(const SceneFile& file) {
  return RodCurves(file.scene.rods, file.options.degree, file.options.parametrisation);
}

/// Those that the mesh follows.
std::vector<CurvePair> pairs_at_rest(const SceneFile& file) {
  const RodCurves curves = curves_of(file);
  std::vector<CurvePair> rest;
  for (const std::size_t k : file.bound_to) {
    rest.push_back(curves.through(k, file.scene.rods.at(k).p, file.scene.rods[k].q));
    if (const auto jump = find_frame_jump(rest.back(), curves.parameters(k)))
      throw in_scene(file, InvalidInput("rods[" + std::to_string(k) + "]", describe(*jump, "nodes"),
                                        "frames that carry on along what the mesh follows"));
  }
  return rest;
}

bind::Binding bind_at_rest(const SceneFile& file, const std::vector<CurvePair>& rest,
                           const bind::PolygonMesh& mesh, bind::BindMode mode, int threads) {
  try {
    return {rest, mesh, bind::BindOptions{.mode = mode, .threads = threads}};
  } catch (const InvalidInput& error) {
    throw InvalidInput(file.mesh, error.place() + ": " + error.reason(), error.expected());
  }
}

/// How far a curve-pair reaches at its nodes, whose parameters on the curve ascend.
struct Reach {
  std::vector<double> distance, parameters;

  double at(double t) const {
    const auto after = std::upper_bound(parameters.begin() + 1, parameters.end() - 1, t);
    const auto k = static_cast<std::size_t>(after - parameters.begin());
    const double part = (t - parameters[k - 1]) / (parameters[k] - parameters[k - 1]);
    return (1.0 - part) * distance[k - 1] + part * distance[k];
  }
};

/// Of each of the curve-pairs that the mesh follows; no distances where everything is reached.
std::vector<Reach> reaches_of(const SceneFile& file) {
  const RodCurves curves = curves_of(file);
  std::vector<Reach> out;
  for (const std::size_t k : file.bound_to) {
    out.emplace_back();
    if (file.reach.at(k).empty()) continue;
    const std::span<const double> parameters = curves.parameters(k);
    out.back() = {file.reach[k], {parameters.begin(), parameters.end()}};
  }
  return out;
}

std::vector<std::size_t> beyond_reach(const bind::Binding& binding, std::span<const Reach> reaches) {
  std::vector<std::size_t> out;
  const auto records = binding.records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Reach& reach = reaches[binding.pair_of(i)];
    const AxialPoint& r = records[i];
    if (!reach.distance.empty() && Vec3(r.u, r.v, r.w).norm() > reach.at(r.t)) out.push_back(i);
  }
  return out;
}

}  // namespace

namespace {

/// Whoever has several curve-pairs beside each other may mean the mesh to follow them all.
void note_unbound(const SceneFile& file, std::vector<std::string>& notes) {
  if (!file.bound_by_default || file.bound_to.size() == file.names.size()) return;
  std::size_t other = 0;
  while (other < file.bound_to.size() && file.bound_to[other] == other) ++other;
  notes.push_back(file.path + ": the mesh follows '" + file.names[file.bound_to[0]] +
                  "' and what is joined to it, not '" + file.names[other] +
                  "' for one: \"bound_to\" names all that it is to follow");
}

}  // namespace

bind::PolygonMesh read_scene_mesh(const SceneFile& file, std::vector<std::string>* notes) {
  if (file.mesh.empty()) return {};
  bind::PolygonMesh mesh = bind::read_mesh(file.mesh, notes);
  if (mesh.points.empty()) throw InvalidInput(file.mesh, "no points", "a mesh");
  if (notes) note_unbound(file, *notes);
  return mesh;
}

BoundMesh::BoundMesh(const SceneFile& file, bind::PolygonMesh mesh, bind::BindMode mode, int threads)
    : rest_(mesh.points),
      rest_pairs_(pairs_at_rest(file)),
      mesh_(std::move(mesh)),
      binding_(bind_at_rest(file, rest_pairs_, mesh_, mode, threads)),
      bound_to_(file.bound_to),
      still_(beyond_reach(binding_, reaches_of(file))) {
  mesh_.point_normals.clear();
  for (const std::size_t i : still_) still_at_.push_back(mesh_.points[i]);
}

void BoundMesh::update(std::span<const CurvePair> pairs, int threads) {
  posed_.clear();
  for (const std::size_t k : bound_to_) posed_.push_back(pairs[k]);
  binding_.update(posed_, mesh_.points, threads);
  for (std::size_t i = 0; i < still_.size(); ++i) mesh_.points[still_[i]] = still_at_[i];
}

bind::Distortion BoundMesh::distortion() const {
  if (posed_.empty()) return {};
  bind::PolygonMesh at_rest = mesh_;
  at_rest.points = rest_;
  return bind::measure_distortion(binding_, rest_pairs_, at_rest, posed_, mesh_.points);
}

}  // namespace tendril::scene
