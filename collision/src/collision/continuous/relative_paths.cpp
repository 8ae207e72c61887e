#include "relative_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "closest_direction.h"

namespace tendril::collision {
namespace {

constexpr double unit = 0x1p-52;
/// P of the header: how many roundings a coordinate of a point at a time has gone through.
template <int Degree>
constexpr double roundings = 1 + 3 * Degree;
/// u times a count of roundings: a bound of g(count - 1).
constexpr double relative(double count) {
  return (count + 2) * unit;
}

template <int Degree>
double largest_coordinate(const Paths<Degree>& paths) {
  double largest = 0.0;
  for (const auto& path : paths)
    for (const Vec3& p : path) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

template <int Degree>
bool all_finite(const Paths<Degree>& paths) {
  bool finite = true;
  for (const auto& path : paths)
    for (const Vec3& p : path) finite = finite && p.allFinite();
  return finite;
}

/// A power of two by which coordinates are multiplied so that their products stay in range; exact but
/// for what underflows, which the bounds of the header count.
double scale_for(double largest) {
  if (largest == 0.0 || (largest > 0x1p-200 && largest < 0x1p200)) return 1.0;
  return std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1020, 1020));
}

void blend(const Nine& a, const Nine& b, double t, Nine& out) {
  const double s = 1.0 - t;
  for (int k = 0; k < 9; ++k) out[k] = s * a[k] + t * b[k];
}

double minor(const Nine& a, int first, const Nine& b, int second, int x, int y) {
  return a[3 * first + x] * b[3 * second + y] - a[3 * first + y] * b[3 * second + x];
}

/// Bernstein coefficients of a minor of d_first and d_second, rows x and y.
template <int Degree>
std::array<double, 2 * Degree + 1> minor_of(const TimeInterval<Degree>& on, int first, int second, int x,
                                            int y) {
  std::array<double, 2 * Degree + 1> sum{};
  for (int i = 0; i <= Degree; ++i)
    for (int j = 0; j <= Degree; ++j)
      sum[i + j] +=
          product_weights<Degree, Degree>[i][j] * minor(on.control[i], first, on.control[j], second, x, y);
  return sum;
}

/// 1 or -1 where all coefficients have that sign for sure, else 0.
template <std::size_t Count>
int common_sign(const std::array<double, Count>& c, double error) {
  double least = c[0], most = c[0];
  for (const double x : c) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
  return least > error ? 1 : (most < -error ? -1 : 0);
}

/// A minor is a projection along an axis: along the longest part of the normal the features are seen least
/// foreshortened, and the signs are farthest from rounding.
/// \return  the axis along which the features' common normal is longest.
int normal_axis(Features features, const Nine& place) {
  const Vec3 along = vector(place, 2) - vector(place, 1);
  const Vec3 other =
      features == Features::edge_edge ? Vec3(vector(place, 0)) : vector(place, 1) - vector(place, 0);
  Eigen::Index axis = 0;
  other.cross(along).cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

}  // namespace

template <int Degree>
RelativePaths<Degree>::RelativePaths(const Paths<Degree>& paths) : finite_(all_finite<Degree>(paths)) {
  if (!finite_) return;
  scale_ = scale_for(largest_coordinate<Degree>(paths));
  for (int i = 0; i <= Degree; ++i)
    for (int which = 0; which < 3; ++which)
      for (int k = 0; k < 3; ++k) {
        const double d = scale_ * paths[which + 1][i][k] - scale_ * paths[0][i][k];
        control_[i][3 * which + k] = d;
        if (d != 0.0) size_of_(k, which) = std::max({size_of_(k, which), std::abs(d), 0x1p-300});
      }
  size_along_ = size_of_.rowwise().maxCoeff();
  permanent_ = 0.0;
  for (int k = 0; k < 3; ++k) permanent_ += size_of_(k, 0) * minor_size(1, 2, (k + 1) % 3, (k + 2) % 3);
}

/// The sum of the sizes of the two products in a minor.
template <int Degree>
double RelativePaths<Degree>::minor_size(int first, int second, int x, int y) const {
  return size_of_(x, first) * size_of_(y, second) + size_of_(y, first) * size_of_(x, second);
}

template <int Degree>
Instant RelativePaths<Degree>::at(double time) const {
  Instant at;
  at.time = time;
  if constexpr (Degree == 1) {
    blend(control_[0], control_[1], time, at.place);
  } else {
    Nine a, b, c;
    blend(control_[0], control_[1], time, a);
    blend(control_[1], control_[2], time, b);
    blend(control_[2], control_[3], time, c);
    blend(a, b, time, at.row[0]);
    blend(b, c, time, at.row[1]);
    blend(at.row[0], at.row[1], time, at.place);
  }
  at.side = side_at(at.place);
  return at;
}

/// The error of a determinant, six terms of three numbers: at most g(3 P + 5) times the permanent.
template <int Degree>
int RelativePaths<Degree>::side_at(const Nine& p) const {
  const double value =
      p[0] * minor(p, 1, p, 2, 1, 2) + p[1] * minor(p, 1, p, 2, 2, 0) + p[2] * minor(p, 1, p, 2, 0, 1);
  const double error = relative(3 * roundings<Degree> + 5) * permanent_;
  return value > error ? 1 : (value < -error ? -1 : 0);
}

/// The points between are the cubic's blossom at (from, from, to) and (to, to, from): made from the original
/// ones, so that no error is handed down from piece to piece.
template <int Degree>
TimeInterval<Degree> RelativePaths<Degree>::interval(const Instant& from, const Instant& to) const {
  TimeInterval<Degree> on{from, to, {}};
  on.control.front() = from.place;
  on.control.back() = to.place;
  if constexpr (Degree == 3) {
    blend(from.row[0], from.row[1], to.time, on.control[1]);
    blend(to.row[0], to.row[1], from.time, on.control[2]);
  }
  return on;
}

template <int Degree>
template <Features features>
bool RelativePaths<Degree>::apart_along(const TimeInterval<Degree>& on, const Vec3& n) const {
  const double size = n.cwiseAbs().dot(size_along_);
  if (!(size > 0x1p-900)) return false;
  const double error = 2 * relative(roundings<Degree> + 4) * size;
  double least = std::numeric_limits<double>::infinity();
  for (const Nine& c : on.control) {
    const double first = n.dot(vector(c, 0));
    const double others = std::min(n.dot(vector(c, 1)), n.dot(vector(c, 2)));
    least = std::min(
        least, features == Features::vertex_face ? std::min(first, others) : others - std::max(first, 0.0));
  }
  return least > error;
}

template <int Degree>
bool RelativePaths<Degree>::apart(Features features, const TimeInterval<Degree>& on,
                                  const Instant& middle) const {
  return features == Features::vertex_face
             ? apart_along<Features::vertex_face>(on, vertex_face_direction(middle))
             : apart_along<Features::edge_edge>(on, edge_edge_direction(middle));
}

template <int Degree>
bool RelativePaths<Degree>::weights_keep_sign(Features features, const TimeInterval<Degree>& on,
                                              const Instant& middle) const {
  const int axis = normal_axis(features, middle.place);
  const int x = (axis + 1) % 3;
  const int y = (axis + 2) % 3;
  const auto w1 = minor_of(on, 1, 2, x, y);
  const auto w2 = minor_of(on, 2, 0, x, y);
  const auto w3 = minor_of(on, 0, 1, x, y);
  const Vec3 size(minor_size(1, 2, x, y), minor_size(2, 0, x, y), minor_size(0, 1, x, y));
  const Vec3 error = relative(2 * roundings<Degree> + 10) * size;
  const int sign = common_sign(w1, error[0]);
  if (features == Features::vertex_face)
    return sign != 0 && common_sign(w2, error[1]) == sign && common_sign(w3, error[2]) == sign;
  if (sign == 0 || common_sign(w2, error[1]) != -sign || common_sign(w3, error[2]) != -sign) return false;
  auto sum = w1;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += w2[i] + w3[i];
  return common_sign(sum, error.sum()) == -sign;
}

template <int Degree>
std::array<double, 3 * Degree + 1> RelativePaths<Degree>::determinant(const TimeInterval<Degree>& on) const {
  std::array<double, 3 * Degree + 1> sum{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto cross = minor_of(on, 1, 2, (axis + 1) % 3, (axis + 2) % 3);
    for (int i = 0; i <= Degree; ++i)
      for (int j = 0; j <= 2 * Degree; ++j)
        sum[i + j] += product_weights<Degree, 2 * Degree>[i][j] * (on.control[i][axis] * cross[j]);
  }
  return sum;
}

template <int Degree>
double RelativePaths<Degree>::coefficient_error() const {
  return relative(3 * roundings<Degree> + 18) * permanent_;
}

template <int Degree>
bool RelativePaths<Degree>::has_one_root(const std::array<double, 3 * Degree + 1>& c) const {
  const double error = coefficient_error();
  const double sign = c.front() > 0.0 ? 1.0 : -1.0;
  // Sure signs from either end; what is left between them may be of either sign, or zero.
  std::size_t before = 0;
  while (before < c.size() && sign * c[before] > error) ++before;
  std::size_t after = c.size();
  while (after > 0 && sign * c[after - 1] < -error) --after;
  return before > 0 && after < c.size() && after <= before + 1;
}

template class RelativePaths<1>;
template class RelativePaths<3>;

}  // namespace tendril::collision
