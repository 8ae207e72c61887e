#include "paths.h"

#include <algorithm>
#include <cmath>

namespace tendril::axis {
namespace {

/// Ways into the tree from a place, by branches not yet taken.
class Ways {
 public:
  explicit Ways(const BranchGraph& tree)
      : tree_(tree), at_(tree.places.size()), taken_(tree.branches.size(), false) {
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
      at_[tree.branches[b].from].push_back(b);
      at_[tree.branches[b].to].push_back(b);
      length_.push_back(length_of(tree.branches[b].line));
    }
  }

  std::vector<std::size_t> open(std::uint32_t place) const {
    std::vector<std::size_t> out;
    for (const std::size_t b : at_[place])
      if (!taken_[b]) out.push_back(b);
    return out;
  }

  std::uint32_t other(std::size_t branch, std::uint32_t place) const {
    const Branch& b = tree_.branches[branch];
    return b.from == place ? b.to : b.from;
  }

  /// The longest way on, last branch first, that does not go back by `from`.
  struct Way {
    double length = 0.0;
    std::vector<std::size_t> branches{};
  };
  Way longest(std::uint32_t place, std::size_t from) const {
    Way best;
    for (const std::size_t b : open(place)) {
      if (b == from) continue;
      Way way = along(place, b);
      if (way.length > best.length) best = std::move(way);
    }
    return best;
  }
  Way along(std::uint32_t place, std::size_t branch) const {
    Way way = longest(other(branch, place), branch);
    way.length += length_[branch];
    way.branches.push_back(branch);
    return way;
  }

  Path take(std::uint32_t place, const Way& way, std::optional<std::size_t> parent) {
    Path path{{tree_.places[place]}, {place}, {0.0}, parent};
    for (auto b = way.branches.rbegin(); b != way.branches.rend(); ++b) {
      taken_[*b] = true;
      Line line = tree_.branches[*b].line;
      if (tree_.branches[*b].from != place) std::reverse(line.begin(), line.end());
      path.line.insert(path.line.end(), line.begin() + 1, line.end());
      place = other(*b, place);
      path.places.push_back(place);
      path.along.push_back(path.along.back() + length_[*b]);
    }
    return path;
  }

  std::uint32_t end_of(std::uint32_t place, const Way& way) const {
    for (auto b = way.branches.rbegin(); b != way.branches.rend(); ++b) place = other(*b, place);
    return place;
  }

 private:
  const BranchGraph& tree_;
  std::vector<std::vector<std::size_t>> at_;
  std::vector<bool> taken_;
  std::vector<double> length_;
};

}  // namespace

std::vector<Path> paths_of(const BranchGraph& tree) {
  std::vector<Path> out;
  if (tree.branches.empty()) return out;
  constexpr std::size_t none = ~std::size_t{0};
  Ways ways(tree);
  const std::uint32_t any = tree.branches.front().from;
  const std::uint32_t one = ways.end_of(any, ways.longest(any, none));
  const std::uint32_t two = ways.end_of(one, ways.longest(one, none));
  const std::uint32_t start = std::min(one, two);
  out.push_back(ways.take(start, ways.longest(start, none), std::nullopt));
  for (std::size_t p = 0; p < out.size(); ++p) {
    const std::vector<std::uint32_t> places = out[p].places;
    for (const std::uint32_t place : places)
      for (const std::size_t b : ways.open(place)) out.push_back(ways.take(place, ways.along(place, b), p));
  }
  return out;
}

Spread spread_nodes(const Path& path, double spacing) {
  const double length = path.along.back();
  std::vector<double> stops{0.0};
  std::vector<std::size_t> stop_of_place;
  for (const double along : path.along) {
    const bool apart = along - stops.back() >= 0.5 * spacing && length - along >= 0.5 * spacing;
    if (apart) stops.push_back(along);
    stop_of_place.push_back(stops.size() - (along == length || length - along < 0.5 * spacing ? 0 : 1));
  }
  stops.push_back(length);
  stop_of_place.front() = 0;
  const std::size_t pieces = stops.size() - 1;
  const double least = std::ceil(3.0 / static_cast<double>(pieces));
  Spread out{{0.0}, {}};
  std::vector<std::size_t> node_of_stop{0};
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const double step = stops[k] - stops[k - 1];
    const double edges = std::clamp(std::round(step / spacing), least, 10000.0);
    for (double e = 1.0; e <= edges; ++e)
      out.parameters.push_back((stops[k - 1] + step * e / edges) / length);
    node_of_stop.push_back(out.parameters.size() - 1);
  }
  for (const std::size_t stop : stop_of_place) out.node_of_place.push_back(node_of_stop[stop]);
  return out;
}

}  // namespace tendril::axis
