#include "write/recorder.h"

#include "draw/solid.h"
#include "write/json_output.h"

#include <tendril/base/file.h>
#include <tendril/bind/export.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace tendril::runner {
namespace {

constexpr double kSpoilt = 1e-3;  // of the mesh's area

std::string frame_name(std::size_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%04zu.ply", number);
  return name;
}

/// Numbers of `panels` outputs, spread evenly from the first to the last.
std::vector<std::size_t> spread(std::size_t outputs, std::size_t panels) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < panels; ++k) {
    const std::size_t number =
        panels > 1 ? (k * (outputs - 1) + (panels - 1) / 2) / (panels - 1) : outputs - 1;
    if (out.empty() || out.back() != number) out.push_back(number);
  }
  return out;
}

}  // namespace

Recorder::Recorder(const scene::SceneFile& file, RecorderOptions options, Phases& phases)
    : file_(file),
      options_(std::move(options)),
      phases_(phases),
      fit_(file.view),
      numbers_(spread(file.outputs.size(), static_cast<std::size_t>(file.panels))) {}

void Recorder::take(const scene::Snapshot& snapshot, const scene::BoundMesh* mesh) {
  trajectory_.add(snapshot);
  contact_.add(snapshot);
  supports_.add(file_, snapshot);
  if (mesh != nullptr && options_.frames) {
    const Phases::Timer timer(phases_, Phases::write);
    const bool single = !options_.double_precision && bind::single_precision_serves(mesh->mesh().points);
    write(frame_name(count_), bind::ply_bytes(mesh->mesh(), {.float32 = single}));
  }
  look(snapshot);
  if (std::binary_search(numbers_.begin(), numbers_.end(), count_)) {
    panels_.push_back(snapshot);
    if (mesh != nullptr) judge(snapshot.time, *mesh);
  }
  last_ = snapshot;
  ++count_;
}

void Recorder::judge(double time, const scene::BoundMesh& mesh) {
  const Phases::Timer timer(phases_, Phases::update);
  bind::Distortion now = mesh.distortion();
  if (!spoilt_ || now.spoilt > spoilt_->what.spoilt) spoilt_ = {time, std::move(now)};
}

void Recorder::warn_of_spoilt(const std::string& what) const {
  if (!spoilt_ || !(spoilt_->what.spoilt > kSpoilt)) return;
  std::cerr << "tendril: note: at time " << spoilt_->time << ' ' << what << " spoils "
            << describe(spoilt_->what) << "; 'tendril bind' tells a tear from what is bent too sharply\n";
}

std::string Recorder::left_over() const {
  const std::string next = frame_name(count_);
  return std::filesystem::exists(options_.folder + "/" + next) ? next : std::string();
}

void Recorder::look(const scene::Snapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
    fit_.include(reach_of(file_.bodies[i].shape, snapshot.bodies[i]));
  if (!snapshot.points.empty()) {
    fit_.include(snapshot.points);
    return;
  }
  for (std::size_t r = 0; r < snapshot.masses.size(); ++r) {
    for (const Vec3& p : snapshot.masses[r]) {
      const Vec3 side = 0.5 * file_.thickness[r] * file_.view.up;
      fit_.include(std::array{Vec3(p - side), Vec3(p + side)});
    }
  }
}

void Recorder::write_trajectory() {
  const Phases::Timer timer(phases_, Phases::write);
  write("trajectory.csv", trajectory_.csv());
  if (file_.supports) write("supports.csv", supports_.csv());
  if (file_.self_contact) write("rod_contacts.csv", contact_.rod_contacts());
  if (file_.mesh_self_contact.make) write("mesh_self_contacts.csv", contact_.mesh_self_contacts());
  if (file_.bodies.empty()) return;
  write("bodies.csv", contact_.bodies());
  if (file_.mesh_contact.make)
    write("mesh_contacts.csv", contact_.mesh_contacts());
  else
    write("contacts.csv", contact_.contacts());
}

void Recorder::write(const std::string& name, const std::string& bytes) {
  write_file_whole(options_.folder + "/" + name, bytes);
  files_.push_back(name);
}

}  // namespace tendril::runner
