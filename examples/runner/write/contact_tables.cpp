#include "write/contact_tables.h"

#include <tendril/base/number.h>

namespace tendril::runner {
namespace {

void append(std::string& line, const Vec3& v) {
  for (const double x : v) line.append(1, ',').append(shortest(x));
}
void append(std::string& line, std::size_t number) {
  line.append(1, ',').append(std::to_string(number));
}

/// What all contacts have in common, to the end of the line.
template <class Contact>
void append_meeting(std::string& line, const Contact& c) {
  line.append(1, ',').append(shortest(c.gap));
  for (const Vec3& v : {c.point, c.normal, c.force, c.friction}) append(line, v);
  line += c.sticks ? ",1\n" : ",0\n";
}

}  // namespace

void ContactTables::add(const scene::Snapshot& snapshot) {
  const std::string time = shortest(snapshot.time);
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
    const scene::SolidPose& pose = snapshot.bodies[i];
    bodies_ += time;
    append(bodies_, i);
    for (const Vec3& v : {pose.position, Vec3(pose.rotation.col(0)), Vec3(pose.rotation.col(2))})
      append(bodies_, v);
    bodies_ += '\n';
  }
  for (const scene::ContactPoint& c : snapshot.contacts) {
    contacts_ += time;
    append(contacts_, c.curve_pair);
    append(contacts_, c.node);
    contacts_.append(1, ',').append(shortest(c.fraction));
    append(contacts_, c.body);
    append_meeting(contacts_, c);
  }
  for (const scene::MeshContactPoint& c : snapshot.mesh_contacts) {
    mesh_contacts_ += time;
    append(mesh_contacts_, c.face);
    append(mesh_contacts_, c.body);
    append_meeting(mesh_contacts_, c);
  }
  for (const scene::MeshSelfContactPoint& c : snapshot.mesh_self_contacts) {
    mesh_self_contacts_ += time;
    for (const std::size_t face : c.face) append(mesh_self_contacts_, face);
    append_meeting(mesh_self_contacts_, c);
  }
  for (const scene::RodContactPoint& c : snapshot.rod_contacts) {
    rod_contacts_ += time;
    for (const std::size_t i : {0, 1}) {
      append(rod_contacts_, c.curve_pair[i]);
      append(rod_contacts_, c.node[i]);
      rod_contacts_.append(1, ',').append(shortest(c.fraction[i]));
    }
    append_meeting(rod_contacts_, c);
  }
}

}  // namespace tendril::runner
