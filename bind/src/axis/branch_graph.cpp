#include "branch_graph.h"

#include <algorithm>
#include <limits>

namespace tendril::axis {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr double kWavers = 0.5;      ///< of the first point's clearance
constexpr double kBlunt = 0.4;       ///< a limb narrows less steeply, a way into a corner more
constexpr double kFork = 1.3;        ///< prongs whose reaches differ by less are alike
constexpr double kAlike = 1.15;      ///< limbs whose lengths differ by less are alike
constexpr double kLeastPart = 0.75;  ///< of the reach that is asked for: what has less is pruned

Line reversed(Line line) {
  std::reverse(line.begin(), line.end());
  return line;
}

/// One line after another that starts where it ends.
Line joined(Line first, const Line& second) {
  first.insert(first.end(), second.begin() + 1, second.end());
  return first;
}

/// The branch as seen from one of its vertices.
Line from_vertex(const Branch& branch, std::uint32_t vertex) {
  return branch.from == vertex ? branch.line : reversed(branch.line);
}

/// Walks from a vertex over nodes with two neighbours to the next vertex.
class Walker {
 public:
  explicit Walker(const Skeleton& skeleton) : skeleton_(skeleton), at_(skeleton.points.size()) {
    for (std::uint32_t e = 0; e < skeleton.edges.size(); ++e)
      for (const std::uint32_t node : skeleton.edges[e]) at_[node].push_back(e);
    walked_.resize(skeleton.edges.size(), false);
    vertex_.resize(skeleton.points.size(), kNone);
  }

  BranchGraph run() {
    for (std::uint32_t node = 0; node < at_.size(); ++node)
      if (at_[node].size() != 2) add_vertex(node);
    if (graph_.vertices.empty() && !at_.empty()) add_vertex(0);
    for (std::uint32_t node = 0; node < at_.size(); ++node)
      if (vertex_[node] != kNone)
        for (const std::uint32_t edge : at_[node])
          if (!walked_[edge]) walk(node, edge);
    return std::move(graph_);
  }

 private:
  void add_vertex(std::uint32_t node) {
    vertex_[node] = static_cast<std::uint32_t>(graph_.vertices.size());
    graph_.vertices.push_back(skeleton_.points[node]);
  }
  void walk(std::uint32_t start, std::uint32_t edge) {
    Branch branch{vertex_[start], kNone, {skeleton_.points[start]}};
    for (std::uint32_t node = start; branch.to == kNone;) {
      walked_[edge] = true;
      const auto& ends = skeleton_.edges[edge];
      node = ends[0] == node ? ends[1] : ends[0];
      branch.line.push_back(skeleton_.points[node]);
      branch.to = vertex_[node];
      if (branch.to == kNone) edge = at_[node][0] == edge ? at_[node][1] : at_[node][0];
    }
    graph_.branches.push_back(std::move(branch));
  }

