#include "gltf/fit.h"

#include "gltf/weights.h"

#include <algorithm>
#include <limits>

namespace tendril::runner {

SkinFit::SkinFit(const Film& film, std::span<const std::size_t> moments)
    : film_(film), exact_(film.mesh().points.size() * moments.size()), alone_(film.rest().size()) {
  for (std::size_t m = 0; m < moments.size(); ++m) {
    posed_.push_back(film.posed(moments[m]));
    const std::vector<Vec3> points = film.points(moments[m]);
    for (std::size_t i = 0; i < points.size(); ++i) exact_[i * moments.size() + m] = points[i];
  }
  const auto records = film.binding().records();
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    if (std::binary_search(film.still().begin(), film.still().end(), i)) continue;
    std::vector<bind::Share> shares = film.binding().shares(i);
    if (shares.size() == 1) {
      alone_[shares[0].pair].push_back(i);
    } else {
      blended_.push_back(i);
      shares_.push_back(std::move(shares));
    }
  }
  for (auto& points : alone_)
    std::stable_sort(points.begin(), points.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return records[a].t < records[b].t; });
}

SkinFit::Motions SkinFit::motions(const SkinJoint& joint) const {
  Motions out;
  for (const auto& posed : posed_) out.push_back(motion_of(joint, film_.rest(), posed));
  return out;
}

/// Whether the two joints and weights linear between them carry all that is bound to what is between. Those
/// halfway are tried first: they err the most.
bool SkinFit::serves(const SkinJoint& from, const Motions& a, double to, double tolerance) const {
  const auto records = film_.binding().records();
  const auto& points = alone_[from.pair];
  const auto at = [&](double t) {
    const auto before = [&](std::uint32_t i, double value) { return records[i].t < value; };
    return std::lower_bound(points.begin(), points.end(), t, before) - points.begin();
  };
  const auto first = at(from.t), middle = at(0.5 * (from.t + to)), last = at(to);
  const Motions b = motions({from.pair, to});
  const auto off = [&](std::uint32_t i) {
    const double part = (records[i].t - from.t) / (to - from.t);
    const Vec3& x = film_.mesh().points[i];
    for (std::size_t m = 0; m < posed_.size(); ++m)
      if (((1.0 - part) * a[m](x) + part * b[m](x) - exact_[i * posed_.size() + m]).norm() > tolerance)
        return true;
    return false;
  };
  return std::none_of(points.begin() + middle, points.begin() + last, off) &&
         std::none_of(points.begin() + first, points.begin() + middle, off);
}

/// Where the next joint may be at the most.
double SkinFit::farthest(const SkinJoint& from, double tolerance) const {
  constexpr int kHalvings = 16;
  const double end = film_.rest()[from.pair].knots().end();
  const Motions a = motions(from);
  if (serves(from, a, end, tolerance)) return end;
  double good = from.t, bad = end;
  for (int k = 0; k < kHalvings; ++k) {
    const double t = 0.5 * (good + bad);
    (serves(from, a, t, tolerance) ? good : bad) = t;
  }
  return good > from.t ? good : bad;
}

/// Gives up, with more joints than asked for, once there are.
std::vector<SkinJoint> SkinFit::place(double tolerance, std::size_t max_joints) const {
  std::vector<SkinJoint> out;
  for (std::uint32_t pair = 0; pair < film_.rest().size(); ++pair) {
    const KnotVector& knots = film_.rest()[pair].knots();
    out.push_back({pair, knots.start()});
    while (out.back().t < knots.end() && out.size() <= max_joints)
      out.push_back({pair, farthest(out.back(), tolerance)});
  }
  if (!film_.still().empty()) out.push_back({SkinJoint::kStill, 0.0});
  return out;
}

/// The tolerance is raised until there are no more joints than allowed.
std::vector<SkinJoint> SkinFit::place_within(double& tolerance, std::size_t max_joints) const {
  std::vector<SkinJoint> out = place(tolerance, max_joints);
  while (out.size() > max_joints) out = place(tolerance *= 1.5, max_joints);
  return out;
}

SkinFit::Rig SkinFit::rig(std::vector<SkinJoint> joints) const {
  Rig out;
  out.joints = std::move(joints);
  for (std::size_t k = 0; k < out.joints.size(); ++k) {
    if (k == 0 || out.joints[k].pair != out.joints[k - 1].pair) out.begin.push_back(k);
    out.motions.push_back(motions(out.joints[k]));
  }
  out.begin.push_back(out.joints.size());
  return out;
}

Influences SkinFit::beside(const Rig& rig, std::uint32_t pair, double t) {
  const auto first = rig.joints.begin() + static_cast<std::ptrdiff_t>(rig.begin[pair]);
  const auto last = rig.joints.begin() + static_cast<std::ptrdiff_t>(rig.begin[pair + 1]);
  const auto right = std::upper_bound(first + 1, last - 1, t,
                                      [](double value, const SkinJoint& joint) { return value < joint.t; });
  const auto k = static_cast<std::size_t>(right - rig.joints.begin());
  const double part = std::clamp((t - rig.joints[k - 1].t) / (right->t - rig.joints[k - 1].t), 0.0, 1.0);
  Influences out;
  out.add(k - 1, 1.0 - part);
  out.add(k, part);
  return out;
}

double SkinFit::error_of(const Rig& rig, std::size_t point, const Influences& influences) const {
  const Vec3& x = film_.mesh().points[point];
  double worst = 0.0;
  for (std::size_t m = 0; m < posed_.size(); ++m) {
    Vec3 sum = -exact_[point * posed_.size() + m];
    for (std::size_t k = 0; k < 4; ++k)
      if (influences.weight[k] > 0.0) sum += influences.weight[k] * rig.motions[influences.joint[k]][m](x);
    worst = std::max(worst, sum.norm());
  }
  return worst;
}

