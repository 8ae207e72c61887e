#include "bench/output.h"

#include <algorithm>
#include <cstdio>

namespace tendril::bench {

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string duration(double seconds) {
  if (seconds < 1e-6) return text("%.3g ns", 1e9 * seconds);
  if (seconds < 1e-3) return text("%.3g us", 1e6 * seconds);
  if (seconds < 1.0) return text("%.3g ms", 1e3 * seconds);
  return text(seconds < 1000.0 ? "%.3g s" : "%.0f s", seconds);
}

void Table::print() const {
  std::vector<std::size_t> width;
  for (const auto& row : rows_) {
    width.resize(std::max(width.size(), row.size()), 0);
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], row[k].size());
  }
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const int field = static_cast<int>(width[k]);
      std::printf(k == 0 ? "%-*s" : "  %*s", field, row[k].c_str());
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

void heading(const std::string& name, const std::string& about) {
  std::printf("\n== %s ==\n%s\n", name.c_str(), about.c_str());
  std::fflush(stdout);
}

}  // namespace tendril::bench
