#include <tendril/curve/frames.h>
#include <tendril/dynamics/check_force.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace tendril {
namespace {

using Vectors = std::vector<Vec3>;

/// A state on arrays of its own, so that it can be moved.
struct Movable {
  explicit Movable(const StateView& view)
      : seen(view),
        p(view.p.begin(), view.p.end()),
        v(view.v.begin(), view.v.end()),
        t(view.t.begin(), view.t.end()),
        m(view.m.begin(), view.m.end()),
        turn(view.turn.begin(), view.turn.end()),
        spin(view.spin.begin(), view.spin.end()),
        bodies(view.bodies.begin(), view.bodies.end()) {
    // Frames that the view does not have are any.
    t.resize(p.size(), Vec3::UnitX());
    for (Vectors* vectors : {&m, &turn}) vectors->resize(p.size(), Vec3::Zero());
    spin.resize(p.size(), 0.0);
    seen.p = p;
    seen.v = v;
    seen.t = t;
    seen.m = m;
    seen.turn = turn;
    seen.spin = spin;
    seen.bodies = bodies;
    for (const NodeRange& rod : view.rods)
      for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i)
        length = std::max(length, (p[i + 1] - p[i]).norm());
    if (view.rods.empty()) length = 1.0;
    speed = length;
    for (const Vec3& one : v) speed = std::max(speed, one.norm());
    for (const BodyView& body : bodies) speed = std::max(speed, body.velocity.norm());
  }
  std::size_t indices() const { return p.size() + 2 * bodies.size(); }

  StateView seen;
  Vectors p, v, t, m, turn;
  std::vector<double> spin;
  std::vector<BodyView> bodies;
  double length = 0.0, speed = 0.0;
};

struct Load {
  Load(const Force& of, const StateView& at)
      : Load([&](const StateView& state, const Loads& loads) { of.add(state, loads); }, at) {}
  Load(const std::function<void(const StateView&, const Loads&)>& add, const StateView& at)
      : force(at.p.size(), Vec3::Zero()), torque(force), bodies(at.bodies.size()) {
    add(at, {force, torque, nullptr, bodies});
  }
  /// What the derivatives of a flat index are of.
  const Vec3& main(std::size_t i) const {
    if (i < force.size()) return force[i];
    const Wrench& on = bodies[(i - force.size()) / 2];
    return (i - force.size()) % 2 == 0 ? on.force : on.torque;
  }
  bool differs(std::size_t i, const Load& other) const {
    return main(i) != other.main(i) || (i < torque.size() && torque[i] != other.torque[i]);
  }
  Vectors force, torque;
  std::vector<Wrench> bodies;
};

class Check {
 public:
  Check(const Force& force, const StateView& view, double step)
      : force_(force),
        at_(view),
        step_(step),
        base_(force, at_.seen),
        couplings_(force.couplings_with_bodies(view.rods, view.bodies.size())) {
    name(couplings_.pairs());
    if (couplings_.local()) {
      local_ = couplings_.local()(at_.seen);
      const std::set<Couplings::Pair> ever = std::move(named_);
      named_.clear();
      name(local_.pairs);
      for (const auto& pair : named_)
        if (ever.count(pair) == 0) found_.insert(pair);
    }
    for (std::size_t r = 0; r < view.rods.size(); ++r) rod_of_.resize(rod_of_.size() + view.rods[r].count, r);
  }

