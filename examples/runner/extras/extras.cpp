#include "extras/extras.h"

#include "film/apng.h"
#include "gltf/export.h"
#include "player/page.h"

#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <iostream>

namespace tendril::runner {
namespace {

std::string counted(std::size_t count, const char* things, const char* thing) {
  return std::to_string(count) + " " + (count == 1 ? thing : things);
}

}  // namespace

void check(const ExtraFlags& flags) {
  if (flags.player) require_player();
  if (!flags.film.empty() && !flags.film.ends_with(".apng") && !flags.film.ends_with(".png"))
    throw InvalidInput("--film", "'" + flags.film + "'", "a name that ends in .apng or .png");
}

Extras::Extras(const ExtraFlags& flags, const scene::SceneRun& run, bind::PolygonMesh look, std::string name,
               Recorder& recorder, const std::string& folder)
    : flags_(flags), run_(run), look_(std::move(look)), name_(std::move(name)), recorder_(recorder) {
  if (flags.any_gltf() && run.mesh() == nullptr)
    throw InvalidInput(run.file().path, "no mesh for --gltf", "a scene with a mesh");
  if (flags.vtk) series_.emplace(run, folder);
  if (flags.any_gltf() || flags.player || !flags.film.empty()) film_.emplace(run);
}

void Extras::take(const scene::Snapshot& snapshot) {
  if (series_) series_->take(snapshot);
  if (film_) film_->take(snapshot);
}

void Extras::finish(const Report& report) {
  if (series_) recorder_.note(series_->finish());
  if (!film_ || film_->moments().empty()) return;
  if (flags_.any_gltf()) write_gltf();
  if (flags_.player) write_player(report);
}

void Extras::write_gltf() {
  const GltfFile file =
      make_gltf(*film_, look_,
                {.name = name_, .skin = {.tolerance = flags_.gltf_tolerance}, .morph = flags_.gltf_morph});
  recorder_.write(name_ + ".glb", file.bytes);
  gltf_ = file.notes;
}

void Extras::write_player(const Report& report) {
  std::string about;
  if (run_.mesh() != nullptr) about = counted(run_.mesh()->mesh().points.size(), "vertices", "vertex") + ", ";
  about += counted(run_.file().names.size(), "curve-pairs", "curve-pair") + ", " +
           counted(film_->moments().size(), "outputs", "output") + "; " + report.method + ", " +
           counted(static_cast<std::size_t>(report.accepted), "steps", "step");
  recorder_.write(name_ + ".html", player_page(*film_, recorder_.camera(), name_, about));
}

bool Extras::draw_film(const PictureOptions& options, const std::function<bool(double)>& go_on) {
  if (flags_.film.empty() || film_->moments().empty()) return true;
  const auto moment = [&](std::size_t m) { return film_->snapshot(m); };
  const std::vector<std::string> pngs =
      draw_moments(run_, recorder_, film_->moments().size(), moment, options, go_on);
  if (pngs.empty()) return false;
  write_file_whole(flags_.film, apng_bytes(pngs, film_->seconds()));
  return true;
}

std::string Extras::in(const std::string& summary) const {
  if (gltf_.is_null()) return summary;
  OrderedJson out = OrderedJson::parse(summary);
  out["gltf"] = gltf_;
  return out.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

void Extras::tell(bool quiet) const {
  if (!gltf_.contains("joints")) return;
  if (!quiet)
    std::cout << name_ << ".glb: " << gltf_["joints"] << " joints, at most " << gltf_["max_error"]
              << " of the mesh's size from the exact points\n";
  if (!gltf_["within_tolerance"].get<bool>())
    std::cerr << "tendril: " << name_ << ".glb: its error is " << gltf_["max_error"]
              << " of the mesh's size, " << gltf_["tolerance"]
              << " was asked for and more joints do not help; --gltf-morph is exact\n";
}

}  // namespace tendril::runner
