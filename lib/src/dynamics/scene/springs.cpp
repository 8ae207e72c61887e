#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/vector/lanes.h"
#include "model.h"

namespace tendril {
namespace {

constexpr std::size_t kSpringRank = 65;  // of the first column, behind those of the model's nodes
// Of a node whose half edges bend: each child's springs there are coupled with all others'.
constexpr std::size_t kMostChildren = 16;
constexpr double kStraight = 1e-9;  // rest angle below which a node counts as straight [rad]

}  // namespace

EdgeAngles edge_angles(const Vec3& e, const Frame& frame) {
  const auto plain = [](const Vec3& v) { return lanes::V3{v.x(), v.y(), v.z()}; };
  return lanes::edge_angles(plain(e), {plain(frame.x), plain(frame.y), plain(frame.z)});
}

double twist_angle(const Frame& before, const Frame& after) {
  const Vec3 carried = rotate_smallest(before.z, after.z, before.y);
  const double sine = carried.cross(after.y).dot(after.z);
  const double cosine = carried.dot(after.y);
  const bool near = cosine > 0.0 && sine * sine <= lanes::kNearSquare;
  return near ? sine * lanes::asin_ratio(sine * sine) : std::atan2(sine, cosine);
}

void Model::flatten_rest_angles(const NodeRange& range) {
  for (std::size_t i = range.first; i + 1 < range.first + range.count; ++i) {
    const Vec3 edge = rest_p[i + 1] - rest_p[i];
    rest_length[i] = edge.norm();
    rest_twist[i] = twist_angle(rest_frame[i], rest_frame[i + 1]);
    for (std::size_t side = 0; side < 2; ++side) {
      const EdgeAngles a = edge_angles(edge / rest_length[i], rest_frame[i + side]);
      // Rounding must not give a straight chain a rest cone: the third spring has a kink at its tip.
      if (!(a.t > kStraight)) continue;
      rest_l[2 * i + side] = a.l;
      rest_m[2 * i + side] = a.m;
      rest_t[2 * i + side] = a.t;
    }
  }
}

/// With the springs of the node's own edges alone: about l they turn towards m, and the other way round.
Model::Hub Model::empty_hub(std::size_t node) const {
  const double edges = has_before(node) && has_after(node) ? 2.0 : 1.0;
  Hub hub{node, {}, Eigen::Matrix2d::Zero()};
  hub.give.diagonal() << edges * (bend_m[node] + bend_t[node]), edges * (bend_l[node] + bend_t[node]);
  return hub;
}

/// Not where a frame is held, nor where the own edges do not bend: there nothing gives way.
void Model::add_hubs() {
  const std::vector<std::size_t> rod_of = rods_of_nodes();
  std::vector<Mat3> rest(nodes, Mat3::Identity());  // of roots, in the frames of the nodes that carry them
  std::vector<std::size_t> hub_of(nodes, nodes);
  for (const Attachment& attached : attachments) {
    const std::size_t i = attached.root;
    const std::size_t at = carrier[i];
    Mat3 own;
    own << attached.rest.x, attached.rest.y, attached.rest.z;
    rest[i] = rest[attached.parent] * own;
    const bool bends = std::min(bend_l[at], bend_m[at]) + bend_t[at] > 0.0;
    if (!bends || holds_frame(at) || feels[i] == 0) continue;
    if (hub_of[at] == nodes) {
      hub_of[at] = hubs.size();
      hubs.push_back(empty_hub(at));
    }
    // Turns towards l and m are those about m and -l, the twist that about t.
    Mat3 turns;
    turns << rest[i].col(1), -rest[i].col(0), rest[i].col(2);
    const Eigen::Matrix<double, 3, 2> turn = turns.transpose().leftCols<2>();
    const Vec3 springs(bend_l[i] + bend_t[i], bend_m[i] + bend_t[i], twist[i]);
    Hub& hub = hubs[hub_of[at]];
    hub.children.push_back({i, rod_of[i], turn.transpose() * springs.asDiagonal(), turn});
    hub.give += hub.children.back().moment * turn;
  }
  std::erase_if(hubs, [](const Hub& hub) { return hub.children.size() > kMostChildren; });
  for (Hub& hub : hubs) hub.give = hub.give.inverse().eval();
  std::vector<int> place(nodes, -1);
  for (const Hub& hub : hubs)
    for (const Hub::Child& child : hub.children) place[child.root] = static_cast<int>(hub_children++);
  for (const std::size_t node : bending.held) bending.held_child.push_back(place[node]);
}

/// Neighbouring rods of one kind become one segment, so that loops run over as many nodes as they can; what a
/// segment's rods lack (third springs, rest angles, viscosity) its loop does not read.
void Model::lay_out_springs() {
  begins.assign(nodes, 0);
  ends.assign(nodes, 0);
  for (std::size_t r = 0; r < rods.size(); ++r) {
    const NodeRange& rod = rods[r];
    const std::size_t end = rod.first + rod.count;
    begins[rod.first] = ends[end - 1] = 1;
    seed.push_back(rod.first);
    for (std::size_t i = rod.first; i < end; ++i)
      if (holds_frame(i)) seed[r] = i;
    const bool third =
        std::any_of(bend_t.begin() + static_cast<std::ptrdiff_t>(rod.first),
                    bend_t.begin() + static_cast<std::ptrdiff_t>(end), [](double k) { return k > 0.0; });
    const bool straight = std::all_of(rest_t.begin() + static_cast<std::ptrdiff_t>(2 * rod.first),
                                      rest_t.begin() + static_cast<std::ptrdiff_t>(2 * end),
                                      [](double rest) { return rest == 0.0; });
    const Segment own{rod.first, end, has_twist(rod.first), third, straight, scene.rods[r].viscosity > 0.0};
    const bool alike =
        !segments.empty() && segments.back().twist == own.twist &&
        (!own.twist || (segments.back().third == own.third && segments.back().straight == own.straight &&
                        segments.back().viscous == own.viscous));
    if (alike)
      segments.back().end = end;
    else
      segments.push_back(own);
  }
  std::size_t rank = kSpringRank;
  for (auto* numbers : {&bending.k_l, &bending.k_m, &bending.k_t, &bending.rest_l, &bending.rest_m,
                        &bending.rest_t, &bending.hinge})
    *numbers = Column(nodes, rank++);
  for (std::size_t i = 0; i < nodes; ++i) lay_out_bending(i);
}

/// The tangent halves the angle between a node's two edges, so that both deviate alike and one reading serves
/// for both: rest angles are half the difference of theirs (half the sum of the angles to t, which have no
/// sign).
void Model::lay_out_bending(std::size_t i) {
  if (holds_frame(i)) {
    (has_twist(i) ? bending.held : bending.held_hinges).push_back(i);
  } else if (has_before(i) && has_after(i)) {
    if (!has_twist(i)) {
      bending.hinge[i] = bend_l[i] + bend_t[i];
      return;
    }
    const std::size_t before = 2 * i - 1;
    const std::size_t after = 2 * i;
    bending.k_l[i] = bend_l[i];
    bending.k_m[i] = bend_m[i];
    bending.k_t[i] = bend_t[i];
    bending.rest_l[i] = 0.5 * (rest_l[after] - rest_l[before]);
    bending.rest_m[i] = 0.5 * (rest_m[after] - rest_m[before]);
    bending.rest_t[i] = 0.5 * (rest_t[after] + rest_t[before]);
  }
}

}  // namespace tendril