  const Skeleton& skeleton_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::vector<bool> walked_;
  std::vector<std::uint32_t> vertex_;
  BranchGraph graph_;
};

std::vector<std::size_t> branches_at(const BranchGraph& graph, std::uint32_t vertex) {
  std::vector<std::size_t> out;
  for (std::size_t b = 0; b < graph.branches.size(); ++b)
    if (graph.branches[b].from == vertex || graph.branches[b].to == vertex) out.push_back(b);
  return out;
}

/// Where two different branches meet and no other, they become one.
void smooth_over(BranchGraph& graph, std::uint32_t vertex) {
  const std::vector<std::size_t> at = branches_at(graph, vertex);
  if (graph.degrees()[vertex] != 2 || at.size() != 2) return;
  const Branch& a = graph.branches[at[0]];
  const Branch& b = graph.branches[at[1]];
  Branch one{a.from == vertex ? a.to : a.from, b.from == vertex ? b.to : b.from,
             joined(reversed(from_vertex(a, vertex)), from_vertex(b, vertex))};
  graph.branches[at[0]] = std::move(one);
  graph.branches.erase(graph.branches.begin() + static_cast<std::ptrdiff_t>(at[1]));
}

struct Leaf {
  std::size_t branch;
  std::uint32_t root;
  Twig twig;
};

/// Branches with one end free and the other a junction.
std::vector<Leaf> leaves_of(const BranchGraph& graph, const Clearance& clearance) {
  const std::vector<int> degree = graph.degrees();
  std::vector<Leaf> out;
  for (std::size_t b = 0; b < graph.branches.size(); ++b) {
    const Branch& branch = graph.branches[b];
    const bool free_from = degree[branch.from] == 1, free_to = degree[branch.to] == 1;
    const std::uint32_t root = free_from ? branch.to : branch.from;
    if (free_from == free_to || degree[root] < 3) continue;
    const Line line = from_vertex(branch, root);
    double farthest = 0.0;
    for (const Vec3& p : line) farthest = std::max(farthest, (p - line.front()).norm() + clearance(p));
    const double reach = farthest / clearance(line.front());
    out.push_back({b, root, {line.front(), line.back(), length_of(line), reach}});
  }
  return out;
}

/// Whether a limb beside a leaf is as long as it is and is kept, as the other of two legs that are nearly
/// mirror images: they are not told apart by a hair.
bool alike_to_kept(const Twig& least, const std::vector<Leaf>& leaves, double least_reach,
                   const Clearance& clearance) {
  if (least.reach < kLeastPart * least_reach) return false;
  const double width = clearance(least.root), length = least.reach * width;
  return std::any_of(leaves.begin(), leaves.end(), [&](const Leaf& leaf) {
    const double other_width = clearance(leaf.twig.root), other = leaf.twig.reach * other_width;
    return leaf.twig.reach >= least_reach && std::max(length, other) <= kAlike * std::min(length, other) &&
           (leaf.twig.root - least.root).norm() <= 2.0 * std::max(width, other_width);
  });
}

/// The leaf of least reach of those to be pruned; and, where a fork at the end of a limb is about to be cut,
/// its other prong when that is hardly longer: neither goes on along the limb.
std::vector<Leaf> least_leaves(const BranchGraph& graph, double least_reach, const Clearance& clearance) {
  const std::vector<Leaf> leaves = leaves_of(graph, clearance);
  std::vector<Leaf> spurious;
  for (const Leaf& leaf : leaves)
    if (leaf.twig.reach < least_reach && !alike_to_kept(leaf.twig, leaves, least_reach, clearance))
      spurious.push_back(leaf);
  if (spurious.empty()) return {};
  const auto shorter = [](const Leaf& a, const Leaf& b) { return a.twig.reach < b.twig.reach; };
  const Leaf least = *std::min_element(spurious.begin(), spurious.end(), shorter);
  std::size_t beside = 0;
  for (const Leaf& leaf : leaves) beside += leaf.root == least.root && leaf.branch != least.branch;
  if (graph.degrees()[least.root] != 3 || beside != 1) return {least};
  for (const Leaf& leaf : spurious)
    if (leaf.root == least.root && leaf.branch != least.branch && leaf.twig.reach <= kFork * least.twig.reach)
      return {least, leaf};
  return {least};
}

/// The two halves of a line about the point `length` along it, which both hold.
std::array<Line, 2> cut_at(const Line& line, double length) {
  std::size_t k = 1;
  for (double step = 0.0; k + 1 < line.size(); ++k, length -= step) {
    step = (line[k] - line[k - 1]).norm();
    if (length <= step) break;
  }
  const double step = (line[k] - line[k - 1]).norm();
  const double part = step > 0.0 ? std::clamp(length / step, 0.0, 1.0) : 0.0;
  const Vec3 cut = line[k - 1] + part * (line[k] - line[k - 1]);
  Line first(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(k));
  Line second(line.begin() + static_cast<std::ptrdiff_t>(k), line.end());
  if (first.back() != cut || first.size() == 1) first.push_back(cut);
  if (second.front() != cut || second.size() == 1) second.insert(second.begin(), cut);
  return {first, second};
}

/// How many of the first points of a line lie where it runs into a corner, at most to its middle: so far its
/// clearance grows faster than kBlunt with the length. The first few points may waver.
std::size_t blunt(const Line& line, const Clearance& clearance) {
  const double half = 0.5 * length_of(line), first = clearance(line.front());
  double length = 0.0;
  std::size_t found = 0;
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    length += (line[k] - line[k - 1]).norm();
    if (length > half) break;
    if (clearance(line[k]) - first >= kBlunt * length)
      found = k;
    else if (length > kWavers * first)
      break;
  }
  return found;
}

struct Reached {
  std::vector<double> distance;      ///< of the vertices from the start, along branches
  std::vector<std::size_t> through;  ///< branch that each was reached by, or none
};

/// Shortest paths from a vertex to all others. A vertex a round: there are few.
Reached shortest_paths(const BranchGraph& graph, std::uint32_t start) {
  const double far = std::numeric_limits<double>::infinity();
  Reached out{std::vector<double>(graph.vertices.size(), far),
              std::vector<std::size_t>(graph.vertices.size(), graph.branches.size())};
  std::vector<bool> done(graph.vertices.size(), false);
  out.distance[start] = 0.0;
  for (;;) {
    std::uint32_t next = kNone;
    for (std::uint32_t p = 0; p < graph.vertices.size(); ++p)
      if (!done[p] && out.distance[p] < far && (next == kNone || out.distance[p] < out.distance[next]))
        next = p;
    if (next == kNone) return out;
    done[next] = true;
    for (const std::size_t b : branches_at(graph, next)) {
      const Branch& branch = graph.branches[b];
      const std::uint32_t other = branch.from == next ? branch.to : branch.from;
      const double distance = out.distance[next] + length_of(branch.line);
      if (distance < out.distance[other]) {
        out.distance[other] = distance;
        out.through[other] = b;
      }
    }
  }
}

}  // namespace

