#include "scene/motion/table.h"

#include <algorithm>

namespace tendril::scene {
namespace {

/// Slopes m_i of the spline: continuity of the second derivative at inner times,
/// m_(i-1) / h_i + 2 m_i (1 / h_i + 1 / h_(i+1)) + m_(i+1) / h_(i+1) = 3 (d_i / h_i + d_(i+1) / h_(i+1)),
/// with d the divided differences; 0 at both ends. Solved by elimination without pivots: the rows are
/// diagonally dominant.
std::vector<Vec3> slopes_of(const std::vector<double>& t, const std::vector<Vec3>& y) {
  const std::size_t n = t.size();
  std::vector<Vec3> m(n, Vec3::Zero());
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = 1.0 / (t[i] - t[i - 1]), after = 1.0 / (t[i + 1] - t[i]);
    const Vec3 right = 3.0 * (before * before * (y[i] - y[i - 1]) + after * after * (y[i + 1] - y[i]));
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    m[i] = (right - before * m[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] -= upper[i] * m[i + 1];
  return m;
}

}  // namespace

TimeTable::TimeTable(std::vector<double> times, std::vector<Vec3> values)
    : times_(std::move(times)), values_(std::move(values)), slopes_(slopes_of(times_, values_)) {}

std::size_t TimeTable::interval(double t) const {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  return static_cast<std::size_t>(after - times_.begin()) - 1;
}

Vec3 TimeTable::value(double t) const {
  if (t <= times_.front()) return values_.front();
  if (t >= times_.back()) return values_.back();
  const std::size_t i = interval(t);
  const double h = times_[i + 1] - times_[i], s = (t - times_[i]) / h, r = 1.0 - s;
  return r * r * (1.0 + 2.0 * s) * values_[i] + s * s * (3.0 - 2.0 * s) * values_[i + 1] +
         h * s * r * (r * slopes_[i] - s * slopes_[i + 1]);
}

Vec3 TimeTable::rate(double t) const {
  if (t <= times_.front() || t >= times_.back()) return Vec3::Zero();
  const std::size_t i = interval(t);
  const double h = times_[i + 1] - times_[i], s = (t - times_[i]) / h, r = 1.0 - s;
  return 6.0 * s * r / h * (values_[i + 1] - values_[i]) + r * (1.0 - 3.0 * s) * slopes_[i] +
         s * (3.0 * s - 2.0) * slopes_[i + 1];
}

double TimeTable::period() const {
  double least = times_.back() - times_.front();
  for (std::size_t i = 1; i < times_.size(); ++i) least = std::min(least, times_[i] - times_[i - 1]);
  return 2.0 * least;
}

TimeTable read_table(const JsonNode& table, std::size_t width) {
  std::vector<double> times;
  std::vector<Vec3> values;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const std::vector<double> row = table.at(k).numbers();
    if (row.size() != width + 1)
      table.at(k).refuse(std::to_string(row.size()) + " numbers",
                         width == 1 ? "a time and a value" : "a time and three coordinates");
    if (!times.empty() && !(row[0] > times.back()))
      table.at(k).refuse("a time not after the one before", "ascending times");
    times.push_back(row[0]);
    values.emplace_back(row[1], width == 3 ? row[2] : 0.0, width == 3 ? row[3] : 0.0);
  }
  return {std::move(times), std::move(values)};
}

}  // namespace tendril::scene