  ForceCheck run() {
    gather();
    note_torques(base_);
    compare_local(base_);
    for (std::size_t j = 0; j < at_.p.size(); ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        compare(j, axis, at_.p[j], at_.length, by_p_);
        compare(j, axis, at_.v[j], at_.speed, by_v_);
        note_frame(j, Vec3::Unit(axis));
      }
      at_.spin[j] += step_;
      note_turned(j, look());
      at_.spin[j] -= step_;
      at_.turn[j] += step_ * Vec3::Ones();
      note_turned(j, look());
      at_.turn[j] -= step_ * Vec3::Ones();
      if (force_.has_energy()) compare_energy(j);
    }
    for (std::size_t b = 0; b < at_.bodies.size(); ++b) compare_body(b);
    if (derivative_ > 0.0) out_.derivatives = error_ / derivative_;
    if (load_ > 0.0) out_.energy = energy_error_ / load_;
    if (most_ > 0.0) out_.local = local_error_ / most_;
    for (const auto& pair : found_) out_.undeclared.push_back(pair);
    return out_;
  }

 private:
  using Matrix = Eigen::MatrixXd;
  struct Gathered : LoadDerivatives {
    Gathered(Matrix& p, Matrix& v) : by_p(p), by_v(v) {}
    void add_by_position(std::size_t i, std::size_t j, const Mat3& k) override { block(by_p, i, j) += k; }
    void add_by_velocity(std::size_t i, std::size_t j, const Mat3& k) override { block(by_v, i, j) += k; }
    static Eigen::Block<Matrix, 3, 3> block(Matrix& m, std::size_t i, std::size_t j) {
      return m.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j));
    }
    Matrix &by_p, &by_v;
  };

  void name(const std::vector<Couplings::Pair>& pairs) {
    for (const auto& [a, b] : pairs) {
      named_.emplace(a, b);
      named_.emplace(b, a);
      named_.emplace(a, a);
      named_.emplace(b, b);
    }
  }

  void gather() {
    const auto size = 3 * static_cast<Eigen::Index>(at_.indices());
    by_p_ = by_v_ = Matrix::Zero(size, size);
    if (!couplings_.derivatives()) return;
    Gathered gathered(by_p_, by_v_);
    couplings_.derivatives()(at_.seen, gathered);
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = 0; j < size; ++j) {
        const double arm = arm_of(j / 3) / arm_of(i / 3);
        derivative_ = std::max(
            {derivative_, std::abs(by_p_(i, j)) * arm * at_.length, std::abs(by_v_(i, j)) * arm * at_.speed});
      }
  }

  /// What makes an angle a way over the longest edge, and a torque a force.
  double arm_of(Eigen::Index index) const {
    const auto n = static_cast<Eigen::Index>(at_.p.size());
    return index < n || (index - n) % 2 == 0 ? 1.0 : at_.length;
  }

  bool named(std::size_t i, std::size_t j) const {
    if (couplings_.reach() && std::max(i, j) < rod_of_.size() && rod_of_[i] == rod_of_[j] &&
        (i > j ? i - j : j - i) <= *couplings_.reach())
      return true;
    return named_.count({i, j}) > 0;
  }

  void note(std::size_t j, const Load& moved) {
    for (std::size_t i = 0; i < at_.indices(); ++i)
      if (!named(i, j) && moved.differs(i, base_)) found_.emplace(i, j);
  }

  /// As the frame of a node is moved.
  void note_turned(std::size_t j, const Load& moved) {
    note(j, moved);
    for (std::size_t i = 0; i < at_.indices() && !force_.acts_on_frames(); ++i)
      if (moved.differs(i, base_)) out_.frames = false;
    note_torques(moved);
  }
  void note_torques(const Load& load) {
    if (force_.acts_on_frames()) return;
    for (const Vec3& torque : load.torque) out_.frames = out_.frames && torque.isZero(0.0);
  }

  /// The loads as the state is moved.
  Load look() {
    Load whole(force_, at_.seen);
    compare_local(whole);
    return whole;
  }

  /// Holds what it says of states beside this one against its loads there.
  void compare_local(const Load& whole) {
    if (!local_.add) return;
    const Load said(local_.add, at_.seen);
    for (std::size_t i = 0; i < at_.indices(); ++i) {
      const double arm = arm_of(static_cast<Eigen::Index>(i));
      local_error_ = std::max(local_error_, (said.main(i) - whole.main(i)).norm() / arm);
      most_ = std::max(most_, whole.main(i).norm() / arm);
      if (i < whole.torque.size()) {
        local_error_ = std::max(local_error_, (said.torque[i] - whole.torque[i]).norm() / at_.length);
        most_ = std::max(most_, whole.torque[i].norm() / at_.length);
      }
    }
  }

  void compare(std::size_t j, int axis, Vec3& moved, double scale, const Matrix& exact) {
    const double at = moved[axis];
    compare(j, axis, scale, exact, [&](double h) { moved[axis] = at + h; });
  }

  /// Compares around a state that `move` moves by a number, back with 0.
  template <typename Move>
  void compare(std::size_t j, int axis, double scale, const Matrix& exact, const Move& move) {
    const double h = step_ * scale;
    move(h);
    const Load up = look();
    move(-h);
    const Load down = look();
    move(0.0);
    note(j, up);
    note(j, down);
    if (!couplings_.derivatives()) return;
    for (std::size_t i = 0; i < at_.indices(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Vec3 given = exact.block<3, 1>(3 * row, 3 * static_cast<Eigen::Index>(j) + axis);
      error_ = std::max(error_, ((up.main(i) - down.main(i)) / (2 * h) - given).norm() * scale / arm_of(row));
    }
  }

  /// A body is moved, turned, and its motions are.
  void compare_body(std::size_t b) {
    BodyView& body = at_.bodies[b];
    const std::size_t place = at_.p.size() + 2 * b;
    load_ = std::max({load_, base_.bodies[b].force.norm(), base_.bodies[b].torque.norm() / at_.length});
    for (int axis = 0; axis < 3; ++axis) {
      const Mat3 rotation = body.rotation;
      const auto turn = [&](double angle) {
        body.rotation = angle == 0.0 ? rotation : turned_by(Vec3::Unit(axis), angle, rotation);
      };
      const double x = body.position[axis];
      const auto shift = [&](double way) { body.position[axis] = x + way; };
      compare(place, axis, at_.length, by_p_, shift);
      compare(place, axis, body.velocity, at_.speed, by_v_);
      compare(place + 1, axis, 1.0, by_p_, turn);
      compare(place + 1, axis, body.spin, at_.speed / at_.length, by_v_);
      if (!force_.has_energy()) continue;
      compare_energy(shift, at_.length, base_.bodies[b].force[axis]);
      compare_energy(turn, 1.0, base_.bodies[b].torque[axis]);
    }
  }

  static Mat3 turned_by(const Vec3& axis, double angle, const Mat3& of) {
    Mat3 turned;
    for (int c = 0; c < 3; ++c) turned.col(c) = rotate_about(axis, angle, of.col(c));
    return turned;
  }

  /// Holds -dE by a move against the load that does work on it.
  template <typename Move>
  void compare_energy(const Move& move, double scale, double load) {
    move(step_ * scale);
    const double up = force_.energy(at_.seen);
    move(-step_ * scale);
    const double down = force_.energy(at_.seen);
    move(0.0);
    energy_error_ =
        std::max(energy_error_, std::abs((up - down) / (2 * step_ * scale) + load) * scale / at_.length);
  }

  /// Calls with the frame of a node turned about an axis by an angle.
  template <typename Call>
  void turned(std::size_t j, const Vec3& axis, double angle, const Call& call) {
    const Vec3 t = at_.t[j];
    const Vec3 m = at_.m[j];
    at_.t[j] = rotate_about(axis, angle, t);
    if (!m.isZero(0.0)) at_.m[j] = rotate_about(axis, angle, m);
    call();
    at_.t[j] = t;
    at_.m[j] = m;
  }

  void note_frame(std::size_t j, const Vec3& axis) {
    turned(j, axis, step_, [&] { note_turned(j, look()); });
  }

  void compare_energy(std::size_t j) {
    load_ = std::max({load_, base_.force[j].norm(), base_.torque[j].norm() / at_.length});
    for (int axis = 0; axis < 3; ++axis) {
      const double h = step_ * at_.length;
      const double at = at_.p[j][axis];
      at_.p[j][axis] = at + h;
      const double up = force_.energy(at_.seen);
      at_.p[j][axis] = at - h;
      const double down = force_.energy(at_.seen);
      at_.p[j][axis] = at;
      double ahead = 0.0;
      double back = 0.0;
      turned(j, Vec3::Unit(axis), step_, [&] { ahead = force_.energy(at_.seen); });
      turned(j, Vec3::Unit(axis), -step_, [&] { back = force_.energy(at_.seen); });
      energy_error_ = std::max({energy_error_, std::abs((up - down) / (2 * h) + base_.force[j][axis]),
                                std::abs((ahead - back) / (2 * step_) + base_.torque[j][axis]) / at_.length});
    }
  }

  const Force& force_;
  Movable at_;
  double step_;
  Load base_;
  Couplings couplings_;
  LocalCouplings local_;
  std::set<Couplings::Pair> named_, found_;
  std::vector<std::size_t> rod_of_;
  Matrix by_p_, by_v_;
  double derivative_ = 0.0, error_ = 0.0, load_ = 0.0, energy_error_ = 0.0;
  double local_error_ = 0.0, most_ = 0.0;
  ForceCheck out_;
};

}  // namespace

ForceCheck check_force(const Force& force, const StateView& state, double step) {
  return Check(force, state, step).run();
}

}  // namespace tendril
