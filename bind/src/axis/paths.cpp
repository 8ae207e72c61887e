#include "paths.h"

#include <algorithm>

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

}  // namespace tendril::axis
