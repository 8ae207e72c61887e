#pragma once

#include "write/recorder.h"

#include <functional>

namespace tendril::runner {

/// Draws what the recorder kept: contact_sheet.png with a panel per moment, and final.png. One camera for
/// all. Stops between two panels, without writing, when `go_on` says no.
/// \return  whether both were written
bool draw_run(const scene::SceneRun& run, Recorder& recorder, int threads,
              const std::function<bool(double part)>& go_on);

}  // namespace tendril::runner
