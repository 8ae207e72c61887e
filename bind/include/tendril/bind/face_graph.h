#pragma once

#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>
#include <tendril/bind/binding.h>
#include <tendril/dynamics/follower.h>

#include <map>

/// Meshes of any type: any model of CGAL's FaceGraph (Surface_mesh, Polyhedron_3, OpenMesh through CGAL's
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

/// The same by the graph's own point map.
template <class Graph>
std::vector<Vec3> points_of(const Graph& graph) {
  return points_of(graph, get(CGAL::vertex_point, graph));
}

/// The graph as flat arrays, points in the order of vertices(graph).
template <class Graph, class PointMap>
PolygonMesh mesh_of(const Graph& graph, PointMap map) {
  using Vertex = typename boost::graph_traits<Graph>::vertex_descriptor;
  PolygonMesh mesh;
  mesh.points = points_of(graph, map);
  std::map<Vertex, std::uint32_t> number;
  for (const Vertex vertex : CGAL::make_range(vertices(graph)))
    number.emplace(vertex, static_cast<std::uint32_t>(number.size()));
  for (const auto face : CGAL::make_range(faces(graph))) {
    for (const Vertex vertex : CGAL::vertices_around_face(halfedge(face, graph), graph))
      mesh.corners.push_back(number.at(vertex));
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  }
  return mesh;
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

/// The same by the graph's own point map.
template <class Graph>
void assign_points(Graph& graph, Points points) {
  assign_points(graph, get(CGAL::vertex_point, graph), points);
}

/// Binds a mesh's vertices and moves the mesh itself at every call of follow. The graph is kept by reference
/// and must not gain or lose vertices. Throws InvalidInput as Binding does.
template <class Graph, class PointMap = typename boost::property_map<Graph, CGAL::vertex_point_t>::type>
class FaceGraphFollower : public Follower {
 public:
  /// To the nearest point of one curve-pair, which is number `pair` of the simulation.
  FaceGraphFollower(Graph& graph, PointMap map, const CurvePair& rest, std::size_t pair = 0, int threads = 1)
      : graph_(graph),
        map_(map),
        points_(points_of(graph, map)),
        binding_(rest, points_, threads),
        pair_(pair),
        threads_(threads) {}

  /// Bound as the options say, to as many curve-pairs as `rest` holds; `pair` is the first of them.
  FaceGraphFollower(Graph& graph, PointMap map, std::span<const CurvePair> rest, const BindOptions& options,
                    std::size_t pair = 0)
      : graph_(graph),
        map_(map),
        points_(points_of(graph, map)),
        binding_(rest, mesh_of(graph, map), options),
        pair_(pair),
        threads_(options.threads) {}

  /// The same by the graph's own point map.
  FaceGraphFollower(Graph& graph, const CurvePair& rest, std::size_t pair = 0, int threads = 1)
      : FaceGraphFollower(graph, get(CGAL::vertex_point, graph), rest, pair, threads) {}

  void follow(double, std::span<const CurvePair> pairs) override {
    binding_.update(pairs.subspan(pair_, binding_.pair_count()), points_, threads_);
    assign_points(graph_, map_, points_);
  }
  const Binding& binding() const { return binding_; }  ///< of its vertices, in the order of vertices(graph)

 private:
  Graph& graph_;
  PointMap map_;
  std::vector<Vec3> points_;
  Binding binding_;
  std::size_t pair_;
  int threads_;
};

}  // namespace tendril::bind
