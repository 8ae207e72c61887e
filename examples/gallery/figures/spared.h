#pragma once

#include <tendril/dynamics/scene.h>

#include "page/figure.h"

namespace tendril::gallery {

/// What a program is linked of.
enum class Parts { curves, rods, mesh };

/// Says in the figure what was left out, and what that saved: of its scene, which runs a little with the
/// twist state of every rod, too; and of a program of those parts, beside one that reads and runs any scene.
void say_left_out(const Scene& scene, Parts parts, Figure& out);
/// The same where nothing moves.
void say_left_out(Parts parts, Figure& out);

}  // namespace tendril::gallery
