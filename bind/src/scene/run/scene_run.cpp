#include "scene/read/contact_reader.h"

#include <tendril/bind/binding_points.h>
#include <tendril/scene/scene_run.h>

#include <algorithm>
#include <chrono>

namespace tendril::scene {
namespace {

/// Adds the time it lives to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

SolidPose pose_of(const SceneBody& body, const std::vector<BodyView>& free, double time) {
  if (body.free) return {free[*body.free].rotation, free[*body.free].position};
  const AnchorPose pose = body.motion ? body.motion(time) : body.pose;
  SolidPose out;
  out.rotation << pose.frame.x, pose.frame.y, pose.frame.z;
  out.position = pose.position;
  return out;
}

/// Gives the scene the contact of its mesh, where that is asked for; of all faces that follow rods, which are
/// returned, a triangle each.
std::vector<std::size_t> let_meet(const BoundMesh& mesh, SceneFile& file) {
  std::vector<std::size_t> face_of;
  if (!file.mesh_contact.make && !file.mesh_self_contact.make) return face_of;
  const bind::PolygonMesh& at_rest = mesh.mesh();
  std::vector<bool> still(at_rest.points.size(), false);
  for (const std::size_t i : mesh.out_of_reach()) still[i] = true;
  std::vector<std::size_t> all_faces;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto all = bind::fan_triangles(at_rest, &all_faces);
  for (std::size_t t = 0; t < all.size(); ++t) {
    if (std::any_of(all[t].begin(), all[t].end(), [&](std::uint32_t corner) { return still[corner]; }))
      continue;
    triangles.push_back(all[t]);
    face_of.push_back(all_faces[t]);
  }
  try {
    auto points = std::make_shared<RodPoints>(
        RodCurves(file.scene.rods, file.options.degree, file.options.parametrisation), file.bound_to,
        std::make_shared<bind::BindingPoints>(mesh.binding()));
    for (MeshForce* of_mesh : {&file.mesh_contact, &file.mesh_self_contact}) {
      if (!of_mesh->make) continue;
      of_mesh->force = file.scene.forces.size();
      file.scene.forces.push_back(of_mesh->make(points, at_rest.points, triangles));
      file.force_places.push_back(of_mesh->place);
    }
  } catch (const InvalidInput& error) {
    throw in_scene(file, error);
  }
  return face_of;
}

Simulation make_simulation(const SceneFile& file, const System& system, const RunOptions& options) {
  try {
    return {system, options.start ? *options.start : start_state(file, system), file.options};
  } catch (const InvalidInput& error) {
    throw in_scene(file, error);
  }
}

}  // namespace

struct SceneRun::Implementation : Follower {
  SceneFile file;
  int threads;
  RunSeconds seconds;
  std::optional<BoundMesh> mesh;
  std::vector<std::size_t> contact_face;  ///< of the triangles in contact
  System system;
  Simulation simulation;
  System::WorkspacePtr work;
  Output output;
  std::size_t outputs = 0;
  double interrupted = 0.0;  ///< seconds of a run that were spent on outputs

  Implementation(SceneFile scene, bind::PolygonMesh surface, const RunOptions& options)
      : file(std::move(scene)),
        threads(options.threads),
        mesh(bind_mesh(std::move(surface), options)),
        contact_face(mesh ? let_meet(*mesh, file) : std::vector<std::size_t>{}),
        system(make_system(file)),
        simulation(make_simulation(file, system, options)),
        work(system.make_workspace()) {}

  std::optional<BoundMesh> bind_mesh(bind::PolygonMesh surface, const RunOptions& options) {
    if (surface.points.empty()) return {};
    make_bare_system(file);  // what is wrong with the scene is said before the mesh is bound to it
    const Stopwatch watch(seconds.bind);
    return BoundMesh(file, std::move(surface), options.mode, threads);
  }

  void follow(double, std::span<const CurvePair>) override {
    const Stopwatch watch(interrupted);
    const Snapshot now = snapshot();
    ++outputs;
    if (output) output(now);
  }

  Snapshot snapshot() {
    const State& state = simulation.state();
    const auto pairs = simulation.pairs();
    Snapshot out{state.time, {}, {pairs.begin(), pairs.end()}, {}, {}};
    const std::vector<BodyView> free = system.bodies(state);
    for (const SceneBody& body : file.bodies) out.bodies.push_back(pose_of(body, free, state.time));
    out.contacts = contacts_of(file, state);
    out.mesh_contacts = mesh_contacts_of(file, state);
    for (MeshContactPoint& at : out.mesh_contacts) at.face = contact_face[at.face];
    out.mesh_self_contacts = mesh_self_contacts_of(file, state);
    for (MeshSelfContactPoint& at : out.mesh_self_contacts)
      for (std::size_t& face : at.face) face = contact_face[face];
    out.rod_contacts = rod_contacts_of(file, state);
    if (file.supports) out.supports = supports_of(system, state);
    if (mesh) {
      const Stopwatch watch(seconds.update);
      mesh->update(pairs, threads);
      out.points = mesh->mesh().points;
    }
    const std::vector<Vec3> q = system.orientation_masses(state, *work);
    for (const NodeRange& rod : system.rods()) {
      std::vector<Vec3> p;
      for (std::size_t i = rod.first; i < rod.first + rod.count; ++i)
        p.push_back(state.y.segment<3>(3 * static_cast<Eigen::Index>(i)));
      out.masses.push_back(std::move(p));
      const auto first = q.begin() + static_cast<std::ptrdiff_t>(rod.first);
      out.orientation.emplace_back(first, first + static_cast<std::ptrdiff_t>(rod.count));
    }
    return out;
  }
};

SceneRun::SceneRun(SceneFile file, const RunOptions& options) {
  bind::PolygonMesh mesh = read_scene_mesh(file);
  self_ = std::make_unique<Implementation>(std::move(file), std::move(mesh), options);
}

SceneRun::SceneRun(SceneFile file, bind::PolygonMesh mesh, const RunOptions& options)
    : self_(std::make_unique<Implementation>(std::move(file), std::move(mesh), options)) {}

SceneRun::~SceneRun() = default;
SceneRun::SceneRun(SceneRun&&) noexcept = default;
SceneRun& SceneRun::operator=(SceneRun&&) noexcept = default;

Report SceneRun::run(const Output& output, const Progress& progress) {
  Implementation& self = *self_;
  self.output = output;
  self.simulation.add(self, Simulation::When::output);
  if (progress) self.simulation.on_progress([&](double time) { return progress(time / self.file.duration); });
  double whole = 0.0;
  Report report;
  try {
    const Stopwatch watch(whole);
    report = self.simulation.run(self.file.duration, self.file.outputs);
  } catch (const InvalidInput& error) {
    throw in_scene(self.file, error);
  }
  self.seconds.simulate += whole - self.interrupted;
  self.output = {};
  return report;
}

Snapshot SceneRun::snapshot() {
  return self_->snapshot();
}
const SceneFile& SceneRun::file() const {
  return self_->file;
}
const System& SceneRun::system() const {
  return self_->system;
}
const Simulation& SceneRun::simulation() const {
  return self_->simulation;
}
const BoundMesh* SceneRun::mesh() const {
  return self_->mesh ? &*self_->mesh : nullptr;
}
std::size_t SceneRun::outputs() const {
  return self_->outputs;
}
const RunSeconds& SceneRun::seconds() const {
  return self_->seconds;
}

}  // namespace tendril::scene
