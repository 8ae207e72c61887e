// Bounding volumes as they cull points, beside each other: the thesis's cylinder, conservative sections, and
// the boxes of the axial hierarchy. Truth: the side of the deformed mesh, by CGAL's exact predicates. Prints
// the table.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>
#include <tendril/bind/import.h>
#include <tendril/collision/axial_sections.h>
#include <tendril/collision/thesis_cylinder.h>
#include <tendril/curve/closest_point.h>

#include <cstdio>

#include "collision/bound_meshes.h"

namespace tendril::collision {
namespace {

using K = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<K::Point_3>;
using test::BoundMesh;
using test::Random;

K::Point_3 point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

Surface surface_of(const std::vector<Vec3>& at, const std::vector<Triangle>& triangles) {
  Surface out;
  for (const Vec3& p : at) out.add_vertex(point(p));
  for (const auto& [a, b, c] : triangles)
    out.add_face(Surface::Vertex_index(a), Surface::Vertex_index(b), Surface::Vertex_index(c));
  return out;
}

double normal(Random& random) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += random.uniform(-0.5, 0.5);
  return sum;
}

/// Points of a surface, by area.
class Sampler {
 public:
  Sampler(const std::vector<Vec3>& at, const std::vector<Triangle>& triangles)
      : at_(at), triangles_(triangles) {
    double sum = 0.0;
    for (const auto& [a, b, c] : triangles)
      area_.push_back(sum += (at[b] - at[a]).cross(at[c] - at[a]).norm());
  }
  Vec3 operator()(Random& random) const {
    const auto found = std::lower_bound(area_.begin(), area_.end(), random.uniform(0.0, area_.back()));
    const Triangle& t = triangles_[static_cast<std::size_t>(found - area_.begin())];
    const double a = std::sqrt(random.uniform());
    const double b = random.uniform();
    return (1.0 - a) * at_[t[0]] + a * (1.0 - b) * at_[t[1]] + a * b * at_[t[2]];
  }

 private:
  const std::vector<Vec3>& at_;
  const std::vector<Triangle>& triangles_;
  std::vector<double> area_;
};

/// What a volume is asked: points in space with their truth, of the surface, and the vertices.
struct Questions {
  std::vector<Vec3> space, surface, vertices;
  std::vector<bool> inside;
  std::size_t uniform = 0;  ///< so many of `space` fill a box, the others lie about the surface
};

Questions ask(const std::vector<Vec3>& at, const std::vector<Triangle>& triangles) {
  constexpr int half = 15000, on = 20000;
  Questions q;
  Random random(1);
  const Sampler on_surface(at, triangles);
  const Box box = box_of(at);
  const Vec3 size = box.high - box.low, low = box.low - 0.1 * size;
  q.uniform = half;
  for (int i = 0; i < half; ++i)
    q.space.push_back(low + 1.2 * size.cwiseProduct(0.5 * (Vec3::Ones() + random.in_cube())));
  for (int i = 0; i < half; ++i) {
    const Vec3 base = on_surface(random);
    const double x = normal(random), y = normal(random), z = normal(random);
    q.space.push_back(base + 0.02 * size.maxCoeff() * Vec3(x, y, z));
  }
  for (int i = 0; i < on; ++i) q.surface.push_back(on_surface(random));
  q.vertices = at;
  const Surface mesh = surface_of(at, triangles);
  const CGAL::Side_of_triangle_mesh<Surface, K> side(mesh);
  for (const Vec3& e : q.space) q.inside.push_back(side(point(e)) != CGAL::ON_UNBOUNDED_SIDE);
  return q;
}

/// In percent; `ratio` of volumes.
struct Row {
  double missed_inside, missed_surface, missed_vertices, false_hits, ratio;
};

/// \param holds    whether a point is called a hit
/// \param surface  the same of a point of the surface
template <class Holds, class OnSurface>
Row measure(const Questions& q, const Holds& holds, const OnSurface& surface) {
  double inside = 0, outside = 0, missed = 0, wrong = 0, volume = 0, solid = 0;
  for (std::size_t i = 0; i < q.space.size(); ++i) {
    const bool hit = holds(q.space[i]);
    (q.inside[i] ? inside : outside) += 1;
    if (q.inside[i] && !hit) ++missed;
    if (!q.inside[i] && hit) ++wrong;
    if (i < q.uniform) volume += hit, solid += q.inside[i];
  }
  const auto out = [&](const std::vector<Vec3>& points) {
    const auto n = std::count_if(points.begin(), points.end(), [&](const Vec3& p) { return !surface(p); });
    return 100.0 * static_cast<double>(n) / static_cast<double>(points.size());
  };
  return {100 * missed / inside, out(q.surface), out(q.vertices), 100 * wrong / outside, volume / solid};
}

/// Inside or on, by the parity of a segment to somewhere outside through the hierarchy.
bool inside(AxialHierarchy& hierarchy, const Vec3& e, const Vec3& far) {
  bool in = false;
  const K::Segment_3 way(point(e), point(far));
  hierarchy.along(e, far, [&](const PlacedTriangle& t) {
    const K::Triangle_3 triangle(point(t.corners[0]), point(t.corners[1]), point(t.corners[2]));
    if (!triangle.is_degenerate() && CGAL::do_intersect(way, triangle)) in = !in;
  });
  return in;
}

struct Volumes {
  const BoundMesh& mesh;
  const CurvePair& pose;
  Questions questions;
  CurveProjector projector;

