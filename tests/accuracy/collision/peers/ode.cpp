// ODE: balls and triangle meshes, which have a front alone: balls whose centres are behind a face pass it.
// Its test of two meshes is not asked: as packaged, 0.16.2 crashes on meshes of one triangle.
#include <ode/ode.h>

#include "accuracy/collision/adapter.h"

namespace tendril::suite {
namespace {

/// ODE is begun once and ended with the program.
struct Library {
  Library() {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
  }
  ~Library() { dCloseODE(); }
};

void begin() {
  static const Library library;
}

class Geometry {
 public:
  Geometry(Points points, Triangles triangles) : points_(points.begin(), points.end()) {
    begin();
    for (const auto& t : triangles) corners_.insert(corners_.end(), t.begin(), t.end());
    data_ = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data_, points_.data(), sizeof(Vec3), static_cast<int>(points_.size()),
                                corners_.data(), static_cast<int>(corners_.size()), 3 * sizeof(dTriIndex));
    mesh_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
  }
  ~Geometry() {
    dGeomDestroy(mesh_);
    dGeomTriMeshDataDestroy(data_);
  }
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;
  dGeomID mesh() const { return mesh_; }

 private:
  std::vector<Vec3> points_;
  std::vector<dTriIndex> corners_;
  dTriMeshDataID data_;
  dGeomID mesh_;
};

bool meet(dGeomID a, dGeomID b) {
  dContactGeom contacts[8];
  return dCollide(a, b, 8, contacts, sizeof(dContactGeom)) > 0;
}

class Mesh : public MeshPeer {
 public:
  Mesh(Points points, Triangles triangles) : geometry_(points, triangles), ball_(dCreateSphere(nullptr, 1)) {}
  ~Mesh() override { dGeomDestroy(ball_); }
  Said meets(const Vec3& centre, double radius) override {
    dGeomSphereSetRadius(ball_, radius);
    dGeomSetPosition(ball_, centre.x(), centre.y(), centre.z());
    return meet(geometry_.mesh(), ball_);
  }

 private:
  Geometry geometry_;
  dGeomID ball_;
};

}  // namespace

Adapter ode_adapter() {
  Adapter out{"ODE"};
  out.mesh = mesh_of<Mesh>;
  out.meets = true;
  return out;
}

}  // namespace tendril::suite
