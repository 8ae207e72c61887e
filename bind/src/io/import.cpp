#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/bind/import.h>

#include <algorithm>

#include "io/obj/obj_line.h"
#include "io/stl/stl_kind.h"
#include "io/values/import_values.h"

namespace tendril::bind {
namespace {

/// "OFF" with prefixes, or with the first count glued to it.
bool is_off(std::string_view word) {
  const std::size_t off = word.find("OFF");
  return off != word.npos && word.find_first_not_of("0123456789", off + 3) == word.npos;
}

/// In letters of either size.
bool ends_with(const std::string& path, std::string_view ending) {
  return path.size() >= ending.size() &&
         std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char a, char b) { return a == b || (b >= 'A' && b <= 'Z' && a == b - 'A' + 'a'); });
}

using Read = PolygonMesh (*)(std::string_view, const std::string&, std::vector<std::string>*);

/// The reader for a file; null where neither its content nor its name tells.
Read reader_of(std::string_view bytes, std::string_view magic, const std::string& path) {
  const StlKind stl = stl_kind(bytes);
  const bool some_facets = stl == StlKind::binary && bytes.size() > kStlBegin;
  if (some_facets) return read_stl;  // also where its header begins with another format's word
  if (magic == "ply") return read_ply;
  if (is_off(magic)) return read_off;
  if (stl != StlKind::none) return read_stl;
  if (obj_keyword(magic) != ObjKeyword::unknown || ends_with(path, ".obj")) return read_obj;
  return ends_with(path, ".stl") ? read_stl : nullptr;
}

}  // namespace

PolygonMesh read_mesh(const std::string& path, std::vector<std::string>* notes) {
  const std::string bytes = read_file(path);
  TextCursor start(bytes, path, true);
  const std::string_view magic = start.done() ? std::string_view() : start.token("");
  if (magic == "version" && start.rest_of_line().find("git-lfs") != std::string_view::npos)
    start.fail("a Git LFS pointer, not the file it stands for", "the file itself (git lfs pull)");
  if (const Read read = reader_of(bytes, magic, path); read && !bytes.empty())
    return read(bytes, path, notes);
  start.fail(magic.empty() ? "an empty file" : "the first word is " + start.found(), "OFF, PLY, OBJ or STL");
}

}  // namespace tendril::bind
