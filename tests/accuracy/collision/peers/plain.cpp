#include <algorithm>

#include "accuracy/collision/adapter.h"

/// What is commonly done about features that move: roots of the determinant from its changes of sign on a
/// net of times, halved, and a test of the inside there, without any bound on rounding.
namespace tendril::suite {
namespace {

using collision::Features;
using collision::Paths;

template <int Degree>
Vec3 at(const std::array<Vec3, Degree + 1>& path, double t) {
  std::array<Vec3, Degree + 1> p = path;
  for (int level = Degree; level > 0; --level)
    for (int i = 0; i < level; ++i) p[i] += t * (p[i + 1] - p[i]);
  return p[0];
}

template <int Degree>
class Solver {
 public:
  Solver(Features features, const Paths<Degree>& paths)
      : edges_(features == Features::edge_edge), paths_(paths) {}

  bool meet() {
    constexpr int kSteps = Degree == 1 ? 8 : 24;
    double before = volume(0.0);
    for (int i = 0; i < kSteps; ++i) {
      const double after = volume((i + 1.0) / kSteps);
      if (before * after <= 0.0) {
        halve(i / (1.0 * kSteps), (i + 1.0) / kSteps, before);
        if (inside()) return true;
      }
      before = after;
    }
    return false;
  }

 private:
  double volume(double t) {
    const Vec3 first = at<Degree>(paths_[0], t);
    for (std::size_t i = 0; i < 3; ++i) d_[i] = at<Degree>(paths_[i + 1], t) - first;
    return d_[0].dot(d_[1].cross(d_[2]));
  }
  void halve(double low, double high, double before) {
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (low + high);
      (volume(middle) * before > 0.0 ? low : high) = middle;
    }
    volume(high);
  }
  bool inside() const {
    const Vec3 normal = edges_ ? d_[0].cross(d_[2] - d_[1]) : Vec3((d_[1] - d_[0]).cross(d_[2] - d_[0]));
    const double w1 = normal.dot(d_[1].cross(d_[2])), w2 = normal.dot(d_[2].cross(d_[0])),
                 w3 = normal.dot(d_[0].cross(d_[1]));
    return edges_ ? std::min({w1, -w2, -w3, -(w1 + w2 + w3)}) >= 0 : std::min({w1, w2, w3}) >= 0;
  }

  bool edges_;
  const Paths<Degree>& paths_;
  std::array<Vec3, 3> d_;
};

}  // namespace

Adapter plain_adapter() {
  Adapter out{"plain solver"};
  out.straight = [](Features features, const Paths<1>& paths) -> Said {
    return Solver<1>(features, paths).meet();
  };
  out.cubic = [](Features features, const Paths<3>& paths) -> Said {
    return Solver<3>(features, paths).meet();
  };
  return out;
}

}  // namespace tendril::suite
