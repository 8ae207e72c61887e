#include <tendril/base/error.h>

namespace tendril {

InvalidInput::InvalidInput(const std::string& place, const std::string& reason, const std::string& expected)
    : Error(place + ": " + reason + "; expected " + expected),
      place_(place),
      reason_(reason),
      expected_(expected) {}

FileError::FileError(const std::string& path, const std::string& reason)
    : Error(path + ": " + reason), path_(path) {}

}  // namespace tendril
