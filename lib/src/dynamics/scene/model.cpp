#include "model.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tendril {
namespace {

std::string member(const char* list, std::size_t i, const char* field) {
  return std::string(list) + "[" + std::to_string(i) + "]." + field;
}

void check_values(std::size_t rod, const char* field, const std::vector<double>& values, std::size_t count,
                  bool positive) {
  const std::string place = member("rods", rod, field);
  if (values.size() != count)
    throw InvalidInput(place, std::to_string(values.size()) + " values", std::to_string(count));
  for (std::size_t i = 0; i < count; ++i) {
    const bool right = std::isfinite(values[i]) && (positive ? values[i] > 0.0 : values[i] >= 0.0);
    if (!right)
      throw InvalidInput(place + "[" + std::to_string(i) + "]", std::to_string(values[i]),
                         positive ? "a positive number" : "a number >= 0");
  }
}

void check_rod(const Rod& rod, std::size_t index) {
  const std::size_t n = rod.p.size();
  if (n < 2) throw InvalidInput(member("rods", index, "p"), std::to_string(n) + " masses", "at least 2");
  if (rod.q.size() != n)
    throw InvalidInput(member("rods", index, "q"), std::to_string(rod.q.size()) + " masses",
                       std::to_string(n));
  for (std::size_t i = 0; i < n; ++i)
    if (!is_finite(rod.p[i]) || !is_finite(rod.q[i]))
      throw InvalidInput(member("rods", index, "p or q") + "[" + std::to_string(i) + "]", "not finite",
                         "finite coordinates");
  check_values(index, "mass", rod.mass, n, true);
  check_values(index, "inertia", rod.inertia, n, true);
  check_values(index, "bend_l", rod.bend_l, n, false);
  check_values(index, "bend_m", rod.bend_m, n, false);
  check_values(index, "bend_t", rod.bend_t, n, false);
  check_values(index, "stretch", rod.stretch, n - 1, false);
  check_values(index, "twist", rod.twist, n - 1, false);
  check_values(index, "width", rod.width, n - 1, false);
  check_values(index, "mass_damping", {rod.mass_damping}, 1, false);
  check_values(index, "viscosity", {rod.viscosity}, 1, false);
  const NodeFrames frames = node_frames(rod.p, rod.q);
  for (std::size_t i = 0; i < n; ++i)
    if (frames.status[i] != FrameStatus::ok)
      throw InvalidInput("rods[" + std::to_string(index) + "] node " + std::to_string(i),
                         "no frame: coinciding or folded-back masses, or an orientation mass on the tangent",
                         "a rest shape with a frame at every node");
}

/// \param what  the anchor's member
Vec3 direction_of(const Vec3& axis, const std::string& place, const char* what) {
  const double length = axis.stableNorm();
  if (!(length > 0.0) || !std::isfinite(length))
    throw InvalidInput(place, "no direction", std::string("a ") + what + " that is finite and not zero");
  return axis / length;
}

/// Projects on what a slide leaves free.
Mat3 free_of(const Anchor& anchor, const std::string& place) {
  if (!anchor.holds_position)
    throw InvalidInput(place, "of a position that is not held", "holds_position, or no slide");
  const Vec3 axis = direction_of(anchor.slide_axis, place, "slide_axis");
  const Mat3 along = axis * axis.transpose();
  return anchor.slide == Anchor::Slide::line ? along : Mat3(Mat3::Identity() - along);
}

/// In the node's frame.
Vec3 swivel_axis(const Anchor& anchor, const Frame& rest, const std::string& place) {
  if (!anchor.holds_frame)
    throw InvalidInput(place, "of a frame that is not held", "holds_frame, or no swivel");
  const Vec3 axis = direction_of(anchor.swivel_axis, place, "swivel_axis");
  return Vec3(axis.dot(rest.x), axis.dot(rest.y), axis.dot(rest.z)).normalized();
}

constexpr std::size_t kModelRank = 60;  // of the first column, behind those of a workspace

}  // namespace

