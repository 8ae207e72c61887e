// GTS, whose orientation tests are adaptive and exact: of two triangles by their edges, coplanar ones it
// does not say.
#include <gts.h>

#include "accuracy/collision/adapter.h"

namespace tendril::suite {
namespace {

GtsVertex* vertex(const Vec3& x) {
  return gts_vertex_new(gts_vertex_class(), x.x(), x.y(), x.z());
}

struct Face {
  explicit Face(const Corners& t) {
    GtsVertex* v[3] = {vertex(t[0]), vertex(t[1]), vertex(t[2])};
    for (int i = 0; i < 3; ++i) edges[i] = gts_edge_new(gts_edge_class(), v[i], v[(i + 1) % 3]);
    face = gts_face_new(gts_face_class(), edges[0], edges[1], edges[2]);
  }
  ~Face() { gts_object_destroy(GTS_OBJECT(face)); }  // and what nothing else uses of it
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;

  GtsEdge* edges[3];
  GtsFace* face;
};

bool meet(GtsEdge* edge, GtsFace* face) {
  GtsPoint* at =
      gts_segment_triangle_intersection(GTS_SEGMENT(edge), GTS_TRIANGLE(face), TRUE, gts_point_class());
  const GtsSegment* s = GTS_SEGMENT(edge);
  const bool fresh = at != nullptr && at != GTS_POINT(s->v1) && at != GTS_POINT(s->v2);
  const bool corner = fresh && GTS_IS_VERTEX(at);
  if (fresh && !corner) gts_object_destroy(GTS_OBJECT(at));
  return at != nullptr;
}

bool in_plane(const Corners& t, const Vec3& x) {
  GtsPoint p[4];
  const Vec3* from[4] = {&t[0], &t[1], &t[2], &x};
  for (int i = 0; i < 4; ++i) p[i].x = from[i]->x(), p[i].y = from[i]->y(), p[i].z = from[i]->z();
  return gts_point_orientation_3d(&p[0], &p[1], &p[2], &p[3]) == 0.0;
}

Said triangles(const Corners& a, const Corners& b) {
  if (in_plane(a, b[0]) && in_plane(a, b[1]) && in_plane(a, b[2])) return {};
  const Face first(a), second(b);
  for (int i = 0; i < 3; ++i)
    if (meet(first.edges[i], second.face) || meet(second.edges[i], first.face)) return true;
  return false;
}

Said segment(const Corners& a, const Ends& s) {
  if (in_plane(a, s[0]) && in_plane(a, s[1])) return {};
  const Face face(a);
  GtsEdge* edge = gts_edge_new(gts_edge_class(), vertex(s[0]), vertex(s[1]));
  const bool out = meet(edge, face.face);
  gts_object_destroy(GTS_OBJECT(edge));
  return out;
}

class Mesh : public MeshPeer {
 public:
  Mesh(Points points, Triangles triangles)
      : surface_(
            gts_surface_new(gts_surface_class(), gts_face_class(), gts_edge_class(), gts_vertex_class())) {
    std::vector<GtsVertex*> v;
    for (const Vec3& x : points) v.push_back(vertex(x));
    const auto edge = [&](std::uint32_t a, std::uint32_t b) {
      if (GtsSegment* known = gts_vertices_are_connected(v[a], v[b])) return GTS_EDGE(known);
      return gts_edge_new(gts_edge_class(), v[a], v[b]);
    };
    for (const auto& [a, b, c] : triangles)
      gts_surface_add_face(surface_, gts_face_new(gts_face_class(), edge(a, b), edge(b, c), edge(c, a)));
    tree_ = gts_bb_tree_surface(surface_);
  }
  ~Mesh() override {
    gts_bb_tree_destroy(tree_, TRUE);
    gts_object_destroy(GTS_OBJECT(surface_));
  }
  Said holds(const Vec3& x) override {
    GtsPoint* p = gts_point_new(gts_point_class(), x.x(), x.y(), x.z());
    const bool out = gts_point_is_inside_surface(p, tree_, FALSE) != 0;
    gts_object_destroy(GTS_OBJECT(p));
    return out;
  }

 private:
  GtsSurface* surface_;
  GNode* tree_;
};

}  // namespace

Adapter gts_adapter() {
  Adapter out{"GTS"};
  out.proper = true;
  out.triangles = triangles;
  out.segment = segment;
  out.mesh = mesh_of<Mesh>;
  out.holds = true;
  return out;
}

}  // namespace tendril::suite
