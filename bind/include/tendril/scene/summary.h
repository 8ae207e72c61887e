#pragma once

#include <tendril/base/export.h>
#include <tendril/scene/scene_run.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tendril::scene {

/// What a moment of a run does to the mesh.
struct SpoiltMoment {
  double time;            ///< of the scene
  bind::Distortion what;  ///< of the mesh against rest
};

/// What the caller knows about a run, for its summary.
struct RunNotes {
  std::vector<std::string> files = {};                            ///< names of the files it wrote
  std::vector<std::pair<std::string, double>> wall_seconds = {};  ///< by phase, in this order; a sum is added
  std::optional<SpoiltMoment> spoilt = {};                        ///< the worst of those looked at
};

/// What a run was and how it went, as a JSON object: status and reason, steps, energies, what the scene
/// consists of and what of it was left out, how the mesh is bound, and the notes. All but `wall_s` is the
/// same for two runs of a scene and for any number of threads; numbers read back to the same bits.
TENDRIL_SCENE_API std::string summary_json(const SceneRun& run, const Report& report,
                                           const RunNotes& notes = {});

}  // namespace tendril::scene