std::string name_of_index(const Model& model, std::size_t index) {
  if (index >= model.nodes) return "body " + std::to_string((index - model.nodes) / 2);
  std::size_t rod = 0;
  while (index >= model.rods[rod].first + model.rods[rod].count) ++rod;
  return "rod " + std::to_string(rod) + " node " + std::to_string(index - model.rods[rod].first);
}

std::string name_of_force(std::size_t index) {
  return "forces[" + std::to_string(index) + "]";
}

Model::Model(Scene description, double since) : scene(std::move(description)), from(since) {
  if (scene.rods.empty() && scene.bodies.empty()) throw InvalidInput("rods", "none", "at least one");
  bodies = checked_bodies(scene.bodies);
  for (std::size_t r = 0; r < scene.rods.size(); ++r) {
    check_rod(scene.rods[r], r);
    flatten(scene.rods[r]);
  }
  add_anchors();
  add_joints();
  sort_rods();
  for (std::size_t f = 0; f < scene.forces.size(); ++f) {
    if (!scene.forces[f]) throw InvalidInput(name_of_force(f), "null", "a force");
    scene.forces[f]->check(rods);
  }
  choose_twist();
  choose_forces();
  lay_out_springs();
  add_hubs();
}

void Model::flatten(const Rod& rod) {
  const NodeRange range{nodes, rod.p.size()};
  rods.push_back(range);
  nodes += range.count;
  const auto append = [](auto& to, const auto& more) { to.insert(to.end(), more.begin(), more.end()); };
  append(rest_p, rod.p);
  append(mass, rod.mass);
  append(inertia, rod.inertia);
  append(bend_l, rod.bend_l);
  append(bend_m, rod.bend_m);
  append(bend_t, rod.bend_t);
  append(stretch, rod.stretch);
  append(twist, rod.twist);
  append(width, rod.width);
  damping.resize(nodes, rod.mass_damping);
  viscosity.resize(nodes, rod.viscosity);
  for (auto* edges : {&stretch, &twist, &width, &rest_length, &rest_twist}) edges->resize(nodes, 0.0);
  for (auto* numbers : {&rest_l, &rest_m, &rest_t}) numbers->resize(2 * nodes, 0.0);

  const NodeFrames frames = node_frames(rod.p, rod.q);
  append(rest_frame, frames.frame);
  for (std::size_t i = 0; i < rod.p.size(); ++i) {
    const Vec3 d = rod.q[i] - rod.p[i];
    offset.emplace_back(0.0, d.dot(frames.frame[i].y), d.dot(frames.frame[i].z));
  }
  flatten_rest_angles(range);
}

void Model::add_anchors() {
  anchored.assign(nodes, 0);
  held_position.assign(nodes, 0);
  held_frame.assign(nodes, 0);
  for (std::size_t a = 0; a < scene.anchors.size(); ++a) {
    const Anchor& anchor = scene.anchors[a];
    if (anchor.rod >= rods.size())
      throw InvalidInput(member("anchors", a, "rod"), std::to_string(anchor.rod),
                         "less than " + std::to_string(rods.size()));
    const NodeRange& range = rods[anchor.rod];
    if (anchor.node >= range.count)
      throw InvalidInput(member("anchors", a, "node"), std::to_string(anchor.node),
                         "less than " + std::to_string(range.count));
    const std::size_t node = range.first + anchor.node;
    if (anchored[node])
      throw InvalidInput(member("anchors", a, "node"), "anchored twice", "at most one anchor a node");
    anchored[node] = 1;
    if (std::isnan(anchor.until)) throw InvalidInput(member("anchors", a, "until"), "not a number", "a time");
    if (anchor.until <= from) continue;
    held_position[node] = anchor.holds_position && anchor.slide == Anchor::Slide::none;
    held_frame[node] = anchor.holds_frame;
    if (anchor.slide != Anchor::Slide::none)
      sliders.push_back({node, anchors.size(), free_of(anchor, member("anchors", a, "slide"))});
    if (anchor.swivels)
      swivels.push_back(
          {node, anchors.size(), swivel_axis(anchor, rest_frame[node], member("anchors", a, "swivels"))});
    anchors.push_back(anchor);
  }
}

