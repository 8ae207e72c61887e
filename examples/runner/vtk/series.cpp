#include "vtk/series.h"

#include <tendril/base/file.h>

#include <cstdio>

namespace tendril::runner {
namespace {

VtkGrid mesh_grid(const bind::PolygonMesh& mesh, Points points) {
  VtkGrid grid(points);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    grid.add_cell(VtkCell::polygon, {face.begin(), face.end()});
  }
  return grid;
}

double width_at(const Rod& rod, std::size_t node) {
  const std::size_t last = rod.width.size() - 1;
  return 0.5 * (rod.width[node > 0 ? node - 1 : 0] + rod.width[std::min(node, last)]);
}

VtkGrid rod_grid(const scene::Snapshot& snapshot, const std::vector<Rod>& rods) {
  std::vector<Vec3> points, director;
  std::vector<std::int32_t> pair;
  std::vector<double> width;
  for (std::size_t r = 0; r < rods.size(); ++r) {
    for (std::size_t i = 0; i < snapshot.masses[r].size(); ++i) {
      points.push_back(snapshot.masses[r][i]);
      director.emplace_back((snapshot.orientation[r][i] - snapshot.masses[r][i]).stableNormalized());
      pair.push_back(static_cast<std::int32_t>(r));
      width.push_back(width_at(rods[r], i));
    }
  }
  VtkGrid grid(points);
  std::uint32_t at = 0;
  for (const auto& masses : snapshot.masses) {
    std::vector<std::uint32_t> line;
    for (std::size_t i = 0; i < masses.size(); ++i) line.push_back(at++);
    grid.add_cell(VtkCell::line, line);
  }
  grid.add_points_field("curve_pair", pair);
  grid.add_points_field("director", director);
  grid.add_points_field("width", width);
  return grid;
}

/// All kinds of contacts have these in common.
struct Meetings {
  std::vector<Vec3> point, normal, force;
  std::vector<double> gap;
  std::vector<std::int32_t> sticks;

  template <class Contact>
  void add(const std::vector<Contact>& contacts) {
    for (const Contact& c : contacts) {
      point.push_back(c.point), normal.push_back(c.normal), force.push_back(c.force);
      gap.push_back(c.gap), sticks.push_back(c.sticks ? 1 : 0);
    }
  }
};

VtkGrid contact_grid(const scene::Snapshot& snapshot) {
  Meetings all;
  all.add(snapshot.contacts);
  all.add(snapshot.mesh_contacts);
  all.add(snapshot.mesh_self_contacts);
  all.add(snapshot.rod_contacts);
  VtkGrid grid(all.point);
  for (std::uint32_t i = 0; i < all.point.size(); ++i) grid.add_cell(VtkCell::vertex, {i});
  grid.add_points_field("gap", all.gap);
  grid.add_points_field("normal", all.normal);
  grid.add_points_field("force", all.force);
  grid.add_points_field("sticks", all.sticks);
  return grid;
}

bool has_contact(const scene::SceneFile& file) {
  return file.contact || file.mesh_contact.make || file.mesh_self_contact.make || file.self_contact;
}

}  // namespace

VtkSeries::VtkSeries(const scene::SceneRun& run, std::string folder)
    : run_(run), folder_(std::move(folder)), work_(run.system().make_workspace()) {
  const scene::BoundMesh* mesh = run.mesh();
  if (mesh == nullptr) return;
  rest_ = mesh->mesh().points;
  follows_.assign(rest_.size(), 1);
  for (const std::size_t i : mesh->out_of_reach()) follows_[i] = 0;
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    shares_.push_back(static_cast<std::int32_t>(mesh->binding().shares(i).size()));
    pair_.push_back(static_cast<std::int32_t>(run.file().bound_to[mesh->binding().pair_of(i)]));
  }
}

void VtkSeries::add_mesh_fields(VtkGrid& grid, const scene::Snapshot& snapshot) const {
  std::vector<Vec3> displacement;
  for (std::size_t i = 0; i < rest_.size(); ++i) displacement.emplace_back(snapshot.points[i] - rest_[i]);
  grid.add_points_field("displacement", displacement);
  grid.add_points_field("shares", shares_);
  grid.add_points_field("curve_pair", pair_);
  grid.add_points_field("follows", follows_);
}

void VtkSeries::take(const scene::Snapshot& snapshot) {
  time_ = snapshot.time;
  const Energies energies = run_.system().energies(run_.simulation().state(), *work_);
  if (run_.mesh() != nullptr) {
    VtkGrid grid = mesh_grid(run_.mesh()->mesh(), snapshot.points);
    add_mesh_fields(grid, snapshot);
    write("mesh", 0, energies, std::move(grid));
  }
  write("rods", 1, energies, rod_grid(snapshot, run_.file().scene.rods));
  if (has_contact(run_.file())) write("contacts", 2, energies, contact_grid(snapshot));
  ++count_;
}

void VtkSeries::write(const std::string& kind, int part, const Energies& energies, VtkGrid grid) {
  grid.add_field("TimeValue", time_);
  grid.add_field("kinetic_energy", energies.kinetic);
  grid.add_field("elastic_energy", energies.elastic);
  grid.add_field("potential_energy", energies.potential);
  char name[64];
  std::snprintf(name, sizeof name, "%s_%04zu.vtu", kind.c_str(), count_);
  write_file_whole(folder_ + "/" + name, grid.bytes());
  entries_.push_back({time_, part, name});
}

std::vector<std::string> VtkSeries::finish() {
  write_file_whole(folder_ + "/run.pvd", pvd_text(entries_));
  std::vector<std::string> out;
  for (const PvdEntry& entry : entries_) out.push_back(entry.file);
  out.emplace_back("run.pvd");
  return out;
}

}  // namespace tendril::runner
