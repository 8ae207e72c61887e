#include <algorithm>
#include <utility>

#include "statics_loads.h"

namespace tendril {
namespace {

/// Derivatives by nodes' positions, put on the free coordinates that carry them: the root of a child has none
/// of its own, it goes where its parent's node goes, and what acts on it acts there, if the parent feels it.
class OnCoordinates final : public LoadDerivatives {
 public:
  OnCoordinates(const Model& model, const StaticCoordinates& coordinates,
                std::vector<Eigen::Triplet<double>>& out)
      : model_(model), coordinates_(coordinates), out_(out) {}

  void add_by_position(std::size_t i, std::size_t j, const Mat3& k) override {
    if (!model_.feels[i]) return;
    const std::size_t to = model_.carrier[i], from = model_.carrier[j];
    const Mat3* axes = coordinates_.axes(from);
    for (int b = 0; b < 3; ++b) {
      const Eigen::Index column = coordinates_.row(from, b);
      if (column < 0) continue;
      const Vec3 by = axes ? Vec3(k * axes->col(b)) : Vec3(k.col(b));
      for (int a = 0; a < 3; ++a)
        if (const Eigen::Index row = coordinates_.row(to, a); row >= 0)
          out_.emplace_back(row, column, coordinates_.along(to, a, by));
    }
  }
  void add_by_velocity(std::size_t, std::size_t, const Mat3&) override {}  // nothing moves

 private:
  const Model& model_;
  const StaticCoordinates& coordinates_;
  std::vector<Eigen::Triplet<double>>& out_;
};

}  // namespace

/// Differences of what couples n nodes ask a force some 8 n times at each tangent: what it says of itself is
/// taken instead.
void StaticLoads::put_exact(const State& state, StateView& view, std::vector<Eigen::Triplet<double>>& out) {
  OnCoordinates to(model_of(system_), coordinates_, out);
  for (const External& one : forces_) {
    if (!one.acting || !one.acting->couplings.derivatives()) continue;
    view.memory = memory_of(*one.acting, state);
    one.acting->couplings.derivatives()(view, to);
  }
}

/// Whether a torque that is the same in every state acts on a free tangent: the forces by which it turns the
/// edges around change as these turn, so that it has a derivative though its force has none.
bool StaticLoads::dead_torques(const State& state, StateView& view) {
  const Loads loads = no_loads();
  for (const External& one : forces_) {
    if (!one.dead()) continue;
    view.memory = memory_of(*one.acting, state);
    one.acting->force->add(view, loads);
  }
  pass_to_parents();
  for (std::size_t i = 0; i < torque_.size(); ++i)
    if (!coordinates_.holds_frame(i) && !torque_[i].isZero(0.0)) return true;
  return false;
}

/// Greedy, by the nodes that springs and loads couple: two nodes of one colour share none of those, so that
/// both are moved at once and each load tells which of them moved it. What touches stays the same over most
/// of a search: colours are made anew only where it does not.
void StaticLoads::colour(const Eigen::SparseMatrix<double>& pattern, NodePairs pairs) {
  if (!colours_.empty() && pairs == coloured_) return;
  const std::size_t n = system_.node_count();
  near_.assign(n, {});
  colours_.clear();
  for (Eigen::Index column = 0; column < 3 * static_cast<Eigen::Index>(n); column += 3)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(pattern, column); entry; ++entry)
      if (entry.row() < 3 * static_cast<Eigen::Index>(n) && entry.row() % 3 == 0)
        near_[static_cast<std::size_t>(column / 3)].push_back(static_cast<std::size_t>(entry.row() / 3));
  for (const auto& [a, b] : pairs) {
    near_[a].push_back(b);
    near_[b].push_back(a);
  }
  for (auto& list : near_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  std::vector<std::size_t> colour_of(n, n);
  std::vector<std::size_t> seen(n + 1, n);
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t j : near_[i])
      for (const std::size_t k : near_[j]) seen[colour_of[k]] = i;
    std::size_t colour = 0;
    while (seen[colour] == i) ++colour;
    colour_of[i] = colour;
    if (colour == colours_.size()) colours_.emplace_back();
    colours_[colour].push_back(i);
  }
  coloured_ = std::move(pairs);
}

