#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <system_error>

#include "posix/whole_file.h"

namespace tendril {
namespace {

void require_done(const std::string& path, int code) {
  if (code == posix::kNotRegular) throw FileError(path, "not a regular file");
  if (code != 0) throw FileError(path, std::generic_category().message(code));
}

}  // namespace

std::string read_file(const std::string& path) {
  std::string bytes;
  require_done(path, posix::read_whole(path, bytes));
  return bytes;
}

void write_file_whole(const std::string& path, std::string_view bytes) {
  require_done(path, posix::write_whole(path, bytes));
}

}  // namespace tendril
