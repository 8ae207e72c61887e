#include "statics_coordinates.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dynamics/scene/model.h"
#include "dynamics/scene/words.h"

namespace tendril {
namespace {

constexpr double kMostTurn = 0.5;     // of an edge in one step [rad]
constexpr double kMostStretch = 0.3;  // of an edge in one step, over its length
constexpr double kMostTwist = 1.0;    // of a node against the next in one step [rad]

constexpr double kStiff = 1e-12;  // how much edges stretch to close what turns can close

/// The edge d, moved by m at its far end: turned by the part across it, stretched by the part along it.
Vec3 turned(const Vec3& d, const Vec3& m) {
  const double length = d.norm();
  if (!(length > 0.0)) return d + m;
  const Vec3 e = d / length;
  const Vec3 axis = e.cross(m) / length;
  const double angle = axis.norm();
  const double stretched = std::max(length + e.dot(m), 0.1 * length);
  return stretched * (angle > 0.0 ? rotate_about(axis / angle, angle, e) : e);
}

}  // namespace

StaticCoordinates::StaticCoordinates(const System& system) : system_(system) {
  hold();
  sort_rods();
  number();
  measure();
}

void StaticCoordinates::hold() {
  const std::size_t n = system_.node_count();
  held_position_.assign(n, 0);
  held_frame_.assign(n, 0);
  anchor_.assign(n, nullptr);
  for (const Anchor& anchor : model_of(system_).anchors) {
    const std::size_t node = system_.rods()[anchor.rod].first + anchor.node;
    held_position_[node] = anchor.holds_position;
    held_frame_[node] = anchor.holds_frame;
    if (anchor.motion && anchor.holds_position) anchor_[node] = &anchor;
  }
  slide_.assign(n, -1);
  for (const Model::Slider& slider : model_of(system_).sliders) {
    held_position_[slider.node] = 0;
    slide_[slider.node] = static_cast<int>(slides_.size());
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(slider.free);  // eigenvalues ascend: 0 is held, 1 is free
    slides_.push_back(
        {axes.eigenvectors().rowwise().reverse(), static_cast<int>(std::lround(slider.free.trace()))});
  }
  parent_node_.assign(system_.rods().size(), -1);
  reacts_.assign(system_.rods().size(), 1);
  for (const Joint& joint : system_.scene().joints) {
    const std::size_t root = system_.rods()[joint.child].first;
    parent_node_[joint.child] = static_cast<std::ptrdiff_t>(system_.rods()[joint.parent].first + joint.node);
    reacts_[joint.child] = joint.reaction;
    held_position_[root] = held_frame_[root] = 1;
  }
}

void StaticCoordinates::sort_rods() {
  const std::size_t count = system_.rods().size();
  std::vector<std::ptrdiff_t> parent(count, -1);
  for (const Joint& joint : system_.scene().joints)
    parent[joint.child] = static_cast<std::ptrdiff_t>(joint.parent);
  // Depths by walking up, each rod once, to where a depth is known.
  std::vector<long> depth(count, -1);
  std::vector<std::size_t> above;
  for (std::size_t r = 0; r < count; ++r) {
    std::ptrdiff_t up = static_cast<std::ptrdiff_t>(r);
    for (; up >= 0 && depth[static_cast<std::size_t>(up)] < 0; up = parent[static_cast<std::size_t>(up)])
      above.push_back(static_cast<std::size_t>(up));
    long d = up < 0 ? -1 : depth[static_cast<std::size_t>(up)];
    for (; !above.empty(); above.pop_back()) depth[above.back()] = ++d;
  }
  rods_.resize(count);
  std::iota(rods_.begin(), rods_.end(), std::size_t{0});
  std::stable_sort(rods_.begin(), rods_.end(),
                   [&](std::size_t a, std::size_t b) { return depth[a] > depth[b]; });
}

void StaticCoordinates::number() {
  const std::size_t n = system_.node_count();
  const auto positions = 3 * static_cast<Eigen::Index>(n);
  row_of_.assign(3 * n + system_.twist_count(), -1);
  row_.assign(4 * n, -1);
  turn_in_y_.assign(n, -1);
  const auto add = [&](std::size_t node, int axis, Eigen::Index in_gradient) {
    row_of_[static_cast<std::size_t>(in_gradient)] = row_[4 * node + static_cast<std::size_t>(axis)] = size();
    node_.push_back(node);
    axis_.push_back(axis);
    in_gradient_.push_back(in_gradient);
  };
  for (const std::size_t r : rods_) {
    const NodeRange& rod = system_.rods()[r];
    for (std::size_t i = rod.first + rod.count; i-- > rod.first;) {
      const int free = slide_[i] < 0 ? 3 : slides_[static_cast<std::size_t>(slide_[i])].free;
      for (int axis = 0; axis < free && !holds_position(i); ++axis)
        add(i, axis, 3 * static_cast<Eigen::Index>(i) + axis);
      const int twist = model_of(system_).twist_index[i];
      if (!model_of(system_).turns(i)) continue;
      turn_in_y_[i] = 2 * positions + twist;
      add(i, 3, positions + twist);
    }
  }
}

void StaticCoordinates::measure() {
  const std::size_t n = system_.node_count();
  std::vector<double> share(n, 0.0);
  double softest = 0.0;
  for (std::size_t r = 0; r < system_.rods().size(); ++r) {
    const Rod& rod = system_.scene().rods[r];
    const std::size_t first = system_.rods()[r].first;
    double length = 0.0, bending = 0.0;
    for (std::size_t i = 0; i + 1 < rod.p.size(); ++i) {
      const double edge = (rod.p[i + 1] - rod.p[i]).norm();
      length += edge;
      share[first + i] += 0.5 * edge;
      share[first + i + 1] += 0.5 * edge;
    }
    for (std::size_t i = 0; i < rod.p.size(); ++i)
      bending = std::max(bending, 0.5 * (std::max(rod.bend_l[i], rod.bend_m[i]) + rod.bend_t[i]) * length /
                                      static_cast<double>(rod.p.size() - 1));
    length_ = std::max(length_, length);
    if (bending > 0.0 && (softest == 0.0 || bending / length < softest)) softest = bending / length;
  }
  energy_scale_ = softest;
  weight_.resize(size());
  for (Eigen::Index k = 0; k < size(); ++k)
    weight_[k] = share[node(k)] / length_ / (axis(k) == 3 ? 1.0 : length_ * length_);
}

Vec3 StaticCoordinates::held(std::size_t node, const Vec3& v) const {
  if (holds_position(node)) return v;
  if (!axes(node)) return Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  for (int axis = slides_[static_cast<std::size_t>(slide_[node])].free; axis < 3; ++axis)
    sum += axes(node)->col(axis).dot(v) * axes(node)->col(axis);
  return sum;
}

void StaticCoordinates::turn_to_axes(Eigen::SparseMatrix<double>& hessian) const {
  if (slides_.empty()) return;
  std::vector<Eigen::Triplet<double>> turn;
  for (Eigen::Index k = 0; k < hessian.rows(); ++k) {
    const auto node = static_cast<std::size_t>(k / 3);
    if (node >= slide_.size() || !axes(node))
      turn.emplace_back(k, k, 1.0);
    else
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        turn.emplace_back(k, k - k % 3 + axis, (*axes(node))(k % 3, axis));
  }
  Eigen::SparseMatrix<double> by(hessian.rows(), hessian.rows());
  by.setFromTriplets(turn.begin(), turn.end());
  hessian = (by.transpose() * hessian * by).pruned(0.0, 0.0);
}

double StaticCoordinates::turn_of(std::size_t i, const Eigen::VectorXd& x) const {
  const Eigen::Index k = row(i, 3);
  return k < 0 ? 0.0 : x[k];
}

Eigen::VectorXd StaticCoordinates::moves(const State& state, const Eigen::VectorXd& x, double time) const {
  Eigen::VectorXd move = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(system_.node_count()));
  for (Eigen::Index k = 0; k < size(); ++k)
    if (axis(k) < 3 && axes(node(k)))
      move.segment<3>(3 * static_cast<Eigen::Index>(node(k))) += x[k] * axes(node(k))->col(axis(k));
    else if (axis(k) < 3)
      move[in_gradient(k)] = x[k];
  for (std::size_t i = 0; i < anchor_.size(); ++i)
    if (anchor_[i] != nullptr)
      move.segment<3>(3 * static_cast<Eigen::Index>(i)) +=
          held(i, anchor_[i]->motion(time).position - at(state.y, i));
  for (auto r = rods_.rbegin(); r != rods_.rend(); ++r)
    if (parent_node_[*r] >= 0)
      move.segment<3>(3 * static_cast<Eigen::Index>(system_.rods()[*r].first)) =
          at(move, static_cast<std::size_t>(parent_node_[*r]));
  return move;
}