  Volumes(const BoundMesh& bound, const CurvePair& posed)
      : mesh(bound),
        pose(posed),
        questions(ask(bound.at({posed}), bound.triangles)),
        projector(posed.primary()) {}

  template <class Volume>
  Row projected(const Volume& volume) const {
    const auto holds = [&](const Vec3& e) { return volume.holds(to_axial(pose, projector.nearest(e).t, e)); };
    return measure(questions, holds, holds);
  }
  Row thesis() const { return projected(ThesisCylinder(mesh.binding.records(), pose.knots())); }
  Row sections(Section section, std::size_t regions) const {
    return projected(AxialSections(mesh.binding.records(), mesh.triangles, pose.knots(), section, regions));
  }

  /// Culled by the boxes of cells as slabs bound them, or of triangles; what no box holds is told by parity.
  Row hierarchy(bool exact) const {
    PlacedCells cells(mesh.rest, mesh.points, mesh.triangles, {256, 2.0});
    AxialHierarchy parity(mesh.rest, mesh.points, mesh.triangles);
    cells.pose({&pose, 1});
    parity.pose({&pose, 1});
    const Box all = box_of(questions.vertices);
    const Vec3 far = all.high + Vec3(0.31, 0.77, 0.53) * (all.high - all.low).norm();
    const auto in_box = [&](const Vec3& e) {
      return exact ? in_triangle_box(parity, e) : in_cell(cells, cells.root(), e);
    };
    return measure(
        questions, [&](const Vec3& e) { return in_box(e) || inside(parity, e, far); }, in_box);
  }

