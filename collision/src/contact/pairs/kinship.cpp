#include "kinship.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <map>
#include <queue>
#include <string>

namespace tendril::contact {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::uint64_t key_of(std::uint32_t first, std::uint32_t second) {
  return (std::uint64_t{first} << 32) | second;
}

struct Road {
  std::uint32_t to;
  double length;
};

/// Nodes of all rods in contact, and the roads between them.
using Roads = std::vector<std::vector<Road>>;

void connect(Roads& roads, std::uint32_t a, std::uint32_t b, double length) {
  roads[a].push_back({b, length});
  roads[b].push_back({a, length});
}

/// The first node of a rod of the scene among those of the lines; empty where the rod is not among them.
std::optional<std::uint32_t> first_of(const RodLines& lines, std::size_t rod) {
  std::uint32_t first = 0;
  for (const ContactRod& one : lines.rods) {
    if (one.rod == rod) return first;
    first += static_cast<std::uint32_t>(one.rest.size());
  }
  return {};
}

std::uint32_t node_of(const RodLines& lines, const RodJoint& joint, std::size_t side, std::size_t i) {
  const std::string place = "contact.joints[" + std::to_string(i) + "]";
  const auto first = first_of(lines, joint.rod[side]);
  if (!first) throw InvalidInput(place + ".rod", std::to_string(joint.rod[side]), "a rod in contact");
  const auto of = std::find_if(lines.rods.begin(), lines.rods.end(),
                               [&](const ContactRod& rod) { return rod.rod == joint.rod[side]; });
  if (joint.node[side] >= of->rest.size())
    throw InvalidInput(place + ".node", std::to_string(joint.node[side]),
                       "below the rod's number of masses, " + std::to_string(of->rest.size()));
  return *first + static_cast<std::uint32_t>(joint.node[side]);
}

Roads roads_of(const RodLines& lines, const std::vector<RodJoint>& joints) {
  Roads roads(lines.nodes);
  for (const LineEdge& edge : lines.edges) {
    const std::vector<Vec3>& rest = lines.rods[edge.rod].rest;
    connect(roads, edge.global, edge.global + 1, (rest[edge.node + 1] - rest[edge.node]).norm());
  }
  for (std::size_t i = 0; i < joints.size(); ++i)
    connect(roads, node_of(lines, joints[i], 0, i), node_of(lines, joints[i], 1, i), 0.0);
  return roads;
}

/// The shortest ways from a node to those within the reach [Dijkstra 1959].
std::map<std::uint32_t, double> ways_from(const Roads& roads, std::uint32_t start, double reach) {
  using Stop = std::pair<double, std::uint32_t>;
  std::priority_queue<Stop, std::vector<Stop>, std::greater<>> open;
  std::map<std::uint32_t, double> reached;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [way, node] = open.top();
    open.pop();
    if (!reached.emplace(node, way).second) continue;
    for (const Road& road : roads[node])
      if (way + road.length <= reach) open.emplace(way + road.length, road.to);
  }
  return reached;
}

}  // namespace

Kinship::Kinship(const RodLines& lines, const std::vector<RodJoint>& joints, double reach) {
  const Roads roads = roads_of(lines, joints);
  std::vector<std::vector<std::uint32_t>> edges_at(lines.nodes);
  for (std::uint32_t e = 0; e < lines.edges.size(); ++e)
    for (const std::uint32_t end : {0u, 1u}) edges_at[lines.edges[e].global + end].push_back(e);
  for (std::uint32_t e = 0; e < lines.edges.size(); ++e) {
    std::map<std::uint32_t, Ways> found;
    for (const std::uint32_t end : {0u, 1u})
      for (const auto& [node, way] : ways_from(roads, lines.edges[e].global + end, reach))
        for (const std::uint32_t f : edges_at[node]) {
          if (f <= e) continue;
          const Ways none{key_of(e, f), {{kInfinite, kInfinite}, {kInfinite, kInfinite}}};
          found.emplace(f, none).first->second.way[end][node - lines.edges[f].global] = way;
        }
    for (const auto& [f, ways] : found) ways_.push_back(ways);
  }
}

const Ways* Kinship::between(std::uint32_t first, std::uint32_t second) const {
  const std::uint64_t key = key_of(first, second);
  const auto at = std::lower_bound(ways_.begin(), ways_.end(), key,
                                   [](const Ways& w, std::uint64_t k) { return w.key < k; });
  return at != ways_.end() && at->key == key ? &*at : nullptr;
}

}  // namespace tendril::contact
