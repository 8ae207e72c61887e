#include "write/folder.h"

#include <tendril/base/error.h>

#include <filesystem>

namespace tendril::runner {

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw FileError(folder, error ? error.message() : "it is not a folder");
  }
}

}  // namespace tendril::runner