void Model::add_joints() {
  attachment_index.assign(rods.size(), -1);
  moved_mass = mass;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    const auto refuse = [&](const char* field, const std::string& reason, const std::string& expected) {
      throw InvalidInput(member("joints", k, field), reason, expected);
    };
    const std::string count = "less than the " + std::to_string(rods.size()) + " rods";
    if (joint.parent >= rods.size()) refuse("parent", std::to_string(joint.parent), count);
    if (joint.child >= rods.size()) refuse("child", std::to_string(joint.child), count);
    if (joint.node >= rods[joint.parent].count)
      refuse("node", std::to_string(joint.node),
             "less than the parent's " + std::to_string(rods[joint.parent].count));
    if (attachment_index[joint.child] >= 0) refuse("child", "joined twice", "at most one parent");
    const std::size_t root = rods[joint.child].first;
    const std::size_t parent = rods[joint.parent].first + joint.node;
    if (anchored[root]) refuse("child", "its first node is anchored", "a free first node");
    const double length =
        (rest_p[root + 1] - rest_p[root]).norm() * static_cast<double>(rods[joint.child].count);
    if (!((rest_p[root] - rest_p[parent]).norm() <= 1e-9 * length))
      refuse("node", "the child's first point is elsewhere", "the child to begin at the parent's node");
    const Frame& f = rest_frame[parent];
    const Frame& g = rest_frame[root];
    const auto inside = [&](const Vec3& v) { return Vec3(v.dot(f.x), v.dot(f.y), v.dot(f.z)); };
    attachment_index[joint.child] = static_cast<int>(attachments.size());
    attachments.push_back({root, parent, {inside(g.x), inside(g.y), inside(g.z)}, joint.reaction});
    held_position[root] = held_frame[root] = 1;
  }
}

std::vector<std::size_t> Model::rods_of_nodes() const {
  std::vector<std::size_t> rod;
  for (std::size_t r = 0; r < rods.size(); ++r) rod.insert(rod.end(), rods[r].count, r);
  return rod;
}

void Model::sort_rods() {
  // Breadth first from the rods without a parent; what is not reached lies on a cycle.
  const std::vector<std::size_t> rod_of = rods_of_nodes();
  std::vector<std::vector<std::size_t>> children(rods.size());
  for (std::size_t r = 0; r < rods.size(); ++r) {
    if (const Attachment* attached = attachment_of(r))
      children[rod_of[attached->parent]].push_back(r);
    else
      order.push_back(r);
  }
  for (std::size_t k = 0; k < order.size(); ++k)
    order.insert(order.end(), children[order[k]].begin(), children[order[k]].end());
  if (order.size() < rods.size()) throw InvalidInput("joints", "a rod is its own ancestor", "trees of rods");
  std::vector<Attachment> sorted;
  for (const std::size_t r : order)
    if (const Attachment* attached = attachment_of(r)) {
      attachment_index[r] = static_cast<int>(sorted.size());
      sorted.push_back(*attached);
    }
  attachments = std::move(sorted);
  carrier.resize(index_count());
  std::iota(carrier.begin(), carrier.end(), std::size_t{0});
  feels.assign(index_count(), 1);
  for (const Attachment& attached : attachments) {
    carrier[attached.root] = carrier[attached.parent];
    feels[attached.root] = feels[attached.parent] != 0 && attached.reaction;
  }
  // From the leaves up: a root's mass goes to its parent's node, also where that is itself a root, and of its
  // spin inertia what turns about that node's tangent.
  for (auto attached = attachments.rbegin(); attached != attachments.rend(); ++attached) {
    if (!attached->reaction) continue;
    const double along = attached->rest.z.z();
    moved_mass[attached->parent] += moved_mass[attached->root];
    inertia[attached->parent] += along * along * inertia[attached->root];
  }
}