/// What all edges from one node to another share to close a miss: each turns by e x shared and stretches by
/// `soft` of its part along them.
Vec3 StaticCoordinates::shared(const State& state, std::size_t from, std::size_t to, const Vec3& miss,
                               double soft) const {
  Mat3 a = Mat3::Zero();
  for (std::size_t i = from; i < to; ++i) {
    const Vec3 d = at(state.y, i + 1) - at(state.y, i);
    const double length = d.norm();
    if (length > 0.0) a += length * Mat3::Identity() - (1 - soft) / length * d * d.transpose();
  }
  const Vec3 x = a.ldlt().solve(miss);
  return x.allFinite() ? x : Vec3(Vec3::Zero());
}

/// Closes a miss by turns no larger than `turn`, and by strain only where those do not do.
void StaticCoordinates::turn_to_close(State& state, std::size_t from, std::size_t to, const Vec3& miss,
                                      double turn) const {
  double soft = kStiff;
  Vec3 x = shared(state, from, to, miss, soft);
  const auto largest = [&] {
    double most = 0.0;
    for (std::size_t i = from; i < to; ++i)
      most = std::max(most, (at(state.y, i + 1) - at(state.y, i)).normalized().cross(x).norm());
    return most;
  };
  if (largest() > turn) x = shared(state, from, to, miss, soft = std::clamp(turn * turn, kStiff, 1.0));
  Vec3 old = at(state.y, from);
  for (std::size_t i = from; i < to; ++i) {
    const Vec3 next = at(state.y, i + 1);
    const Vec3 d = next - old;
    const Vec3 along = d.dot(x) / std::max(d.norm(), 1e-300) * d;
    old = next;
    state.y.segment<3>(3 * static_cast<Eigen::Index>(i + 1)) =
        at(state.y, i) + turned(d, d.norm() * x - (1 - soft) * along);
  }
}

