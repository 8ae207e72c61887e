#include "statics_tangent.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace tendril {
namespace {

constexpr double kRounding = 1e-16;  // of an eigenvalue, over the largest row sum
constexpr double kNeutral = 1e-8;    // of an eigenvalue, over B / l
constexpr double kSoft = 1e-13;      // of a pivot, over its diagonal entry
constexpr Eigen::Index kFill = 4;    // entries of a factor over those of the tangent: more are avoided
constexpr int kIterations = 200;     // of the power of the inverse
constexpr double kSettled = 1e-12;   // change of the eigenvalue at which they end

/// Numbers in [-1, 1) without a pattern, the same everywhere [Steele et al. 2014].
Eigen::VectorXd scattered(Eigen::Index size) {
  Eigen::VectorXd v(size);
  std::uint64_t state = 1;
  for (double& x : v) {
    state += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    x = static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-52 - 1.0;
  }
  return v;
}

/// Entries below the diagonal of the factor of a symmetric matrix, of which the lower triangle is given, by
/// the rows' subtrees of the elimination tree [Liu 1990]. Counted up to `most`.
Eigen::Index entries_of_factor(const Eigen::SparseMatrix<double>& lower, Eigen::Index most) {
  const Eigen::SparseMatrix<double> upper = lower.transpose();
  std::vector<Eigen::Index> parent(static_cast<std::size_t>(upper.cols()), -1), seen = parent;
  Eigen::Index entries = 0;
  for (Eigen::Index k = 0; k < upper.cols() && entries <= most; ++k) {
    seen[static_cast<std::size_t>(k)] = k;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(upper, k); entry; ++entry)
      for (auto i = static_cast<std::size_t>(entry.row()); seen[i] != k;
           i = static_cast<std::size_t>(parent[i])) {
        seen[i] = k;
        if (parent[i] < 0) parent[i] = k;
        ++entries;
      }
  }
  return entries;
}

/// A shift that leaves no eigenvalue below 0, at most four times as large as needed.
double lifting(StaticTangent& tangent, double threshold) {
  double shift = threshold;
  for (int i = 0; i < 200; ++i, shift *= 4)
    if (tangent.factorise(shift) && tangent.negative() == 0) return shift;
  return shift;
}

}  // namespace

