#pragma once

#include "write/json_output.h"
#include "write/recorder.h"

namespace tendril::runner {

/// What a run was and how it went. All but `wall_s` is the same for two runs of a scene and for any number of
/// threads.
OrderedJson summarize(const SceneFile& file, const System& system, const bind::PolygonMesh& mesh,
                      const bind::Binding* binding, const Report& report, const Recorder& recorder);

/// Seconds by phase, and their sum.
OrderedJson wall_seconds(const Phases& phases);

}  // namespace tendril::runner
