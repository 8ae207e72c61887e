#pragma once

#include "draw/camera.h"
#include "film/film.h"

#include <string>

namespace tendril::runner {

/// The run as one page of HTML that needs nothing else, no server either: it evaluates the curve-pairs and
/// the binding itself, so that it holds control points a moment and what each vertex is bound to, and no
/// frames of the mesh. Lengths are over the mesh's size (the masses', without a mesh), about its middle.
/// \param film    with at least one moment
/// \param camera  the first view
/// \param name    of the page
/// \param about   a line under it
std::string player_page(const Film& film, const Camera& camera, const std::string& name,
                        const std::string& about);

/// Throws InvalidInput, which says what to install, where the program was built without a player; then
/// player_page does, too.
void require_player();

/// The page but for what is of a run: @FILM@ and @DATA@ stand for that. Made of the folder `page` and of
/// three.js when the program is built.
std::string page_template();

}  // namespace tendril::runner
