#pragma once

#include "film/film.h"
#include "vtk/series.h"
#include "write/json_output.h"
#include "write/recorder.h"
#include "write/run_pictures.h"

#include <optional>

namespace tendril::runner {

/// What a run is asked to write beside frames, tables and pictures.
struct ExtraFlags {
  bool vtk = false, gltf = false, gltf_morph = false, player = false;
  double gltf_tolerance = 1e-3;
  std::string film;  ///< path of a picture that moves; empty for none
  bool any_gltf() const { return gltf || gltf_morph; }
};

/// Throws InvalidInput for what no run can be asked for: a film of another type, or a player where the
/// program was built without.
void check(const ExtraFlags& flags);

/// Writes that, from what it sees of the run.
class Extras {
 public:
  /// Throws InvalidInput for a glTF file of a scene without a mesh.
  /// \param run       not begun yet; kept by reference
  /// \param look      the mesh as it was read, with what the run drops: normals
  /// \param name      of what is written, without an ending
  /// \param recorder  gets the files; kept by reference
  Extras(const ExtraFlags& flags, const scene::SceneRun& run, bind::PolygonMesh look, std::string name,
         Recorder& recorder, const std::string& folder);

  void take(const scene::Snapshot& snapshot);
  void note_step() {
    if (film_) film_->note_step();
  }
  void finish(const Report& report);
  /// Draws the film where one is asked for; false when `go_on` said no.
  bool draw_film(const PictureOptions& options, const std::function<bool(double part)>& go_on);

  /// The summary with what is to be said of the files.
  std::string in(const std::string& summary) const;
  /// The same in words; a file that is less than was asked for is said to be on standard error.
  /// \param quiet  only that
  void tell(bool quiet) const;

 private:
  void write_gltf();
  void write_player(const Report& report);

  const ExtraFlags& flags_;
  const scene::SceneRun& run_;
  bind::PolygonMesh look_;
  std::string name_;
  Recorder& recorder_;
  std::optional<VtkSeries> series_;
  std::optional<Film> film_;
  OrderedJson gltf_;
};

}  // namespace tendril::runner
