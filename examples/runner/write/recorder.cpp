#include "write/recorder.h"

#include "write/json_output.h"

#include <tendril/base/file.h>
#include <tendril/bind/export.h>

#include <algorithm>
#include <cstdio>

namespace tendril::runner {
namespace {

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

void append(std::string& line, const Vec3& v) {
  for (const double x : v) line.append(1, ',').append(shortest(x));
}

}  // namespace

std::vector<StillPoint> still_points(const bind::Binding& binding, Points rest,
                                     std::span<const Reach> reach) {
  std::vector<StillPoint> out;
  const auto records = binding.records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto& [distance, parameters] = reach[binding.pair_of(i)];
    if (distance.empty()) continue;
    const AxialPoint& r = records[i];
    const auto after = std::upper_bound(parameters.begin() + 1, parameters.end() - 1, r.t);
    const auto k = static_cast<std::size_t>(after - parameters.begin());
    const double part = (r.t - parameters[k - 1]) / (parameters[k] - parameters[k - 1]);
    const double limit = (1.0 - part) * distance[k - 1] + part * distance[k];
    if (Vec3(r.u, r.v, r.w).norm() > limit) out.push_back({i, rest[i]});
  }
  return out;
}

Recorder::Recorder(const SceneFile& file, const System& system, const Simulation& simulation,
                   bind::PolygonMesh& mesh, const bind::Binding* binding, RecorderOptions options,
                   Phases& phases)
    : file_(file),
      system_(system),
      simulation_(simulation),
      mesh_(mesh),
      options_(std::move(options)),
      phases_(phases),
      work_(system.make_workspace()),
      fit_(file.view),
      panels_(spread(file.outputs.size(), static_cast<std::size_t>(file.panels))) {
  if (binding == nullptr) return;
  follower_.emplace(*binding, file.bound_to, mesh_.points, options_.threads);
  std::vector<Reach> reach;
  for (const std::size_t pair : file.bound_to)
    reach.push_back({file.reach[pair], simulation.parameters(pair)});
  still_ = still_points(*binding, mesh_.points, reach);
}

void Recorder::follow(double time, std::span<const CurvePair> pairs) {
  update_mesh(time, pairs);
  note_trajectory(time);
  if (follower_ && options_.frames) {
    const Phases::Timer timer(phases_, Phases::write, Phases::simulate);
    write(frame_name(count_), bind::ply_bytes(mesh_, {.float32 = !options_.double_precision}));
  }
  Moment now{time, follower_ ? mesh_.points : std::vector<Vec3>{}, {pairs.begin(), pairs.end()}, {}};
  for (const NodeRange& rod : system_.rods()) {
    now.masses.emplace_back();
    for (std::size_t i = rod.first; i < rod.first + rod.count; ++i) {
      now.masses.back().push_back(simulation_.state().y.segment<3>(3 * static_cast<Eigen::Index>(i)));
    }
  }
  look(now);
  if (std::binary_search(panels_.begin(), panels_.end(), count_)) moments_.push_back(now);
  last_ = std::move(now);
  ++count_;
}

void Recorder::update_mesh(double time, std::span<const CurvePair> pairs) {
  if (!follower_) return;
  const Phases::Timer timer(phases_, Phases::update, Phases::simulate);
  follower_->follow(time, pairs);
  for (const StillPoint& one : still_) mesh_.points[one.index] = one.position;
}

void Recorder::note_trajectory(double time) {
  const State& state = simulation_.state();
  const std::vector<Vec3> q = system_.orientation_masses(state, *work_);
  const auto rods = system_.rods();
  for (std::size_t r = 0; r < rods.size(); ++r) {
    for (std::size_t i = 0; i < rods[r].count; ++i) {
      const std::size_t flat = rods[r].first + i;
      trajectory_.append(shortest(time)).append(1, ',').append(std::to_string(r)).append(1, ',');
      trajectory_.append(std::to_string(i));
      append(trajectory_, state.y.segment<3>(3 * static_cast<Eigen::Index>(flat)));
      append(trajectory_, q[flat]);
      trajectory_ += '\n';
    }
  }
}

void Recorder::look(const Moment& moment) {
  if (follower_) {
    fit_.include(moment.points);
    return;
  }
  for (std::size_t r = 0; r < moment.masses.size(); ++r) {
    for (const Vec3& p : moment.masses[r]) {
      const Vec3 side = 0.5 * file_.thickness[r] * file_.view.up;
      fit_.include(std::array{Vec3(p - side), Vec3(p + side)});
    }
  }
}

void Recorder::write_trajectory() {
  const Phases::Timer timer(phases_, Phases::write);
  write("trajectory.csv", trajectory_);
}

void Recorder::write(const std::string& name, const std::string& bytes) {
  write_file_whole(options_.folder + "/" + name, bytes);
  files_.push_back(name);
}

}  // namespace tendril::runner
