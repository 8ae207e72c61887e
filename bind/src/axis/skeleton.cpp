#include "skeleton.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mean_curvature_flow_skeletonization.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "to_cgal.h"

namespace tendril::axis {
namespace {

using Epick = CGAL::Exact_predicates_inexact_constructions_kernel;

struct OutOfTime {};

/// Checked from within CGAL's loops, some of which have no bound of their own.
class Watch {
 public:
  explicit Watch(double seconds)
      : end_(std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds)) {}
  void check() const {
    if (std::chrono::steady_clock::now() > end_) throw OutOfTime();
  }
  void count() const {
    if (++calls_ % 4096 == 0) check();
  }

 private:
  std::chrono::time_point<std::chrono::steady_clock, std::chrono::duration<double>> end_;
  mutable unsigned calls_ = 0;
};

/// CGAL's kernel, whose distances check the time.
struct Kernel : Epick {
  const Watch* watch = nullptr;

  struct WatchedDistance : Epick::Compute_squared_distance_3 {
    const Watch* watch;
    double operator()(const Epick::Point_3& a, const Epick::Point_3& b) const {
      if (watch != nullptr) watch->count();
      return Epick::Compute_squared_distance_3::operator()(a, b);
    }
  };
  WatchedDistance compute_squared_distance_3_object() const { return {{}, watch}; }
};

using Flow = CGAL::Mean_curvature_flow_skeletonization<CgalMesh, Kernel>;
using Meso = Flow::Meso_skeleton;
using MesoEdge = boost::graph_traits<Meso>::edge_descriptor;

}  // namespace
}  // namespace tendril::axis

/// CGAL collapses edges in the order of a set, which by default is that of their addresses: another one in
/// each run. Their numbers make it the same one. The flow numbers all halfedges before it collapses.
template <>
struct std::less<tendril::axis::MesoEdge> {
  static std::size_t number(const tendril::axis::MesoEdge& edge) {
    const auto halfedge = edge.halfedge();
    return std::min(halfedge->id(), halfedge->opposite()->id());
  }
  bool operator()(const tendril::axis::MesoEdge& a, const tendril::axis::MesoEdge& b) const {
    return number(a) < number(b);
  }
};

namespace tendril::axis {
namespace {

double area(const Meso& meso) {
  return CGAL::Polygon_mesh_processing::area(meso, CGAL::parameters::geom_traits(Epick()));
}

bool is_finite(const Meso& meso) {
  return std::all_of(meso.points_begin(), meso.points_end(), [](const auto& p) {
    return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z());
  });
}

/// As contract_until_convergence, with the time limit and a check for numbers that are not finite.
Contraction run(Flow& flow, const Watch& watch, int& steps) {
  const double whole = area(flow.meso_skeleton());
  double last = 0.0;
  for (steps = 1;; ++steps) {
    flow.contract_geometry();
    if (!is_finite(flow.meso_skeleton())) return Contraction::not_finite;
    watch.check();
    flow.collapse_edges();
    flow.split_faces();
    flow.detect_degeneracies();
    watch.check();
    const double now = area(flow.meso_skeleton());
    if (std::abs(now - last) < flow.area_variation_factor() * whole) return Contraction::converged;
    last = now;
    if (steps >= static_cast<int>(flow.max_iterations())) return Contraction::converged;
  }
}

/// The flow first collapses edges shorter than 0.002 of the diagonal; where most of a mesh has such, what
/// that leaves is uneven, and the skeleton strays or shrinks away.
constexpr double kFine = 2e-3, kLeastEdge = 3e-3, kTriangles = 2e4;

bool mostly_fine(const bind::PolygonMesh& mesh, double diagonal, double& whole) {
  double fine = 0.0;
  whole = 0.0;
  for (const auto& [i, j, k] : bind::fan_triangles(mesh)) {
    const Vec3 &a = mesh.points[i], &b = mesh.points[j], &c = mesh.points[k];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    whole += area;
    if (std::min({(b - a).norm(), (c - b).norm(), (a - c).norm()}) < kFine * diagonal) fine += area;
  }
  return fine > 0.5 * whole;
}

/// Such a mesh anew, with even triangles on the same surface [Botsch, Kobbelt 2004]; as it is where that
/// leaves any without area.
void make_even(const bind::PolygonMesh& mesh, CgalMesh& of) {
  const double diagonal = bind::bounding_diagonal(mesh.points);
  double whole = 0.0;
  if (!mostly_fine(mesh, diagonal, whole)) return;
  const double edge = std::max(kLeastEdge * diagonal, std::sqrt(4.0 / std::sqrt(3.0) * whole / kTriangles));
  namespace processing = CGAL::Polygon_mesh_processing;
  CgalMesh even = of;
  processing::isotropic_remeshing(faces(even), edge, even, CGAL::parameters::number_of_iterations(3));
  even.collect_garbage();
  for (const auto face : faces(even))
    if (!(processing::face_area(face, even) > 0.0)) return;
  if (CGAL::is_closed(even)) of = std::move(even);
}

Skeleton sorted(const Flow::Skeleton& graph) {
  Skeleton out;
  const auto at = [&](std::size_t v) {
    const auto& p = graph[v].point;
    return Vec3(p.x(), p.y(), p.z());
  };
  std::vector<std::uint32_t> order(num_vertices(graph)), rank(order.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 p = at(a), q = at(b);
    return std::tie(p[0], p[1], p[2], a) < std::tie(q[0], q[1], q[2], b);
  });
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    rank[order[k]] = k;
    out.points.push_back(at(order[k]));
  }
  for (const auto edge : CGAL::make_range(edges(graph))) {
    const std::uint32_t a = rank[source(edge, graph)], b = rank[target(edge, graph)];
    out.edges.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(out.edges.begin(), out.edges.end());
  return out;
}

}  // namespace

Contracted contract(const bind::PolygonMesh& mesh, double seconds) {
  const Watch watch(seconds);
  Kernel kernel;
  kernel.watch = &watch;
  CgalMesh input = to_cgal(mesh);
  make_even(mesh, input);
  Contracted out{Contraction::converged, 0, {}};
  try {
    Flow flow(input, kernel);
    out.state = run(flow, watch, out.steps);
    if (out.state != Contraction::converged) return out;
    Flow::Skeleton graph;
    flow.convert_to_skeleton(graph);
    out.skeleton = sorted(graph);
  } catch (const OutOfTime&) {
    out.state = Contraction::out_of_time;
  }
  return out;
}

}  // namespace tendril::axis
