#pragma once

#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>
#include <tendril/bind/binding.h>
#include <tendril/dynamics/follower.h>

/// The door for meshes: any model of CGAL's FaceGraph (Surface_mesh, Polyhedron_3, OpenMesh through CGAL's
/// adaptor, a user's own) with a vertex point map whose value has operator[] and a constructor from three
/// numbers. Only BGL and property maps are used, no kernel and no GPL package.
namespace tendril::bind {

/// Positions in the order of vertices(graph).
template <class Graph, class PointMap>
std::vector<Vec3> points_of(const Graph& graph, PointMap map) {
  std::vector<Vec3> points;
  points.reserve(num_vertices(graph));
  for (const auto vertex : CGAL::make_range(vertices(graph))) {
    const auto& p = get(map, vertex);
    points.emplace_back(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
  }
  return points;
}

template <class Graph>
std::vector<Vec3> points_of(const Graph& graph) {
  return points_of(graph, get(CGAL::vertex_point, graph));
}

/// Writes positions back, in the same order. The graph must have as many vertices as there are points.
template <class Graph, class PointMap>
void assign_points(Graph& graph, PointMap map, Points points) {
  using Point = typename boost::property_traits<PointMap>::value_type;
  std::size_t i = 0;
  for (const auto vertex : CGAL::make_range(vertices(graph))) {
    const Vec3& p = points[i++];
    put(map, vertex, Point(p.x(), p.y(), p.z()));
  }
}

template <class Graph>
void assign_points(Graph& graph, Points points) {
  assign_points(graph, get(CGAL::vertex_point, graph), points);
}

/// Binds a mesh's vertices and moves the mesh itself at every call of follow. The graph is kept by reference
/// and must not gain or lose vertices.
template <class Graph, class PointMap = typename boost::property_map<Graph, CGAL::vertex_point_t>::type>
class FaceGraphFollower : public Follower {
 public:
  FaceGraphFollower(Graph& graph, PointMap map, const CurvePair& rest, std::size_t pair = 0, int threads = 1)
      : graph_(graph),
        map_(map),
        points_(points_of(graph, map)),
        binding_(rest, points_, threads),
        pair_(pair),
        threads_(threads) {}

  FaceGraphFollower(Graph& graph, const CurvePair& rest, std::size_t pair = 0, int threads = 1)
      : FaceGraphFollower(graph, get(CGAL::vertex_point, graph), rest, pair, threads) {}

  void follow(double, std::span<const CurvePair> pairs) override {
    binding_.update(pairs[pair_], points_, threads_);
    assign_points(graph_, map_, points_);
  }
  const Binding& binding() const { return binding_; }

 private:
  Graph& graph_;
  PointMap map_;
  std::vector<Vec3> points_;
  Binding binding_;
  std::size_t pair_;
  int threads_;
};

}  // namespace tendril::bind
