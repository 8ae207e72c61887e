#include <algorithm>
#include <array>
#include <cmath>

#include "accuracy/collision/suite.h"
#include "study/svg.h"

// Error against run time: a panel a section, marks a family and library. Across, CPU time a query; up, the
// share of wrong answers, with a line of its own for none at all.
namespace tendril::suite {
namespace {

using namespace svg;

constexpr double kWidth = 300, kHeight = 220, kLeft = 70, kTop = 64, kGapX = 84, kGapY = 78;
constexpr int kAcross = 3;
constexpr double kNone = -7.0;  ///< decade that stands for no wrong answer

/// More than svg.h has: as many libraries as there are.
constexpr std::array kMany{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#8c6d1f",
                           "#555555", "#000000", "#e69f00", "#332288", "#882255", "#117733"};

double decade_of(long wrong, const Row& row) {
  if (wrong == 0) return kNone;
  return std::max(kNone, std::log10(static_cast<double>(wrong) / static_cast<double>(row.queries)));
}

struct Panel {
  Axis x, y;
};

std::string grid(const Panel& panel, const std::string& title) {
  std::string out = words(panel.x.from, panel.y.to - 12, "start", title, "title");
  for (int decade = static_cast<int>(panel.x.low); decade <= panel.x.high; ++decade) {
    out += line(panel.x(decade), panel.y.from, panel.x(decade), panel.y.to);
    out += words(panel.x(decade), panel.y.from + 16, "middle", number("%g", std::pow(10.0, decade)));
  }
  for (int decade = static_cast<int>(kNone); decade <= 0; ++decade) {
    out +=
        line(panel.x.from, panel.y(decade), panel.x.to, panel.y(decade), decade == kNone ? "none" : "grid");
    out += words(panel.x.from - 6, panel.y(decade) + 4, "end",
                 decade == kNone ? "none" : number("%g", std::pow(10.0, decade)));
  }
  return out + words(0.5 * (panel.x.from + panel.x.to), panel.y.from + 32, "middle", "us a query");
}

std::string corners_of(const std::vector<std::array<double, 2>>& corners, const char* colour) {
  std::string points;
  for (const auto& [x, y] : corners) points += corner(x, y);
  return Element("polygon").with("points", points).with("fill", colour).end();
}

/// Missed: a triangle that points down; invented: up; wrong in another respect: a square; nothing of it: a
/// disc, of which as much is white as was left undecided.
std::string mark(const Panel& panel, const Row& row, const char* colour) {
  constexpr double r = 5.0;
  const double x = panel.x(std::log10(std::max(row.us, 1e-3)));
  std::string out;
  if (row.missed > 0) {
    const double y = panel.y(decade_of(row.missed, row));
    out += corners_of({{x - r, y - 0.6 * r}, {x + r, y - 0.6 * r}, {x, y + r}}, colour);
  }
  if (row.invented > 0) {
    const double y = panel.y(decade_of(row.invented, row));
    out += corners_of({{x - r, y + 0.6 * r}, {x + r, y + 0.6 * r}, {x, y - r}}, colour);
  }
  if (row.wrong > 0) {
    const double y = panel.y(decade_of(row.wrong, row)), h = 0.8 * r;
    out += corners_of({{x - h, y - h}, {x + h, y - h}, {x + h, y + h}, {x - h, y + h}}, colour);
  }
  if (!out.empty()) return out;
  const double y = panel.y(kNone);
  const double left =
      1.0 - static_cast<double>(row.undecided) / static_cast<double>(std::max(1L, row.queries));
  out = circle(x, y, r, left < 1.0 ? "#ffffff" : colour, colour);
  if (left > 0.0 && left < 1.0) out += circle(x, y, r * std::sqrt(left), colour);
  return out;
}

Panel panel_at(int index, const std::vector<Row>& rows, const std::string& section) {
  double low = 10.0, high = -10.0;
  for (const Row& row : rows)
    if (row.section == section) {
      low = std::min(low, std::log10(std::max(row.us, 1e-3)));
      high = std::max(high, std::log10(std::max(row.us, 1e-3)));
    }
  const double left = kLeft + (index % kAcross) * (kWidth + kGapX),
               top = kTop + 40 + (index / kAcross) * (kHeight + kGapY);
  const double first = std::floor(low), last = std::max(first + 1.0, std::ceil(high));
  return {{first, last, left, left + kWidth}, {kNone, 0.0, top + kHeight, top}};
}

std::vector<std::string> distinct(const std::vector<Row>& rows, std::string Row::*what) {
  std::vector<std::string> out;
  for (const Row& row : rows)
    if (std::find(out.begin(), out.end(), row.*what) == out.end()) out.push_back(row.*what);
  return out;
}

const char* const kStyle =
    ".words{font-size:11px}.title{font-size:13px;font-weight:bold}.head{font-size:17px;font-weight:bold}"
    ".small{font-size:11.5px;fill:#555555}.grid{stroke:#e2e2e2}.none{stroke:#222222}";

}  // namespace

std::string to_svg(const std::vector<Row>& rows) {
  const std::vector<std::string> sections = distinct(rows, &Row::section), peers = distinct(rows, &Row::peer);
  const auto colour = [&](const std::string& peer) {
    const auto at = std::find(peers.begin(), peers.end(), peer) - peers.begin();
    return kMany[static_cast<std::size_t>(at) % kMany.size()];
  };
  std::string body =
      words(kLeft, 30, "start", "Collision tests: share of wrong answers against run time", "head");
  body += words(kLeft, 50, "start",
                "a mark a family of queries; pointing down: missed, up: invented, square: wrong in another "
                "respect, disc: "
                "none of these, white as far as queries were left undecided or not asked",
                "small");
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const Panel panel = panel_at(static_cast<int>(s), rows, sections[s]);
    body += grid(panel, sections[s]);
    for (const Row& row : rows)
      if (row.section == sections[s]) body += mark(panel, row, colour(row.peer));
  }
  const auto lines = (sections.size() + kAcross - 1) / kAcross;
  double x = kLeft, y = kTop + 40 + static_cast<double>(lines) * (kHeight + kGapY);
  for (const std::string& peer : peers) {
    body += circle(x + 6, y - 4, 4.5, colour(peer)) + words(x + 16, y, "start", peer);
    x += 190;
    if (x > kLeft + kAcross * (kWidth + kGapX) - 190) x = kLeft, y += 20;
  }
  return picture(kLeft + kAcross * (kWidth + kGapX), y + 24, kStyle, body);
}

}  // namespace tendril::suite
