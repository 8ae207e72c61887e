#pragma once

#include <tendril/base/export.h>

#include <string>
#include <string_view>

/// Files read and written whole. Both work on bytes: no text mode, no locale, no line-end translation.
namespace tendril {

/// All bytes of a regular file. Memory: the file's size.
///
/// Throws FileError with the system's reason when the file cannot be opened or read, and when `path` is a
/// folder, a pipe or a device: those have no size to bound the read by.
TENDRIL_CORE_API std::string read_file(const std::string& path);

/// Makes `path` hold exactly `bytes`. The bytes go to a new file in the same folder, which is flushed to the
/// disk and then renamed over `path`; so at any moment, also after a crash, `path` is either the old file or
/// the new one. A symbolic link is followed, and an existing file's permission bits are kept.
///
/// Throws FileError on any failure; then the old file is as it was and nothing new is left behind. Something
/// that is not a regular file (a folder, a device) is refused rather than replaced.
TENDRIL_CORE_API void write_file_whole(const std::string& path, std::string_view bytes);

}  // namespace tendril