double length_of(const Line& line) {
  double sum = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).norm();
  return sum;
}

std::vector<int> BranchGraph::degrees() const {
  std::vector<int> out(vertices.size(), 0);
  for (const Branch& branch : branches) {
    ++out[branch.from];
    ++out[branch.to];
  }
  return out;
}

std::size_t BranchGraph::loops() const {
  const std::vector<int> degree = degrees();
  const auto used = degree.size() - static_cast<std::size_t>(std::count(degree.begin(), degree.end(), 0));
  return branches.empty() ? 0 : branches.size() + 1 - used;
}

BranchGraph branches_of(const Skeleton& skeleton) {
  return Walker(skeleton).run();
}

std::vector<Twig> prune(BranchGraph& graph, double least_reach, const Clearance& clearance) {
  std::vector<Twig> out;
  for (;;) {
    std::vector<Leaf> cut = least_leaves(graph, least_reach, clearance);
    if (cut.empty()) return out;
    for (const Leaf& leaf : cut) out.push_back(leaf.twig);
    std::sort(cut.begin(), cut.end(), [](const Leaf& a, const Leaf& b) { return a.branch > b.branch; });
    for (const Leaf& leaf : cut)
      graph.branches.erase(graph.branches.begin() + static_cast<std::ptrdiff_t>(leaf.branch));
    smooth_over(graph, cut.front().root);
  }
}

void merge_junctions(BranchGraph& graph, const Clearance& clearance) {
  for (std::size_t b = 0; b < graph.branches.size();) {
    const Branch bridge = graph.branches[b];
    const std::vector<int> degree = graph.degrees();
    const double from = clearance(graph.vertices[bridge.from]), to = clearance(graph.vertices[bridge.to]);
    if (bridge.from == bridge.to || degree[bridge.from] < 3 || degree[bridge.to] < 3 ||
        length_of(bridge.line) > 0.5 * std::max(from, to)) {
      ++b;
      continue;
    }
    const std::uint32_t kept = from >= to ? bridge.from : bridge.to;
    const std::uint32_t gone = kept == bridge.from ? bridge.to : bridge.from;
    graph.branches.erase(graph.branches.begin() + static_cast<std::ptrdiff_t>(b));
    for (Branch& other : graph.branches) {
      if (other.from == gone) other = {kept, other.to, joined(from_vertex(bridge, kept), other.line)};
      if (other.to == gone) other = {other.from, kept, joined(other.line, from_vertex(bridge, gone))};
    }
    b = 0;
  }
}

void trim_ends(BranchGraph& graph, const Clearance& clearance) {
  const std::vector<int> degree = graph.degrees();
  for (Branch& branch : graph.branches)
    for (const std::uint32_t end : {branch.from, branch.to}) {
      if (degree[end] != 1) continue;
      Line line = from_vertex(branch, end);
      const std::size_t cut = blunt(line, clearance);
      line.erase(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(cut));
      graph.vertices[end] = line.front();
      branch.line = branch.from == end ? std::move(line) : reversed(std::move(line));
    }
}

std::vector<Vec3> cut_loops(BranchGraph& graph, const Clearance& clearance) {
  std::vector<Vec3> cuts;
  const std::vector<int> degree = graph.degrees();
  std::uint32_t start = kNone;
  double widest = -1.0;
  for (std::uint32_t p = 0; p < graph.vertices.size(); ++p) {
    if (degree[p] == 0 || !(clearance(graph.vertices[p]) > widest)) continue;
    start = p;
    widest = clearance(graph.vertices[p]);
  }
  if (start == kNone) return cuts;
  const Reached reached = shortest_paths(graph, start);
  const std::size_t count = graph.branches.size();
  for (std::size_t b = 0; b < count; ++b) {
    const Branch branch = graph.branches[b];
    if (reached.through[branch.from] == b || reached.through[branch.to] == b) continue;
    const double along =
        0.5 * (length_of(branch.line) + reached.distance[branch.to] - reached.distance[branch.from]);
    auto [first, second] = cut_at(branch.line, along);
    cuts.push_back(first.back());
    const auto vertex = static_cast<std::uint32_t>(graph.vertices.size());
    graph.vertices.insert(graph.vertices.end(), 2, cuts.back());
    graph.branches[b] = {branch.from, vertex, std::move(first)};
    graph.branches.push_back({vertex + 1, branch.to, std::move(second)});
  }
  for (std::uint32_t p = 0; p < graph.vertices.size(); ++p) smooth_over(graph, p);
  return cuts;
}

}  // namespace tendril::axis
