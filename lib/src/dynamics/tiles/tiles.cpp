#include "tiles.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace tendril {
namespace {

// Nodes of a tile: some 1.5 kB each go through a step.
constexpr std::size_t kOwn = 1024;
// Scenes of fewer nodes have no tiles: the cache holds them.
constexpr std::size_t kWorthIt = 2 * kOwn;
// The force on a node depends on the three before it and behind (its edges' twist turns the frames at their
// other ends, which halve the angles to the edges beyond), by places and velocities, and a step has six
// stages. Without twist it depends on two, by places alone: these are moved by velocities of a stage before.
constexpr std::size_t kFelt = 3 * 6, kFeltWithoutTwist = 2 * 3;

bool passes_through_springs_alone(const Model& model) {
  return !model.loaded && model.attachments.empty() && model.bodies.empty() && model.sliders.empty() &&
         model.swivels.empty() &&
         std::none_of(model.segments.begin(), model.segments.end(),
                      [](const Model::Segment& segment) { return segment.viscous; });
}

/// Where the tile that begins at a node ends: between two rods, where such a place is near.
std::size_t end_of_tile(const Model& model, std::size_t first) {
  const std::size_t farthest = std::min(first + kOwn, model.nodes);
  if (farthest == model.nodes) return farthest;
  for (std::size_t i = farthest; i > first + kOwn / 2; --i)
    if (model.begins[i] != 0) return i;
  return farthest;
}

/// As far as own nodes feel, but not beyond their rod.
std::size_t felt(const Model& model, std::size_t node) {
  return model.has_twist(node) ? kFelt : kFeltWithoutTwist;
}
std::size_t begin_of_felt(const Model& model, std::size_t first) {
  const std::size_t most = felt(model, first);
  for (std::size_t k = 0; k < most && model.begins[first] == 0; ++k) --first;
  return first;
}
std::size_t end_of_felt(const Model& model, std::size_t end) {
  const std::size_t most = felt(model, end - 1);
  for (std::size_t k = 0; k < most && model.ends[end - 1] == 0; ++k) ++end;
  return end;
}

/// Where the numbers of the nodes [first, end) stand in the scene's y and in the part's.
std::vector<NumbersAt> numbers_of(const Model& whole, const Model& part, std::size_t begin, std::size_t first,
                                  std::size_t end) {
  const auto at = static_cast<Eigen::Index>(first), in_part = static_cast<Eigen::Index>(first - begin),
             count = static_cast<Eigen::Index>(end - first);
  std::vector<NumbersAt> result{{3 * at, 3 * in_part, 3 * count},
                                {whole.v_begin() + 3 * at, part.v_begin() + 3 * in_part, 3 * count}};
  // The places of nodes among the twist states rise with the nodes.
  while (first < end && !whole.has_twist(first)) ++first;
  while (first < end && !whole.has_twist(end - 1)) --end;
  if (first == end) return result;
  const Eigen::Index from = whole.twist_index[first], to = part.twist_index[first - begin],
                     turning = whole.twist_index[end - 1] - from + 1;
  result.push_back({whole.theta_begin() + from, part.theta_begin() + to, turning});
  result.push_back({whole.spin_begin() + from, part.spin_begin() + to, turning});
  return result;
}

std::vector<NumbersAt> turned_round(std::vector<NumbersAt> numbers) {
  for (NumbersAt& part : numbers) std::swap(part.from, part.to);
  return numbers;
}

template <class T>
void take_part(const std::vector<T>& from, std::size_t begin, std::size_t nodes, std::vector<T>& to) {
  const auto at = from.begin() + static_cast<std::ptrdiff_t>(begin);
  to.assign(at, at + static_cast<std::ptrdiff_t>(nodes));
}

}  // namespace

Tiles::Tiles(const Model& model) {
  const std::vector<AnchoredNode> anchored = anchored_nodes(model);
  for (std::size_t first = 0; first < model.nodes;) {
    const std::size_t end = end_of_tile(model, first);
    const std::size_t begin = begin_of_felt(model, first);
    const std::shared_ptr<const Model> part =
        part_of(model, anchored, begin, end_of_felt(model, end), first, end);
    tiles_.push_back({first,
                      end,
                      begin,
                      add(part),
                      has_anchors(*part) ? std::vector<double>{} : constants_of(*part),
                      numbers_of(model, *part, begin, begin, begin + part->nodes),
                      turned_round(numbers_of(model, *part, begin, first, end)),
                      numbers_of(model, *part, begin, begin, first),
                      {},
                      0});
    first = end;
  }
  join(model);
  number_workspaces();
}

