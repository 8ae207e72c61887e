#include <CGAL/Polyhedron_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/graph_traits_PolyMesh_ArrayKernelT.h>
#include <CGAL/boost/graph/graph_traits_Polyhedron_3.h>
#include <gtest/gtest.h>
#include <tendril/bind/face_graph.h>
#include <tendril/bind/open_mesh.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include "support/pairs.h"

namespace tendril::bind {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using OpenMeshMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

/// A torus of quadrilaterals, in any mesh type, with the vertices in the same order.
constexpr int kRound = 60;
constexpr int kSection = 24;

Vec3 torus(int i, int j) {
  const double a = 2 * std::numbers::pi * i / kRound;
  const double b = 2 * std::numbers::pi * j / kSection;
  const double r = 3 + std::cos(b);
  return Vec3(1.7 * r * std::cos(a), r * std::sin(a), std::sin(b));
}

template <class Graph>
auto point_map(Graph& graph) {
  return get(CGAL::vertex_point, graph);
}
auto point_map(OpenMeshMesh& graph) {
  return OpenMeshPointMap<OpenMeshMesh>(graph);
}

template <class Graph>
Graph make_torus() {
  Graph graph;
  using Traits = boost::graph_traits<Graph>;
  using Point = typename boost::property_traits<decltype(point_map(graph))>::value_type;
  std::vector<typename Traits::vertex_descriptor> v;
  for (int i = 0; i < kRound; ++i)
    for (int j = 0; j < kSection; ++j) {
      v.push_back(add_vertex(graph));
      const Vec3 p = torus(i, j);
      put(point_map(graph), v.back(), Point(p.x(), p.y(), p.z()));
    }
  const auto at = [&](int i, int j) {
    return v[static_cast<std::size_t>((i % kRound) * kSection + j % kSection)];
  };
  for (int i = 0; i < kRound; ++i)
    for (int j = 0; j < kSection; ++j) {
      const std::vector<typename Traits::vertex_descriptor> face{at(i, j), at(i + 1, j), at(i + 1, j + 1),
                                                                 at(i, j + 1)};
      CGAL::Euler::add_face(face, graph);
    }
  return graph;
}

std::vector<CurvePair> rest_and_posed(Points points) {
  const std::vector<Vec3> axis = test::axis_through(points, 0.15);
  std::vector<CurvePair> pairs{test::pair_through(axis, test::side_of(axis), 0.5)};
  std::vector<Vec3> moved = axis;
  for (Vec3& p : moved) p += Vec3(0, 0.1 * p.x() * p.x(), std::sin(p.x()));
  const Interpolator fit(3, axis);
  std::vector<Vec3> q = moved;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += Vec3(0, -std::sin(0.3 * static_cast<double>(i)), 1.0);
  pairs.emplace_back(fit.knots(), fit.solve(moved), fit.solve(q));
  return pairs;
}

template <class Graph>
class EveryMeshType : public testing::Test {};
using MeshTypes = testing::Types<SurfaceMesh, Polyhedron, OpenMeshMesh>;
TYPED_TEST_SUITE(EveryMeshType, MeshTypes);

TYPED_TEST(EveryMeshType, MovesToTheSameBitsAsPlainPoints) {
  std::vector<Vec3> plain;
  for (int i = 0; i < kRound; ++i)
    for (int j = 0; j < kSection; ++j) plain.push_back(torus(i, j));
  const std::vector<CurvePair> pairs = rest_and_posed(plain);
  std::vector<Vec3> expected(plain.size());
  Binding(pairs[0], plain).update(pairs[1], expected);

  EXPECT_GT((expected[7] - plain[7]).norm(), 0.1);

  for (const int threads : {1, 3}) {
    TypeParam graph = make_torus<TypeParam>();
    ASSERT_EQ(num_faces(graph), static_cast<std::size_t>(kRound * kSection));
    ASSERT_EQ(points_of(graph, point_map(graph)), plain);
    FaceGraphFollower follower(graph, point_map(graph), pairs[0], 1, threads);
    follower.follow(0.0, pairs);
    EXPECT_EQ(points_of(graph, point_map(graph)), expected) << threads;
    EXPECT_LT(follower.binding().report().rest_error, 1e-13 * 14);
  }
}

}  // namespace
}  // namespace tendril::bind
