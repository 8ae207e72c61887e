#include "scene/read/contact_reader.h"

/// In place of contact_reader.cpp where tendril::contact was left out.
namespace tendril::scene {

void read_contact(const JsonNode& file, SceneFile&) {
  for (const char* key : {"bodies", "contact", "self_contact"})
    if (file.has(key))
      file.at(key).refuse("this build leaves tendril::contact out", "a build with TENDRIL_CONTACT on");
}

std::vector<ContactPoint> contacts_of(const SceneFile&, const State&) {
  return {};
}
std::vector<MeshContactPoint> mesh_contacts_of(const SceneFile&, const State&) {
  return {};
}
std::vector<MeshSelfContactPoint> mesh_self_contacts_of(const SceneFile&, const State&) {
  return {};
}
std::vector<RodContactPoint> rod_contacts_of(const SceneFile&, const State&) {
  return {};
}

}  // namespace tendril::scene
