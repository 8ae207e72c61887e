#include "study/extrapolation.h"

#include <cmath>
#include <vector>

namespace tendril::runner {
namespace {

constexpr std::size_t kMostUnknowns = 600;
constexpr double kFirstSteps = 128.0;  // of the whole run
constexpr int kLevels = 7;

/// a + (a - b) / (2^j - 1), everywhere: the j-th power of the step goes.
Track combined(const Track& a, const Track& b, int j) {
  const double part = 1.0 / (std::exp2(j) - 1.0);
  const auto combine = [part](const Vec3& x, const Vec3& y) { return Vec3(x + part * (x - y)); };
  Track out = a;
  for (std::size_t k = 0; k < out.moments.size(); ++k) {
    Track::Moment& moment = out.moments[k];
    const Track::Moment& other = b.moments[k];
    for (std::size_t i = 0; i < moment.p.size(); ++i) {
      moment.p[i] = combine(moment.p[i], other.p[i]);
      Frame& frame = moment.frames[i];
      frame.x = combine(frame.x, other.frames[i].x);
      frame.y = combine(frame.y, other.frames[i].y);
      frame.z = combine(frame.z, other.frames[i].z);
    }
  }
  return out;
}

/// The row of the tableau that a run adds below the last one.
std::vector<Track> next_row(Track run, const std::vector<Track>& above) {
  std::vector<Track> out{std::move(run)};
  for (std::size_t j = 0; j < above.size(); ++j)
    out.push_back(combined(out[j], above[j], static_cast<int>(j) + 1));
  return out;
}

/// A step that divides the time between outputs.
double first_step(const scene::SceneFile& file) {
  const double stretch = file.outputs.size() > 1 ? file.outputs[1] - file.outputs[0] : file.duration;
  return stretch / std::ceil(stretch * kFirstSteps / file.duration);
}

}  // namespace

std::optional<Tightest> extrapolated_run(const Study& study, double seconds) {
  const System& system = study.system();
  if (3 * system.node_count() + system.twist_count() > kMostUnknowns) return std::nullopt;
  std::vector<Track> row;
  std::optional<Tightest> out;
  double left = seconds, step = first_step(study.file());
  for (int level = 0; level < kLevels; ++level, step /= 2) {
    Trial trial = study.run({Method::backward_euler, step}, left, true);
    left -= trial.cpu;
    if (trial.outcome == Trial::Outcome::capped) break;
    if (!trial.finished()) {
      row.clear();  // columns take each step for half of the one before
      continue;
    }
    const double cpu = trial.cpu;
    std::vector<Track> next = next_row(std::move(trial.track), row);
    // The column that has settled best: those that hold runs by long steps, which may have gone astray, have
    // not.
    for (std::size_t j = 1; j < next.size(); ++j) {
      const double settled = distance(next[j], next[j - 1], scene_length(system)).position;
      if (out && settled >= out->settled) continue;
      trial.track = next[j];
      out = {trial, settled};
    }
    row = std::move(next);
    if (2.0 * cpu > left) break;
  }
  return out;
}

}  // namespace tendril::runner
