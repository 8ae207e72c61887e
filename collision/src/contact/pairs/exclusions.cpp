#include "exclusions.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <queue>
#include <string>

#include "contact/by_key.h"

namespace tendril::contact {
namespace {

constexpr double kAlong = 0.5 * std::numbers::pi, kNearAlong = 8.0, kRestsNear = 1.5;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::uint64_t key_of(std::uint32_t first, std::uint32_t second) {
  return (std::uint64_t{first} << 32) | second;
}

struct Link {
  std::uint32_t to;
  double length;
};

/// Nodes of all rods in contact, and the graph between them.
using Graph = std::vector<std::vector<Link>>;

void connect(Graph& graph, std::uint32_t a, std::uint32_t b, double length) {
  graph[a].push_back({b, length});
  graph[b].push_back({a, length});
}

/// The node that a joint names on one side, among those of the lines.
std::uint32_t node_of(const RodLines& lines, const RodJoint& joint, std::size_t side, std::size_t i) {
  const std::string place = "contact.joints[" + std::to_string(i) + "]";
  std::size_t first = 0;
  for (const ContactRod& rod : lines.rods) {
    if (rod.rod != joint.rod[side]) {
      first += rod.rest.size();
      continue;
    }
    if (joint.node[side] < rod.rest.size()) return static_cast<std::uint32_t>(first + joint.node[side]);
    throw InvalidInput(place + ".node", std::to_string(joint.node[side]),
                       "below the rod's number of masses, " + std::to_string(rod.rest.size()));
  }
  throw InvalidInput(place + ".rod", std::to_string(joint.rod[side]), "a rod in contact");
}

Graph graph_of(const RodLines& lines, const std::vector<RodJoint>& joints) {
  Graph graph(lines.nodes);
  for (const LineEdge& edge : lines.edges) {
    const std::vector<Vec3>& rest = lines.rods[edge.rod].rest;
    connect(graph, edge.global, edge.global + 1, (rest[edge.node + 1] - rest[edge.node]).norm());
  }
  for (std::size_t i = 0; i < joints.size(); ++i)
    connect(graph, node_of(lines, joints[i], 0, i), node_of(lines, joints[i], 1, i), 0.0);
  return graph;
}

/// The shortest ways from a node to those within the reach [Dijkstra 1959].
std::map<std::uint32_t, double> ways_from(const Graph& graph, std::uint32_t start, double reach) {
  using Stop = std::pair<double, std::uint32_t>;
  std::priority_queue<Stop, std::vector<Stop>, std::greater<>> open;
  std::map<std::uint32_t, double> reached;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [way, node] = open.top();
    open.pop();
    if (!reached.emplace(node, way).second) continue;
    for (const Link& link : graph[node])
      if (way + link.length <= reach) open.emplace(way + link.length, link.to);
  }
  return reached;
}

/// The ways along rods and through joints from the ends of an edge to those of another; infinite where longer
/// than asked for.
struct Ways {
  double way[2][2] = {{kInfinite, kInfinite}, {kInfinite, kInfinite}};
};

/// To the edges after e that are within the reach.
std::map<std::uint32_t, Ways> ways_of(const RodLines& lines, const Graph& graph,
                                      const std::vector<std::vector<std::uint32_t>>& edges_at,
                                      std::uint32_t e, double reach) {
  std::map<std::uint32_t, Ways> found;
  for (const std::uint32_t end : {0u, 1u})
    for (const auto& [node, way] : ways_from(graph, lines.edges[e].global + end, reach))
      for (const std::uint32_t f : edges_at[node])
        if (f > e) found[f].way[end][node - lines.edges[f].global] = way;
  return found;
}

/// A point of an edge as it rests.
struct Resting {
  Vec3 x;
  double from[2];  ///< the edge's ends, along it
};

Resting resting(const RodLines& lines, std::size_t point) {
  const LinePoint& at = lines.points[point];
  const LineEdge& edge = lines.edges[at.edge];
  const Vec3 &a = lines.rods[edge.rod].rest[edge.node], &b = lines.rods[edge.rod].rest[edge.node + 1];
  const double length = (b - a).norm();
  return {between(a, b, at.fraction), {at.fraction * length, (1.0 - at.fraction) * length}};
}

bool are_excluded(const Resting& x, const Resting& y, const Ways& ways, double meets) {
  double way = kInfinite;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) way = std::min(way, x.from[i] + ways.way[i][j] + y.from[j]);
  return way < kAlong * meets || (way <= kNearAlong * meets && (x.x - y.x).norm() < kRestsNear * meets);
}

}  // namespace

Exclusions::Exclusions(const RodLines& lines, const std::vector<RodJoint>& joints, double most,
                       const Meets& meets) {
  const Graph graph = graph_of(lines, joints);
  std::vector<std::vector<std::uint32_t>> edges_at(lines.nodes);
  for (std::uint32_t e = 0; e < lines.edges.size(); ++e)
    for (const std::uint32_t end : {0u, 1u}) edges_at[lines.edges[e].global + end].push_back(e);
  for (std::uint32_t e = 0; e < lines.edges.size(); ++e)
    for (const auto& [f, ways] : ways_of(lines, graph, edges_at, e, kNearAlong * most)) {
      const LineEdge &first = lines.edges[e], &second = lines.edges[f];
      const std::size_t begin = excluded_.size();
      for (std::size_t i = first.first; i < first.end; ++i)
        for (std::size_t j = second.first; j < second.end; ++j)
          excluded_.push_back(are_excluded(resting(lines, i), resting(lines, j), ways, meets(e, f)));
      const auto from = excluded_.begin() + static_cast<std::ptrdiff_t>(begin);
      const bool whole = std::find(from, excluded_.end(), 0) == excluded_.end();
      const bool none = std::find(from, excluded_.end(), 1) == excluded_.end();
      if (whole || none) excluded_.resize(begin);
      if (!none) edges_.push_back({key_of(e, f), whole, begin});
    }
}

const Excluded* Exclusions::between(std::uint32_t first, std::uint32_t second) const {
  return find_key(edges_, key_of(first, second));
}

}  // namespace tendril::contact