/// What the forces that differences are taken of do where x moves a state to. Their energies are not asked
/// for: of a contact they cost as much as its loads.
Evaluation StaticLoads::moved(const State& state, const Eigen::VectorXd& x, Eigen::VectorXd& q,
                              System::Workspace& work) {
  const Model& model = model_of(system_);
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  State there = state;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Eigen::Index place = coordinates_.in_gradient(k);
    const std::size_t node = coordinates_.node(k);
    if (const Mat3* axes = coordinates_.axes(node); axes && coordinates_.axis(k) < 3)
      there.y.segment<3>(3 * static_cast<Eigen::Index>(node)) += x[k] * axes->col(coordinates_.axis(k));
    else
      there.y[coordinates_.axis(k) == 3 ? place + 3 * n : place] += x[k];
  }
  // No coordinate moves the root of a child: left where it was, what acts on it would seem not to change.
  for (const NodeRange& rod : system_.rods()) {
    const std::size_t root = rod.first, parent = model.carrier[root];
    there.y.segment<3>(3 * static_cast<Eigen::Index>(root)) += at(there.y, parent) - at(state.y, parent);
  }
  const std::vector<Frame> frames = system_.frames(there, work);
  if (frames.empty()) return {Evaluation::Outcome::not_finite, 0};
  StateView view = view_of(there, frames);
  std::size_t refused = Loads::kNone;
  const Loads loads = no_loads(&refused);
  for (const Differenced& one : differenced_) {
    view.memory = memory_of(*one.acting, there);
    if (one.beside)
      one.beside(view, loads);
    else
      one.acting->force->add(view, loads);
  }
  if (refused != Loads::kNone) return {Evaluation::Outcome::refused, refused};
  pass_to_parents();
  q.setZero(coordinates_.size());
  pull_back(frames, q);
  return q.allFinite() ? Evaluation{} : Evaluation{Evaluation::Outcome::not_finite, 0};
}

/// Finds what differences have to be taken of at a state, into differenced_.
/// \return  the nodes that it couples there
NodePairs StaticLoads::find_differenced(const State& state, StateView& view) {
  const bool torques = dead_torques(state, view);
  NodePairs pairs;
  differenced_.clear();
  for (const External& one : forces_) {
    if (!one.acting || (one.dead() && !torques) || one.acting->couplings.derivatives()) continue;
    if (!one.acting->varies()) {
      pairs.insert(pairs.end(), one.always.begin(), one.always.end());
      differenced_.push_back({one.acting, {}});
      continue;
    }
    view.memory = memory_of(*one.acting, state);
    LocalCouplings local = one.acting->couplings.local()(view);
    if (local.pairs.empty()) continue;
    const NodePairs now = coupled_by_pairs(model_of(system_), local.pairs, true);
    pairs.insert(pairs.end(), now.begin(), now.end());
    differenced_.push_back({one.acting, std::move(local.add)});
  }
  return pairs;
}

Evaluation StaticLoads::differentiate(const State& state, const Eigen::SparseMatrix<double>& pattern,
                                      std::vector<Eigen::Triplet<double>>& out, System::Workspace& work) {
  const std::vector<Frame> frames = system_.frames(state, work);
  if (frames.empty()) return {Evaluation::Outcome::not_finite, 0};
  StateView view = view_of(state, frames);
  put_exact(state, view, out);
  NodePairs pairs = find_differenced(state, view);
  if (differenced_.empty()) return {};
  colour(pattern, std::move(pairs));
  return take_differences(state, out, work);
}

/// Central, of a millionth of an edge or of a radian: a tenth of what loads beside a state are good for
/// (LocalCouplings), and large against the rounding of positions.
Evaluation StaticLoads::take_differences(const State& state, std::vector<Eigen::Triplet<double>>& out,
                                         System::Workspace& work) {
  const double edge = coordinates_.length() / static_cast<double>(system_.node_count());
  Eigen::VectorXd up, down;
  for (const auto& nodes : colours_)
    for (int axis = 0; axis < 4; ++axis) {
      const double step = 1e-6 * (axis == 3 ? 1.0 : edge);
      Eigen::VectorXd x = Eigen::VectorXd::Zero(coordinates_.size());
      bool any = false;
      for (const std::size_t i : nodes)
        if (const Eigen::Index k = coordinates_.row(i, axis); k >= 0) x[k] = step, any = true;
      if (!any) continue;
      if (const Evaluation e = moved(state, x, up, work); !e.ok()) return e;
      if (const Evaluation e = moved(state, -x, down, work); !e.ok()) return e;
      for (const std::size_t i : nodes) {
        const Eigen::Index column = coordinates_.row(i, axis);
        if (column < 0) continue;
        for (const std::size_t j : near_[i])
          for (int b = 0; b < 4; ++b)
            if (const Eigen::Index r = coordinates_.row(j, b); r >= 0 && up[r] != down[r])
              out.emplace_back(r, column, (up[r] - down[r]) / (2 * step));
      }
    }
  return {};
}

}  // namespace tendril
