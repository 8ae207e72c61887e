#pragma once

#include "scene/json/json_node.h"

#include <vector>

namespace tendril::scene {

/// A smooth curve through a table of values over time: the cubic spline with continuous second derivative
/// that is at rest at both ends [de Boor 2001, chapter IV], and stays there before and after.
class TimeTable {
 public:
  TimeTable() = default;
  /// \param times   ascending, at least 2
  /// \param values  as many
  TimeTable(std::vector<double> times, std::vector<Vec3> values);

  bool empty() const { return times_.empty(); }
  Vec3 value(double t) const;
  Vec3 rate(double t) const;
  /// Twice the shortest time between two entries: a motion as quick as the table can say.
  double period() const;

 private:
  std::size_t interval(double t) const;

  std::vector<double> times_;
  std::vector<Vec3> values_, slopes_;
};

/// Rows of a time and `width` numbers, 1 or 3; one alone is the x of a value. Refuses times that do not
/// ascend.
TimeTable read_table(const JsonNode& table, std::size_t width);

}  // namespace tendril::scene