std::size_t Tiles::add(const std::shared_ptr<const Model>& part) {
  const auto alike = [&](const std::shared_ptr<const Model>& other) {
    return !has_anchors(*other) && alike_but_for_constants(*part, *other);
  };
  const auto place = has_anchors(*part) ? parts_.end() : std::find_if(parts_.begin(), parts_.end(), alike);
  const auto at = static_cast<std::size_t>(place - parts_.begin());
  if (at == parts_.size()) parts_.push_back(part);
  return at;
}

/// A tile feels no farther than the next one's own nodes.
void Tiles::join(const Model& model) {
  for (std::size_t k = 0; k + 1 < tiles_.size(); ++k) {
    Tile& tile = tiles_[k];
    const Tile& next = tiles_[k + 1];
    const std::size_t end = tile.begin + shape_of(tile).nodes;
    assert(end <= next.end);
    const std::vector<NumbersAt> here = numbers_of(model, shape_of(tile), tile.begin, tile.end, end);
    const std::vector<NumbersAt> there = numbers_of(model, shape_of(next), next.begin, tile.end, end);
    for (std::size_t i = 0; i < here.size(); ++i)
      tile.after.push_back({there[i].to, here[i].to, here[i].count});
  }
}

/// Numbers that one tile leaves and another does not write may not matter to that one: so it is where both
/// have as many nodes and these are all of a kind.
void Tiles::number_workspaces() {
  const auto uniform = [](const Model& part) {
    return part.twist_nodes == 0 || part.twist_nodes == part.nodes;
  };
  std::size_t count = 0;
  for (std::size_t k = 0; k < tiles_.size(); ++k) {
    const Model& part = shape_of(tiles_[k]);
    const auto alike = [&](const Tile& other) {
      const Model& that = shape_of(other);
      return uniform(that) && that.nodes == part.nodes && that.twist_nodes == part.twist_nodes;
    };
    const auto here = tiles_.begin() + static_cast<std::ptrdiff_t>(k);
    const auto before = uniform(part) ? std::find_if(tiles_.begin(), here, alike) : here;
    tiles_[k].workspace = before == here ? count++ : before->workspace;
  }
}

std::shared_ptr<const Tiles> tiles_for(const Model& model) {
  if (model.nodes < kWorthIt || !passes_through_springs_alone(model)) return nullptr;
  return std::make_shared<const Tiles>(model);
}

TileScratch::TileScratch(const Tiles& tiles) : parts_(tiles.parts()), shared_(parts_.size()) {
  for (std::size_t k = 0; k < parts_.size(); ++k)
    if (!has_anchors(*parts_[k])) parts_[k] = shared_[k] = std::make_shared<Model>(*parts_[k]);
  for (const Tiles::Tile& tile : tiles.all()) {
    if (tile.workspace == workspaces_.size())
      workspaces_.push_back(std::make_unique<System::Workspace>(model(tile)));
    std::vector<AnchorPose>& pose = workspace(tile).kinematics.pose;
    pose.resize(std::max(pose.size(), model(tile).anchors.size()));
  }
}

TileScratch& TileScratch::of(const Model& whole, System::Workspace& work) {
  if (!work.tiles) work.tiles.reset(new TileScratch(*whole.tiles));
  return *work.tiles;
}

const State& TileScratch::take(const Tiles::Tile& tile, const State& from) {
  if (const std::shared_ptr<Model>& shared = shared_[tile.part]) put_constants(tile.constants, *shared);
  const Model& part = model(tile);
  state_.time = from.time;
  state_.y.resize(part.size());
  for (const NumbersAt& all : tile.all) copy(from.y, all, state_.y);
  state_.y[part.work_index()] = 0.0;
  return take_reference(tile, from);
}

const State& TileScratch::take_reference(const Tiles::Tile& tile, const State& from) {
  const Model& part = model(tile);
  if (part.twist_nodes == 0 && part.anchors.empty()) return state_;
  take_part(from.tangent, tile.begin, part.nodes, state_.tangent);
  take_part(from.director, tile.begin, part.nodes, state_.director);
  take_part(from.twist, tile.begin, part.nodes, state_.twist);
  return state_;
}

}  // namespace tendril