/// The joints beside the places that a point is bound to.
std::vector<std::uint16_t> SkinFit::near(const Rig& rig, std::size_t blended) const {
  std::vector<std::uint16_t> out;
  for (const bind::Share& share : shares_[blended]) {
    const Influences two = beside(rig, share.pair, share.record.t);
    for (std::size_t k = 0; k < 4; ++k)
      if (two.weight[k] > 0.0) out.push_back(two.joint[k]);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// By least squares; where that leaves a moment too far off, with the moments weighted by how far off they
/// are, again and again, which tends to the least largest distance [Lawson 1961].
Influences SkinFit::best_four(const Rig& rig, std::size_t blended, double tolerance) const {
  constexpr int kRounds = 8;
  const std::vector<std::uint16_t> joints = near(rig, blended);
  const std::size_t point = blended_[blended], moments = posed_.size();
  Eigen::MatrixXd off(static_cast<Eigen::Index>(3 * moments), static_cast<Eigen::Index>(joints.size()));
  for (std::size_t c = 0; c < joints.size(); ++c)
    for (std::size_t m = 0; m < moments; ++m)
      off.col(static_cast<Eigen::Index>(c)).segment<3>(static_cast<Eigen::Index>(3 * m)) =
          rig.motions[joints[c]][m](film_.mesh().points[point]) - exact_[point * moments + m];
  Influences best;
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd weight = Eigen::VectorXd::Constant(off.rows(), 1.0);
  for (int round = 0; round < kRounds && least > tolerance; ++round) {
    Influences now;
    Eigen::VectorXd left = Eigen::VectorXd::Zero(off.rows());
    for (const auto& [column, part] : convex_weights(off.transpose() * weight.asDiagonal() * off, 4)) {
      now.add(joints[column], part);
      left += part * off.col(static_cast<Eigen::Index>(column));
    }
    double worst = 0.0;
    for (Eigen::Index m = 0; m < left.size(); m += 3) {
      const double distance = left.segment<3>(m).norm();
      worst = std::max(worst, distance);
      weight.segment<3>(m) *= distance;
    }
    if (worst < least) least = worst, best = now;
    weight /= std::max(weight.maxCoeff(), std::numeric_limits<double>::min());
  }
  return best;
}

std::vector<Influences> SkinFit::weigh(const Rig& rig, double tolerance) const {
  std::vector<Influences> out(film_.mesh().points.size());
  const auto records = film_.binding().records();
  for (std::uint32_t pair = 0; pair < alone_.size(); ++pair)
    for (const std::uint32_t i : alone_[pair]) out[i] = beside(rig, pair, records[i].t);
  for (std::size_t b = 0; b < blended_.size(); ++b) out[blended_[b]] = best_four(rig, b, tolerance);
  for (const std::size_t i : film_.still()) out[i].add(rig.joints.size() - 1, 1.0);
  return out;
}

/// The joints with some more, halfway between two, where the places are that points too far off are bound
/// to.
std::vector<SkinJoint> SkinFit::added(const Rig& rig, const std::vector<double>& errors, double tolerance,
                                      std::size_t room) const {
  std::vector<std::pair<double, std::size_t>> score;  // of the interval before each joint
  for (std::size_t k = 0; k < rig.joints.size(); ++k) score.emplace_back(0.0, k);
  for (std::size_t b = 0; b < blended_.size(); ++b) {
    if (errors[b] <= tolerance) continue;
    for (const bind::Share& share : shares_[b]) {
      const Influences two = beside(rig, share.pair, share.record.t);
      if (two.weight[1] > 0.0) score[two.joint[1]].first += share.weight * errors[b];
    }
  }
  std::sort(score.rbegin(), score.rend());
  std::vector<SkinJoint> out = rig.joints;
  const std::size_t some = std::min(room, 1 + rig.joints.size() / 8);
  for (std::size_t k = 0; k < std::min(some, score.size()) && score[k].first > 0.0; ++k) {
    const SkinJoint &left = rig.joints[score[k].second - 1], &right = rig.joints[score[k].second];
    out.push_back({left.pair, 0.5 * (left.t + right.t)});
  }
  std::sort(out.begin(), out.end(), [](const SkinJoint& a, const SkinJoint& b) {
    return a.pair != b.pair ? a.pair < b.pair : a.t < b.t;
  });
  return out;
}

/// Joints are added until all is within the tolerance, or for as long as that helps.
Skin SkinFit::skin(double tolerance, std::size_t max_joints) const {
  constexpr int kPatience = 3;
  constexpr double kHelps = 0.95;
  double placed = tolerance;
  Rig now = rig(place_within(placed, max_joints));
  Skin best;
  double least = std::numeric_limits<double>::infinity();
  for (int idle = 0; idle < kPatience; ++idle) {
    const std::vector<Influences> influences = weigh(now, tolerance);
    std::vector<double> errors;
    for (const std::uint32_t i : blended_) errors.push_back(error_of(now, i, influences[i]));
    const double worst = errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end());
    if (worst < kHelps * least || worst <= tolerance) {
      least = worst, idle = 0;
      best = {now.joints, influences, 0.0, worst <= tolerance && placed <= tolerance};
    }
    if (worst <= tolerance) break;
    std::vector<SkinJoint> more = added(now, errors, tolerance, max_joints - now.joints.size());
    if (more.size() == now.joints.size()) break;
    now = rig(std::move(more));
  }
  return best;
}

}  // namespace tendril::runner
