#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/bind/import.h>

#include "cursor.h"
#include "import_values.h"

namespace tendril::bind {

PolygonMesh read_mesh(const std::string& path, std::vector<std::string>* notes) {
  const std::string bytes = read_file(path);
  TextCursor start(bytes, path, true);
  const std::string_view magic = start.done() ? std::string_view() : start.token("");
  if (magic == "ply") return parse_ply(bytes, path);
  if (magic.ends_with("OFF")) return read_off(bytes, path, notes);
  start.fail(magic.empty() ? "an empty file" : "the first word is " + start.found(),
             "a file that begins with OFF or ply");
}

}  // namespace tendril::bind
