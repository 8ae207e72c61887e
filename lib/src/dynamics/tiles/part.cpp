#include <algorithm>
#include <span>
#include <utility>

#include "tiles.h"

namespace tendril {
namespace {

constexpr std::size_t kPartRank = 60;  // of the first column, behind those of a workspace

// A part is a Model, so that the loops over nodes know nothing of tiles. Only what the right-hand side of
// a scene with tiles reads is filled: neither rest shapes nor what joints, loads and bodies need, which
// such a scene has not.

/// What makes a part: the nodes [first, end), of which [own_first, own_end) count.
struct Cut {
  const Model& whole;
  std::size_t first, end, own_first, own_end;
  Model& part;

  bool owns(std::size_t node) const { return node >= own_first && node < own_end; }
};

template <class T>
void take(const Cut& cut, std::vector<T> Model::*member, std::size_t each = 1) {
  const auto from = (cut.whole.*member).begin();
  (cut.part.*member)
      .assign(from + static_cast<std::ptrdiff_t>(each * cut.first),
              from + static_cast<std::ptrdiff_t>(each * cut.end));
}

Column column_of(const Cut& cut, const Column& from, std::size_t& rank) {
  Column to(cut.part.nodes, rank++);
  std::copy(from.data() + cut.first, from.data() + cut.end, to.data());
  return to;
}

/// Ranges of nodes stand in the order of the nodes, as do lists of them: those of a part are found at
/// once.
template <class Range>
std::span<const Range> meeting(const Cut& cut, const std::vector<Range>& ranges, const auto& end_of) {
  const auto first = std::partition_point(ranges.begin(), ranges.end(),
                                          [&](const Range& range) { return end_of(range) <= cut.first; });
  const auto end =
      std::partition_point(first, ranges.end(), [&](const Range& range) { return range.first < cut.end; });
  return {first, end};
}

void take_rods(const Cut& cut) {
  for (const NodeRange& rod :
       meeting(cut, cut.whole.rods, [](const NodeRange& range) { return range.first + range.count; })) {
    const std::size_t a = std::max(rod.first, cut.first), b = std::min(rod.first + rod.count, cut.end);
    cut.part.rods.push_back({a - cut.first, b - a});
  }
  for (Model::Segment segment :
       meeting(cut, cut.whole.segments, [](const Model::Segment& range) { return range.end; })) {
    segment.first = std::max(segment.first, cut.first) - cut.first;
    segment.end = std::min(segment.end, cut.end) - cut.first;
    cut.part.segments.push_back(segment);
  }
  for (std::size_t i = cut.first; i < cut.end; ++i)
    cut.part.twist_index.push_back(cut.whole.has_twist(i) ? static_cast<int>(cut.part.twist_nodes++) : -1);
}

/// Poses that do not move stand in motions, too, so that a part needs no rest shape.
void take_anchor(const Cut& cut, Anchor anchor, std::size_t node) {
  const Model& whole = cut.whole;
  if (!anchor.motion)
    anchor.motion = [pose = AnchorPose{whole.rest_p[node], whole.rest_frame[node], Vec3::Zero(),
                                       Vec3::Zero()}](double) { return pose; };
  const auto rod = std::partition_point(
      cut.part.rods.begin(), cut.part.rods.end(),
      [&](const NodeRange& range) { return range.first + range.count <= node - cut.first; });
  anchor.rod = static_cast<std::size_t>(rod - cut.part.rods.begin());
  anchor.node = node - cut.first - rod->first;
  cut.part.anchors.push_back(std::move(anchor));
}

void take_anchors(const Cut& cut, const std::vector<AnchoredNode>& anchored) {
  const auto at = std::partition_point(anchored.begin(), anchored.end(),
                                       [&](const AnchoredNode& anchor) { return anchor.node < cut.first; });
  for (auto anchor = at; anchor != anchored.end() && anchor->node < cut.end; ++anchor)
    take_anchor(cut, cut.whole.anchors[anchor->anchor], anchor->node);
}

void take_nodes(const Cut& cut, const std::vector<std::size_t>& from, std::size_t first, std::size_t end,
                std::vector<std::size_t>& to) {
  for (auto node = std::lower_bound(from.begin(), from.end(), first); node != from.end() && *node < end;
       ++node)
    to.push_back(*node - cut.first);
}

/// A held node holds in every part that it is in, or the nodes beside it would move as if it were free.
/// Its power counts where it is owned alone, for all parts' are summed.
void take_held(const Cut& cut) {
  const Model& whole = cut.whole;
  Model& part = cut.part;
  take(cut, &Model::held_position);
  take(cut, &Model::held_frame);
  const auto all = [&](const std::vector<std::size_t>& from, std::vector<std::size_t>& to) {
    take_nodes(cut, from, cut.first, cut.end, to);
  };
  all(whole.held_positions, part.held_positions);
  take_nodes(cut, whole.driven_positions, cut.own_first, cut.own_end, part.driven_positions);
  take_nodes(cut, whole.driven_frames, cut.own_first, cut.own_end, part.driven_frames);
  part.driven = !part.driven_positions.empty() || !part.driven_frames.empty();
  all(whole.bending.held, part.bending.held);
  all(whole.bending.held_hinges, part.bending.held_hinges);
  part.bending.held_child.assign(part.bending.held.size(), -1);
  // These are read at held nodes alone, which most parts have none of.
  if (part.bending.held.empty() && part.bending.held_hinges.empty() && !part.driven) return;
  for (auto numbers : {&Model::bend_l, &Model::bend_m, &Model::bend_t, &Model::moved_mass, &Model::viscosity})
    take(cut, numbers);
  for (auto numbers : {&Model::rest_l, &Model::rest_m, &Model::rest_t}) take(cut, numbers, 2);
}

/// Where a rod is cut there is neither an edge beyond nor what would bend there. What comes of that is
/// wrong, and by the end of a step has come up to the own nodes, but not to them (kFelt in tiles.cpp).
void end_where_cut(const Cut& cut) {
  Model& part = cut.part;
  for (const NodeRange& rod : part.rods) {
    const std::size_t last = rod.first + rod.count - 1;
    part.begins[rod.first] = part.ends[last] = 1;
    for (auto numbers : {&part.stretch, &part.twist, &part.rest_length, &part.rest_twist})
      (*numbers)[last] = 0.0;
    for (auto numbers : {&part.bending.k_l, &part.bending.k_m, &part.bending.k_t, &part.bending.hinge})
      (*numbers)[rod.first] = (*numbers)[last] = 0.0;
  }
}

/// Gives `act` the columns of a part that tell one place of a scene from another: masses, springs, rest
/// lengths. Without twist most are zeros.
template <class Part>
void each_constant(Part& part, const auto& act) {
  const auto vectors = [&](auto&... columns) { (act(columns.data()), ...); };
  auto& bending = part.bending;
  vectors(part.stretch, part.rest_length, bending.hinge, part.inverse_mass, part.damping, part.damped_mass);
  if (part.twist_nodes == 0) return;
  vectors(part.twist, part.rest_twist, part.inverse_inertia, part.free_inertia, part.damped_inertia);
  vectors(bending.k_l, bending.k_m, bending.k_t, bending.rest_l, bending.rest_m, bending.rest_t);
}

}  // namespace

std::vector<double> constants_of(const Model& part) {
  std::vector<double> constants;
  each_constant(part,
                [&](const double* from) { constants.insert(constants.end(), from, from + part.nodes); });
  return constants;
}

void put_constants(const std::vector<double>& constants, Model& part) {
  const double* from = constants.data();
  each_constant(part, [&](double* to) {
    std::copy_n(from, part.nodes, to);
    from += part.nodes;
  });
}

bool has_anchors(const Model& part) {
  return !part.anchors.empty() || !part.held_positions.empty();
}

bool alike_but_for_constants(const Model& a, const Model& b) {
  return a.begins == b.begins && a.ends == b.ends && a.twist_index == b.twist_index &&
         a.segments == b.segments;
}

std::vector<AnchoredNode> anchored_nodes(const Model& model) {
  std::vector<AnchoredNode> nodes;
  for (std::size_t a = 0; a < model.anchors.size(); ++a)
    nodes.push_back({model.rods[model.anchors[a].rod].first + model.anchors[a].node, a});
  std::sort(nodes.begin(), nodes.end(),
            [](const AnchoredNode& a, const AnchoredNode& b) { return a.node < b.node; });
  return nodes;
}

std::shared_ptr<Model> part_of(const Model& whole, const std::vector<AnchoredNode>& anchored,
                               std::size_t first, std::size_t end, std::size_t own_first,
                               std::size_t own_end) {
  const auto result = std::make_shared<Model>();
  Model& part = *result;
  part.nodes = end - first;
  part.from = whole.from;
  part.gravity = whole.gravity;
  part.damped = whole.damped;
  const Cut cut{whole, first, end, own_first, own_end, part};
  take_rods(cut);
  take_anchors(cut, anchored);
  take_held(cut);
  for (auto flags : {&Model::begins, &Model::ends}) take(cut, flags);
  for (auto numbers :
       {&Model::damping, &Model::stretch, &Model::twist, &Model::rest_length, &Model::rest_twist})
    take(cut, numbers);
  std::size_t rank = kPartRank;
  for (auto column : {&Model::inverse_mass, &Model::inverse_inertia, &Model::free_inertia,
                      &Model::damped_mass, &Model::damped_inertia})
    part.*column = column_of(cut, whole.*column, rank);
  using Bending = Model::Bending;
  for (auto column : {&Bending::k_l, &Bending::k_m, &Bending::k_t, &Bending::rest_l, &Bending::rest_m,
                      &Bending::rest_t, &Bending::hinge})
    part.bending.*column = column_of(cut, whole.bending.*column, rank);
  // Damping slows all nodes by `damping`; these two make its power, once a node of the scene.
  for (std::size_t i = 0; i < part.nodes; ++i)
    if (!cut.owns(first + i)) part.damped_mass[i] = part.damped_inertia[i] = 0.0;
  end_where_cut(cut);
  return result;
}

}  // namespace tendril
