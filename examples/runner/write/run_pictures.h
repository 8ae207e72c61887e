#pragma once

#include "write/recorder.h"

#include <functional>

namespace tendril::runner {

struct PictureOptions {
  int threads = 1;
  bool mark_ambiguous = false;  ///< color the points that are bound to several places
};

/// Draws what the recorder kept: contact_sheet.png with a panel per moment, and final.png. One camera for
/// all, and the same pictures for any number of threads. Stops between two panels, without writing, when
/// `go_on`, asked on this thread, says no.
/// \return  whether both were written
bool draw_run(const scene::SceneRun& run, Recorder& recorder, const PictureOptions& options,
              const std::function<bool(double part)>& go_on);

/// Draws moments by the recorder's camera, as large as a panel of the contact sheet.
/// \param moment  of an index below `count`; called from several threads at once
/// \return  PNG files; none when `go_on` says no
std::vector<std::string> draw_moments(const scene::SceneRun& run, const Recorder& recorder, std::size_t count,
                                      const std::function<scene::Snapshot(std::size_t)>& moment,
                                      const PictureOptions& options,
                                      const std::function<bool(double part)>& go_on);

}  // namespace tendril::runner