void StaticTangent::set(const Eigen::SparseMatrix<double>& k, bool symmetric) {
  symmetric_ = symmetric;
  analysed_ = false;
  root_ = weight_.cwiseSqrt();
  s_ = k;
  diagonal_.setZero(s_.cols());
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(s_.cols());
  for (Eigen::Index c = 0; c < s_.cols(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(s_, c); entry; ++entry) {
      entry.valueRef() /= root_[entry.row()] * root_[c];
      sums[entry.row()] += std::abs(entry.value());
      if (symmetric_ && entry.row() != c) sums[c] += std::abs(entry.value());
      if (entry.row() == c) diagonal_[c] = entry.value();
    }
  rounding_ = sums.size() > 0 ? kRounding * sums.maxCoeff() : 0.0;
}

void StaticTangent::order() {
  order_.resize(0);
  if (entries_of_factor(s_, kFill * s_.nonZeros()) > kFill * s_.nonZeros()) {
    const Eigen::SparseMatrix<double> whole = s_.selfadjointView<Eigen::Lower>();
    Eigen::PermutationMatrix<Eigen::Dynamic> back;
    Eigen::AMDOrdering<int>()(whole, back);
    order_ = back.inverse();
    ordered_.resize(s_.rows(), s_.cols());
    ordered_.selfadjointView<Eigen::Lower>() = s_.selfadjointView<Eigen::Lower>().twistedBy(order_);
    diagonal_ = order_ * diagonal_;
  }
  ldlt_.analyzePattern(order_.size() > 0 ? ordered_ : s_);
  analysed_ = true;
}

bool StaticTangent::factorise(double shift) {
  ++factorisations;
  shift_ = shift;
  // Neither of Eigen's factorisations may be handed, nor solve with, what is not finite.
  factorised_ = finite() && std::isfinite(shift) && factorise_finite();
  return factorised_;
}

bool StaticTangent::factorise_finite() {
  if (symmetric_) {
    if (!analysed_) order();
    ldlt_.setShift(shift_);
    ldlt_.factorize(order_.size() > 0 ? ordered_ : s_);
    return ldlt_.info() == Eigen::Success && ldlt_.vectorD().allFinite();
  }
  Eigen::SparseMatrix<double> unit(s_.rows(), s_.cols());
  unit.setIdentity();
  const Eigen::SparseMatrix<double> shifted = s_ + shift_ * unit;
  lu_.compute(shifted);
  return lu_.info() == Eigen::Success;
}

bool StaticTangent::finite() const {
  return Eigen::Map<const Eigen::VectorXd>(s_.valuePtr(), s_.nonZeros()).allFinite();
}

int StaticTangent::negative() const {
  return symmetric_ ? static_cast<int>((ldlt_.vectorD().array() < 0.0).count()) : 0;
}

bool StaticTangent::soft() const {
  if (!symmetric_) return false;
  const auto& d = ldlt_.vectorD();
  for (Eigen::Index i = 0; i < d.size(); ++i)
    if (std::abs(d[i]) < kSoft * std::abs(diagonal_[i] + shift_)) return true;
  return false;
}

Eigen::VectorXd StaticTangent::solve_scaled(const Eigen::VectorXd& b) const {
  if (!factorised_ || !b.allFinite())
    return Eigen::VectorXd::Constant(b.size(), std::numeric_limits<double>::quiet_NaN());
  if (!symmetric_) return lu_.solve(b);
  if (order_.size() == 0) return ldlt_.solve(b);
  return order_.inverse() * Eigen::VectorXd(ldlt_.solve(Eigen::VectorXd(order_ * b)));
}

Eigen::VectorXd StaticTangent::solve(const Eigen::VectorXd& b) const {
  return solve_scaled(b.cwiseQuotient(root_)).cwiseQuotient(root_);
}

Eigen::VectorXd StaticTangent::solve_but_neutral(const Eigen::VectorXd& b) const {
  Eigen::VectorXd v = solve_scaled(b.cwiseQuotient(root_));
  for (int i = 0; i < 2; ++i) v -= shift_ * solve_scaled(v);
  return v.cwiseQuotient(root_);
}

Eigen::VectorXd StaticTangent::times(const Eigen::VectorXd& v) const {
  return s_.selfadjointView<Eigen::Lower>() * v;
}

double neutral_threshold(const StaticCoordinates& coordinates, const StaticTangent& tangent) {
  return std::max(kNeutral * coordinates.energy_scale(), tangent.rounding());
}

LowestMode lowest_mode(StaticTangent& tangent, double threshold) {
  lifting(tangent, threshold);
  LowestMode mode;
  Eigen::VectorXd v = scattered(tangent.root().size()).normalized();
  double last = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    v = tangent.solve_scaled(v).normalized();
    mode.value = v.dot(tangent.times(v));
    if (i > 3 && std::abs(mode.value - last) <= kSettled * std::max(std::abs(mode.value), threshold)) break;
    last = mode.value;
  }
  mode.x = v.cwiseQuotient(tangent.root());
  return mode;
}

Stability analyse(const StaticCoordinates& coordinates, StaticTangent& tangent, double unbalanced) {
  Stability out;
  if (coordinates.size() == 0) {
    out.kind = Stability::Kind::stable;
    return out;
  }
  out.threshold = std::max(neutral_threshold(coordinates, tangent), unbalanced);
  tangent.factorise(out.threshold);
  out.unstable = tangent.negative();
  tangent.factorise(-out.threshold);
  out.neutral = tangent.negative() - out.unstable;
  const LowestMode mode = lowest_mode(tangent, out.threshold);
  out.smallest = mode.value;
  out.kind = out.unstable > 0  ? Stability::Kind::unstable
             : out.neutral > 0 ? Stability::Kind::neutral
                               : Stability::Kind::stable;
  return out;
}

}  // namespace tendril
