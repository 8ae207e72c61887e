#include <tendril/base/error.h>
#include <tendril/bind/export.h>
#include <tendril/bind/import.h>
#include <tendril/bind/inspect.h>

#include <cstddef>
#include <cstdlib>

/// Any bytes: each reader refuses them with InvalidInput, or gives a valid mesh that can be inspected and
/// survives being written and read again.
namespace {

void check(const tendril::bind::PolygonMesh& mesh) {
  namespace bind = tendril::bind;
  bind::inspect(mesh);
  const std::string ply = bind::ply_bytes(mesh);
  if (bind::ply_bytes(bind::parse_ply(ply, "again")) != ply) std::abort();
  if (!mesh.corner_texture.empty()) return;  // OFF has no place for them
  const std::string off = bind::off_text(mesh);
  if (bind::off_text(bind::parse_off(off, "again")) != off) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const auto parse : {tendril::bind::parse_off, tendril::bind::parse_ply, tendril::bind::parse_obj,
                           tendril::bind::parse_stl}) {
    tendril::bind::PolygonMesh mesh;
    try {
      mesh = parse(bytes, "fuzz");
    } catch (const tendril::InvalidInput&) {
      continue;
    }
    check(mesh);  // outside the try: a mesh that was accepted must not be refused later
  }
  return 0;
}