std::string Model::twist_source(std::size_t r) const {
  const NodeRange& range = rods[r];
  if (scene.twist == Scene::Twist::everywhere) return "asked for";
  if (scene.rods[r].viscosity > 0.0) return "viscosity";
  for (const auto& force : scene.forces)
    if (force->twists()) return "a torque";
  for (const Joint& joint : scene.joints)
    if (joint.parent == r || joint.child == r) return "a joint";
  int frames_held = 0;
  for (const Anchor& anchor : scene.anchors) {
    if (anchor.rod != r || !anchor.holds_frame) continue;
    if (anchor.swivels) return "a swivel";
    if (anchor.motion) return "a moving frame";
    ++frames_held;
  }
  if (frames_held > 1) return "several held frames";
  for (std::size_t i = range.first; i < range.first + range.count; ++i) {
    if (bend_l[i] != bend_m[i]) return "anisotropic bending";
    for (const std::size_t end : {2 * i, 2 * i + 1})
      if (i + 1 < range.first + range.count && rest_t[end] > 0.0) return "a curved rest shape";
  }
  return {};
}

void Model::choose_twist() {
  twist_index.assign(nodes, -1);
  for (std::size_t r = 0; r < rods.size(); ++r) {
    if (twist_source(r).empty()) {
      left_out.push_back(
          "rods[" + std::to_string(r) +
          "]: twist state left out: straight and isotropic at rest, and nothing turns it about its axis");
      continue;
    }
    for (std::size_t i = 0; i < rods[r].count; ++i)
      twist_index[rods[r].first + i] = static_cast<int>(twist_nodes++);
  }
  if (scene.forces.empty()) left_out.emplace_back("loads left out: no force in the scene");
  if (scene.joints.empty()) left_out.emplace_back("joints left out: every rod on its own");
  if (scene.anchors.empty()) left_out.emplace_back("anchors left out: no node is held");
}

void Model::choose_forces() {
  std::size_t rank = kModelRank;
  for (auto* numbers : {&inverse_mass, &inverse_inertia, &free_inertia, &damped_mass, &damped_inertia})
    *numbers = Column(nodes, rank++);
  std::vector<char> passes_on(nodes, 0);
  for (const Attachment& attached : attachments) passes_on[attached.root] = attached.reaction;
  for (std::size_t i = 0; i < nodes; ++i) {
    if (!holds_position(i)) inverse_mass[i] = 1.0 / moved_mass[i];
    if (has_twist(i) && !holds_frame(i)) free_inertia[i] = inertia[i];
    if (turns(i)) inverse_inertia[i] = 1.0 / inertia[i];
    if (holds_position(i)) held_positions.push_back(i);
    if (holds_position(i) && !passes_on[i]) driven_positions.push_back(i);
    if (holds_frame(i) && !passes_on[i] && !turns(i)) driven_frames.push_back(i);
    if (inverse_mass[i] > 0.0) damped_mass[i] = damping[i] * moved_mass[i];
    if (inverse_inertia[i] > 0.0) damped_inertia[i] = damping[i] * inertia[i];
    damped = damped || damping[i] > 0.0;
  }
  driven = !driven_positions.empty() || !driven_frames.empty() || !sliders.empty() || !swivels.empty();
  // Those by what they may do alone.
  for (const Slider& slider : sliders) damped_mass[slider.node] = 0.0;
  for (const Swivel& swivel : swivels) damped_inertia[swivel.node] = 0.0;
  for (std::size_t f = 0; f < scene.forces.size(); ++f) {
    const auto& force = scene.forces[f];
    // What accelerates every free node alike does so whatever merged with it: no loads need to be summed.
    if (const std::optional<Vec3> a = force->uniform_acceleration())
      gravity += *a;
    else
      acting.push_back({force.get(), f, force->has_energy(), force->refuses(), couplings_of(f)});
  }
  loaded = !acting.empty();
  acts_on_frames =
      std::any_of(acting.begin(), acting.end(), [](const Acting& of) { return of.force->acts_on_frames(); });
}

Couplings Model::couplings_of(std::size_t force) const {
  Couplings couplings = scene.forces[force]->couplings_with_bodies(rods, bodies.size());
  for (const auto& [a, b] : couplings.pairs())
    if (std::max(a, b) >= index_count())
      throw InvalidInput(name_of_force(force), "couples node " + std::to_string(std::max(a, b)),
                         "flat indices less than the " + std::to_string(nodes) + " nodes" +
                             (bodies.empty() ? "" : " and two a body"));
  return couplings;
}

}  // namespace tendril
