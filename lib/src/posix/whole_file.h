#pragma once

#include <string>
#include <string_view>

/// What files need of the operating system, and the only room that knows it. Errors are returned as the
/// system's codes.
namespace tendril::posix {

/// In place of a code: a folder has one of its own, but a pipe or a device has none.
inline constexpr int kNotRegular = -1;

/// All bytes of a regular file.
/// \return  0, the system's code, or kNotRegular
int read_whole(const std::string& path, std::string& bytes);

/// Replaces a file, or the one that a symbolic link leads to, by a new one of these bytes in one rename,
/// flushed to the disk, with the old one's permission bits. On failure nothing is left behind.
/// \return  as above
int write_whole(const std::string& path, std::string_view bytes);

}  // namespace tendril::posix
