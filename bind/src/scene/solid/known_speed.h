#pragma once

#include <tendril/scene/scene_file.h>

namespace tendril::scene {

/// A speed at which things may meet, as far as the file says: the largest that a rod or a free body begins
/// with, or an anchor moves at, and the largest of a driven body, together. A thousand times of the run are
/// looked at. 0 where nothing is said to move.
/// \param file  its bodies, anchors, start and duration read
double known_speed(const SceneFile& file);

/// How far something may fall, as far as the file says: from the highest free body, or point of a rod that
/// nothing holds, to the lowest of these and of all solids. 0 without gravity.
double known_fall(const SceneFile& file);

}  // namespace tendril::scene
