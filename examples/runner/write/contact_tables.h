#pragma once

#include <tendril/scene/scene_run.h>

#include <string>

namespace tendril::runner {

/// The solids of a run, and what rods are in contact with, as tables: numbers are the shortest that read
/// back to the same double; lines end with "\n".
class ContactTables {
 public:
  void add(const scene::Snapshot& snapshot);

  /// A line for each output and solid: where it is, and its axes x and z.
  const std::string& bodies() const { return bodies_; }
  /// A line for each output and point in contact.
  const std::string& contacts() const { return contacts_; }
  /// A line for each output and point of the mesh in contact.
  const std::string& mesh_contacts() const { return mesh_contacts_; }
  /// A line for each output and two places of the mesh in contact.
  const std::string& mesh_self_contacts() const { return mesh_self_contacts_; }
  /// A line for each output and pair of points of rods in contact.
  const std::string& rod_contacts() const { return rod_contacts_; }

 private:
  std::string bodies_ = "time,body,x,y,z,xx,xy,xz,zx,zy,zz\n";
  std::string contacts_ =
      "time,rod,node,fraction,body,gap,px,py,pz,nx,ny,nz,fx,fy,fz,friction_x,friction_y,friction_z,sticks\n";
  std::string mesh_contacts_ =
      "time,face,body,gap,px,py,pz,nx,ny,nz,fx,fy,fz,friction_x,friction_y,friction_z,sticks\n";
  std::string mesh_self_contacts_ =
      "time,face,other_face,gap,px,py,pz,nx,ny,nz,fx,fy,fz,friction_x,friction_y,friction_z,sticks\n";
  std::string rod_contacts_ =
      "time,rod,node,fraction,other_rod,other_node,other_fraction,gap,px,py,pz,nx,ny,nz,fx,fy,fz,friction_x,"
      "friction_y,friction_z,sticks\n";
};

}  // namespace tendril::runner
