#include "film/film.h"

#include <tendril/dynamics/rod_curves.h>

#include <algorithm>
#include <limits>

namespace tendril::runner {

namespace {

template <class Contact>
void add(const std::vector<Contact>& contacts, std::vector<Meeting>& to) {
  for (const Contact& c : contacts) to.push_back({c.point, c.force});
}

}  // namespace

Film::Film(const scene::SceneRun& run) : run_(run), work_(run.system().make_workspace()) {
  const scene::SceneFile& file = run.file();
  const RodCurves curves(file.scene.rods, file.options.degree, file.options.parametrisation);
  for (std::size_t k = 0; k < file.scene.rods.size(); ++k)
    rest_of_all_.push_back(curves.through(k, file.scene.rods[k].p, file.scene.rods[k].q));
  if (run.mesh() == nullptr) return;
  mesh_ = run.mesh()->mesh();
  for (const std::size_t k : file.bound_to) rest_.push_back(rest_of_all_[k]);
}

void Film::take(const scene::Snapshot& snapshot) {
  Moment now{snapshot.time,   snapshot.pairs,
             snapshot.masses, run_.system().energies(run_.simulation().state(), *work_),
             snapshot.bodies, {}};
  add(snapshot.contacts, now.meetings);
  add(snapshot.mesh_contacts, now.meetings);
  add(snapshot.mesh_self_contacts, now.meetings);
  add(snapshot.rod_contacts, now.meetings);
  moments_.push_back(std::move(now));
}

void Film::note_step() {
  const double now = run_.simulation().state().time;
  const double before = steps_.empty() ? 0.0 : steps_.back().end;
  if (now > before) steps_.push_back({now, now - before});
}

scene::Snapshot Film::snapshot(std::size_t moment) const {
  const Moment& m = moments_[moment];
  std::vector<Vec3> points;
  if (run_.mesh() != nullptr) points = this->points(moment);
  return {m.time, std::move(points), m.pairs, m.masses, {}, m.bodies};
}

double Film::pace() const {
  constexpr double kShortest = 1.0, kLongest = 30.0, kElse = 5.0;  // seconds
  const double duration = moments_.back().time - moments_.front().time;
  if (duration >= kShortest && duration <= kLongest) return 1.0;
  return std::max(duration, std::numeric_limits<double>::min()) / kElse;
}

std::vector<double> Film::seconds() const {
  std::vector<double> out;
  for (std::size_t m = 0; m + 1 < moments_.size(); ++m)
    out.push_back((moments_[m + 1].time - moments_[m].time) / pace());
  out.push_back(out.empty() ? 1.0 : out.back());
  return out;
}

std::vector<CurvePair> Film::posed(std::size_t moment) const {
  std::vector<CurvePair> out;
  for (const std::size_t k : file().bound_to) out.push_back(moments_[moment].pairs[k]);
  return out;
}

std::vector<Vec3> Film::points(std::size_t moment) const {
  std::vector<Vec3> out(mesh_.points.size());
  binding().update(posed(moment), out);
  for (const std::size_t i : still()) out[i] = mesh_.points[i];
  return out;
}

}  // namespace tendril::runner
