#pragma once

#include <string>
#include <vector>

namespace tendril::runner {

/// Pictures as one that moves (APNG), over and over. Whoever knows PNG alone shows the first.
/// \param pngs     files of one size and kind, as png_bytes makes them; at least one
/// \param seconds  how long each is shown; as many
std::string apng_bytes(const std::vector<std::string>& pngs, const std::vector<double>& seconds);

}  // namespace tendril::runner
