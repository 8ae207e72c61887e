#pragma once

#include "read/scene_reader.h"

#include <tendril/bind/binding.h>

namespace tendril::runner {

/// The mesh bound to the curve-pairs at rest that the scene names, on the knots that the simulation will use.
/// InvalidInput names the mesh's file.
bind::Binding bind_scene(const SceneFile& file, const bind::PolygonMesh& mesh, bind::BindMode mode,
                         int threads);

/// What a scene is bound by unless asked otherwise: several curve-pairs, and one where it is asked for,
/// continuously.
bind::BindMode mode_of(const SceneFile& file, bool continuous, bool nearest);

}  // namespace tendril::runner