 private:
  static bool in_cell(PlacedCells& cells, const PlacedCells::Node& n, const Vec3& e) {
    if (!cells.box(n).holds(e)) return false;
    return n.cell() || in_cell(cells, n.left(), e) || in_cell(cells, n.right(), e);
  }
  static bool in_triangle_box(AxialHierarchy& hierarchy, const Vec3& e) {
    bool found = false;
    const Vec3 rounding = Vec3::Constant(1e-14);  // of the sampled point, which is no longer on the triangle
    hierarchy.meeting({e - rounding, e + rounding}, [&](const PlacedTriangle&) { found = true; });
    return found;
  }
};

void print(const std::string& mesh, const std::string& volume, const Row& row) {
  std::printf("%-28s %-26s %7.2f %9.2f %10.2f %8.2f %8.2f\n", mesh.c_str(), volume.c_str(), row.missed_inside,
              row.missed_surface, row.missed_vertices, row.false_hits, row.ratio);
}

struct Rows {
  Row thesis, circle, box, octagon, cells, triangles;
};

Rows table(const std::string& name, const BoundMesh& mesh, double bend, double twist) {
  const CurvePair pose =
      test::bent(mesh.rest[0], bend * std::numbers::pi / 180, twist * std::numbers::pi / 180);
  const Volumes volumes(mesh, pose);
  const Rows rows{volumes.thesis(),
                  volumes.sections(Section::circle, 64),
                  volumes.sections(Section::box, 64),
                  volumes.sections(Section::octagon, 64),
                  volumes.hierarchy(false),
                  volumes.hierarchy(true)};
  const std::string posed = name + ", bend " + std::to_string(static_cast<int>(bend)) + ", twist " +
                            std::to_string(static_cast<int>(twist));
  std::printf("%-28s %-26s %7s %9s %10s %8s %8s\n", "mesh, degrees", "volume", "FN %", "surface %",
              "vertices %", "FP %", "ratio");
  print(posed, "thesis's cylinder", rows.thesis);
  print(posed, "circles, 64 regions", rows.circle);
  print(posed, "boxes, 64 regions", rows.box);
  print(posed, "octagons, 64 regions", rows.octagon);
  print(posed, "hierarchy, cells by slabs", rows.cells);
  print(posed, "hierarchy, triangles", rows.triangles);
  return rows;
}

/// Slab boxes of cells only say where to deform; what is asked of the hierarchy is about boxes after that.
/// \param most  percent of the points outside that these may call hits
void hold(const Rows& rows, bool straight, double most) {
  EXPECT_GT(rows.thesis.missed_vertices, 5.0);
  EXPECT_GT(rows.thesis.missed_surface, 2.0);
  EXPECT_GT(rows.thesis.false_hits, 2.0 * rows.triangles.false_hits);
  if (straight) {
    for (const Row& row : {rows.circle, rows.box, rows.octagon}) {
      EXPECT_EQ(row.missed_inside, 0.0);
      EXPECT_EQ(row.missed_vertices, 0.0);
    }
    EXPECT_LE(rows.octagon.false_hits, rows.box.false_hits);
    EXPECT_LT(rows.box.false_hits, rows.circle.false_hits);
  }
  for (const Row& row : {rows.cells, rows.triangles}) {
    EXPECT_EQ(row.missed_inside, 0.0);
    EXPECT_EQ(row.missed_surface, 0.0);
    EXPECT_EQ(row.missed_vertices, 0.0);
  }
  EXPECT_LE(rows.triangles.false_hits, most);
  EXPECT_LE(rows.triangles.false_hits, rows.cells.false_hits);
}

TEST(Culling, OfALeaf) {
  const BoundMesh mesh{{test::straight_pair(8, 0.02)}, test::leaf(200, 96)};
  hold(table("leaf", mesh, 0, 0), true, 5.0);
  hold(table("leaf", mesh, 45, 0), false, 5.0);
  hold(table("leaf", mesh, 180, 90), false, 10.0);
}

#ifdef TENDRIL_CGAL_MESHES
class CullingOf : public testing::TestWithParam<const char*> {};

TEST_P(CullingOf, AnAnimal) {
  const std::string name = GetParam();
  const BoundMesh mesh{
      {test::straight_pair(8, 0.02)},
      test::along_x(bind::read_mesh(std::string(TENDRIL_CGAL_MESHES) + "/" + name + ".off"))};
  hold(table(name, mesh, 0, 0), true, 25.0);
  hold(table(name, mesh, 90, 60), false, 25.0);
  hold(table(name, mesh, 180, 180), false, 25.0);
}

INSTANTIATE_TEST_SUITE_P(Meshes, CullingOf, testing::Values("elephant", "cactus"));
#endif

}  // namespace
}  // namespace tendril::collision
