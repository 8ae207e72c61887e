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
        spin(view.spin.begin(), view.spin.end()) {
    seen.p = p;
    seen.v = v;
    seen.t = t;
    seen.m = m;
    seen.spin = spin;
    for (const NodeRange& rod : view.rods)
      for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i)
        length = std::max(length, (p[i + 1] - p[i]).norm());
    speed = length;
    for (const Vec3& one : v) speed = std::max(speed, one.norm());
  }

  StateView seen;
  Vectors p, v, t, m;
  std::vector<double> spin;
  double length = 0.0, speed = 0.0;
};

struct Load {
  Load(const Force& of, const StateView& at) : force(at.p.size(), Vec3::Zero()), torque(force) {
    of.add(at, {force, torque});
  }
  Vectors force, torque;
};

class Check {
 public:
  Check(const Force& force, const StateView& view, double step)
      : force_(force),
        at_(view),
        step_(step),
        base_(force, at_.seen),
        couplings_(force.couplings(view.rods)) {
    for (const auto& [a, b] : couplings_.pairs()) {
      named_.emplace(a, b);
      named_.emplace(b, a);
      named_.emplace(a, a);
      named_.emplace(b, b);
    }
    for (std::size_t r = 0; r < view.rods.size(); ++r) rod_of_.resize(rod_of_.size() + view.rods[r].count, r);
  }

  ForceCheck run() {
    gather();
    for (std::size_t j = 0; j < at_.p.size(); ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        compare(j, axis, at_.p[j], step_ * at_.length, by_p_);
        compare(j, axis, at_.v[j], step_ * at_.speed, by_v_);
        note_frame(j, Vec3::Unit(axis));
      }
      at_.spin[j] += step_;
      note(j, Load(force_, at_.seen));
      at_.spin[j] -= step_;
      if (force_.has_energy()) compare_energy(j);
    }
    if (derivative_ > 0.0) out_.derivatives = error_ / derivative_;
    if (load_ > 0.0) out_.energy = energy_error_ / load_;
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

  void gather() {
    const auto size = 3 * static_cast<Eigen::Index>(at_.p.size());
    by_p_ = by_v_ = Matrix::Zero(size, size);
    if (!couplings_.derivatives()) return;
    Gathered gathered(by_p_, by_v_);
    couplings_.derivatives()(at_.seen, gathered);
    derivative_ = std::max(by_p_.cwiseAbs().maxCoeff() * at_.length, by_v_.cwiseAbs().maxCoeff() * at_.speed);
  }

  bool named(std::size_t i, std::size_t j) const {
    if (couplings_.reach() && rod_of_[i] == rod_of_[j] && (i > j ? i - j : j - i) <= *couplings_.reach())
      return true;
    return named_.count({i, j}) > 0;
  }

  void note(std::size_t j, const Load& moved) {
    for (std::size_t i = 0; i < at_.p.size(); ++i)
      if (!named(i, j) && (moved.force[i] != base_.force[i] || moved.torque[i] != base_.torque[i]))
        found_.emplace(i, j);
  }

  void compare(std::size_t j, int axis, Vec3& moved, double h, const Matrix& exact) {
    const double at = moved[axis];
    moved[axis] = at + h;
    const Load up(force_, at_.seen);
    moved[axis] = at - h;
    const Load down(force_, at_.seen);
    moved[axis] = at;
    note(j, up);
    note(j, down);
    if (!couplings_.derivatives()) return;
    const double scale = h / step_;
    for (std::size_t i = 0; i < at_.p.size(); ++i) {
      const Vec3 given =
          exact.block<3, 1>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j) + axis);
      error_ = std::max(error_, ((up.force[i] - down.force[i]) / (2 * h) - given).norm() * scale);
    }
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
    turned(j, axis, step_, [&] { note(j, Load(force_, at_.seen)); });
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
  std::set<Couplings::Pair> named_, found_;
  std::vector<std::size_t> rod_of_;
  Matrix by_p_, by_v_;
  double derivative_ = 0.0, error_ = 0.0, load_ = 0.0, energy_error_ = 0.0;
  ForceCheck out_;
};

}  // namespace

ForceCheck check_force(const Force& force, const StateView& state, double step) {
  return Check(force, state, step).run();
}

}  // namespace tendril
