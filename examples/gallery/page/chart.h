#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tendril::gallery {

/// A line of a chart.
struct Line {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool marks = false;  ///< a mark at each point, too
};

/// Lines over two axes, either of which may be logarithmic (values above 0).
struct Chart {
  std::string title, x, y;
  std::vector<Line> lines = {};
  bool log_x = false, log_y = false;

  std::string svg(double width = 460, double height = 300) const;
};

}  // namespace tendril::gallery
