#include <algorithm>
#include <cmath>

#include "accuracy/collision/suite.h"
#include "study/svg.h"

// Error against run time: a panel a section, a mark a family and library. Across, CPU time a query; up, the
// share of wrong answers, with a line of its own for none at all. Hollow marks: some queries were left
// undecided, and as many parts of a ring are drawn as parts of the queries were.
namespace tendril::suite {
namespace {

using namespace svg;

constexpr double kWidth = 300, kHeight = 220, kLeft = 70, kTop = 64, kGapX = 84, kGapY = 78;
constexpr int kAcross = 3;
constexpr double kNone = -7.0;  ///< decade that stands for no wrong answer

double share_of(const Row& row) {
  const double wrong = static_cast<double>(row.missed + row.invented + row.wrong);
  return wrong > 0 ? std::log10(wrong / static_cast<double>(row.queries)) : kNone;
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

/// Marks of families with as many wrong answers stand beside each other where their times do, so they are
/// small.
std::string mark(const Panel& panel, const Row& row, const char* colour) {
  const double x = panel.x(std::log10(std::max(row.us, 1e-3))), y = panel.y(std::max(share_of(row), kNone));
  const double part = static_cast<double>(row.undecided) / static_cast<double>(std::max(1L, row.queries));
  std::string out = circle(x, y, 4.5, part > 0 ? "#ffffff" : colour, colour);
  if (part > 0) out += circle(x, y, 4.5 * std::sqrt(1.0 - std::min(1.0, part)), colour);
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
    return kColours[static_cast<std::size_t>(at) % kColours.size()];
  };
  std::string body =
      words(kLeft, 30, "start", "Collision tests: share of wrong answers against run time", "head");
  body +=
      words(kLeft, 50, "start",
            "a mark a family of queries; partly white: so many were left undecided, or not asked", "small");
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