/// Brings the node `to` to its target.
/// \param turn  the largest of the step
void StaticCoordinates::close(State& state, std::size_t from, std::size_t to, const Vec3& target,
                              double turn) const {
  for (int i = 0; i < 3; ++i) turn_to_close(state, from, to, target - at(state.y, to), turn);
  double length = 0.0;
  for (std::size_t i = from; i < to; ++i) length += (at(state.y, i + 1) - at(state.y, i)).norm();
  const Vec3 miss = target - at(state.y, to);
  double gone = 0.0;
  Vec3 before = at(state.y, from);
  for (std::size_t i = from; i < to; ++i) {
    const Vec3 here = at(state.y, i + 1);
    gone += (here - before).norm();
    before = here;
    state.y.segment<3>(3 * static_cast<Eigen::Index>(i + 1)) +=
        length > 0.0 ? Vec3(gone / length * miss) : miss;
  }
}

void StaticCoordinates::thread(State& state, const NodeRange& rod, const Eigen::VectorXd& move) const {
  Vec3 old = at(state.y, rod.first);
  state.y.segment<3>(3 * static_cast<Eigen::Index>(rod.first)) += at(move, rod.first);
  std::size_t held_at = rod.first;
  double turn = 0.0;
  for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
    const Vec3 next = at(state.y, i + 1);
    const Vec3 d = next - old;
    const Vec3 m = at(move, i + 1) - at(move, i);
    const Vec3 edge = turned(d, m);
    turn = std::max(turn, d.cross(m).norm() / std::max(d.squaredNorm(), 1e-300));
    state.y.segment<3>(3 * static_cast<Eigen::Index>(i + 1)) = at(state.y, i) + edge;
    old = next;
    if (!holds_position(i + 1) && !axes(i + 1)) continue;
    // A node that slides is brought to where it may be, wherever the edges have led it along that.
    Vec3 target = next + at(move, i + 1);
    if (axes(i + 1)) target = at(state.y, i + 1) + held(i + 1, target - at(state.y, i + 1));
    close(state, held_at, i + 1, target, turn);
    held_at = i + 1;
    turn = 0.0;
  }
}

void StaticCoordinates::displace(State& state, const Eigen::VectorXd& x, double time) const {
  const Eigen::VectorXd move = moves(state, x, time);
  for (auto r = rods_.rbegin(); r != rods_.rend(); ++r) thread(state, system_.rods()[*r], move);
  for (std::size_t i = 0; i < turn_in_y_.size(); ++i)
    if (turn_in_y_[i] >= 0) state.y[turn_in_y_[i]] += turn_of(i, x);
  state.time = time;
}

double StaticCoordinates::reach(const State& state, const Eigen::VectorXd& x, double time) const {
  const Eigen::VectorXd move = moves(state, x, time);
  double largest = 0.0;
  for (const NodeRange& rod : system_.rods())
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      const Vec3 d = at(state.y, i + 1) - at(state.y, i);
      const Vec3 m = at(move, i + 1) - at(move, i);
      const double length = d.norm();
      largest = std::max(largest, d.cross(m).norm() / (length * length * kMostTurn));
      largest = std::max(largest, std::abs(d.dot(m)) / (length * length * kMostStretch));
      if (row(i, 3) >= 0 && row(i + 1, 3) >= 0)
        largest = std::max(largest, std::abs(turn_of(i + 1, x) - turn_of(i, x)) / kMostTwist);
    }
  return largest;
}

double StaticCoordinates::norm(const Eigen::VectorXd& x) const {
  double largest = 0.0;
  for (Eigen::Index k = 0; k < size(); ++k)
    largest = std::max(largest, std::abs(x[k]) / (axis(k) == 3 ? 1.0 : length_));
  return largest;
}

void StaticCoordinates::stop(State& state) const {
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  const auto m = static_cast<Eigen::Index>(system_.twist_count());
  state.y.segment(3 * n, 3 * n).setZero();
  state.y.segment(6 * n + m, m).setZero();
}

std::string StaticCoordinates::name_of(std::size_t node) const {
  std::size_t rod = 0;
  while (rod + 1 < system_.rods().size() && node >= system_.rods()[rod + 1].first) ++rod;
  return sentence("rod ", rod, " node ", node - system_.rods()[rod].first);
}

}  // namespace tendril
