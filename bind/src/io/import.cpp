#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/bind/import.h>

#include "cursor.h"
#include "import_values.h"

namespace tendril::bind {
namespace {

/// "OFF" with prefixes, or with the first count glued to it.
bool is_off(std::string_view word) {
  const std::size_t off = word.find("OFF");
  return off != word.npos && word.find_first_not_of("0123456789", off + 3) == word.npos;
}

}  // namespace

PolygonMesh read_mesh(const std::string& path, std::vector<std::string>* notes) {
  const std::string bytes = read_file(path);
  TextCursor start(bytes, path, true);
  const std::string_view magic = start.done() ? std::string_view() : start.token("");
  if (magic == "ply") return read_ply(bytes, path, notes);
  if (is_off(magic)) return read_off(bytes, path, notes);
  if (magic == "version" && start.rest_of_line().find("git-lfs") != std::string_view::npos)
    start.fail("a Git LFS pointer, not the file it stands for", "the file itself (git lfs pull)");
  start.fail(magic.empty() ? "an empty file" : "the first word is " + start.found(),
             "a file that begins with OFF or ply");
}

}  // namespace tendril::bind
