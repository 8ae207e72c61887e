#pragma once

#include <string>

namespace tendril::runner {

/// Makes a folder, and those above it, where it is not there. FileError when it cannot be.
void make_folder(const std::string& folder);

}  // namespace tendril::runner
