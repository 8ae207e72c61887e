#include "chart.h"

#include <algorithm>
#include <cmath>

#include "study/svg.h"

namespace tendril::gallery {
namespace {

using svg::Axis;

constexpr double kLeft = 70, kTop = 32, kRight = 14, kFoot = 46, kLegend = 17;

/// A range of an axis and where its ticks are, all in decades where it is logarithmic.
struct Scale {
  Axis axis;
  std::vector<double> ticks;
  bool log;
  double operator()(double value) const { return axis(log ? std::log10(value) : value); }
  std::string label(double tick) const {
    return log ? svg::number("1e%.0f", tick)
               : svg::number("%.3g", std::abs(tick) < 1e-9 * (axis.high - axis.low) ? 0 : tick);
  }
};

Scale scale_over(std::vector<double> values, bool log, double from, double to) {
  if (log)
    for (double& value : values) value = std::log10(value);
  auto [low, high] = std::minmax_element(values.begin(), values.end());
  double a = values.empty() ? 0.0 : *low, b = values.empty() ? 1.0 : *high;
  if (!(b > a)) b = a + 1.0;
  const double margin = 0.04 * (b - a);
  Scale out{{a - margin, b + margin, from, to}, {}, log};
  const double rough = (b - a) / 5, decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = rough / decade < 1.5 ? decade : rough / decade < 3.5 ? 2 * decade : 5 * decade;
  if (log) step = std::max(1.0, std::ceil((b - a) / 8));
  for (double k = std::ceil(out.axis.low / step); k * step <= out.axis.high; ++k)
    out.ticks.push_back(k * step);
  return out;
}

std::string drawn(const Line& line, const Scale& x, const Scale& y, const char* colour) {
  std::string path, marks;
  for (const auto& [px, py] : line.points) {
    path += svg::corner(x(px), y(py));
    if (line.marks) marks += svg::circle(x(px), y(py), 2.8, colour);
  }
  return svg::Element("polyline").with("class", "curve").with("stroke", colour).with("points", path).end() +
         marks;
}

}  // namespace

std::string Chart::svg(double width, double height) const {
  std::vector<double> xs, ys;
  for (const Line& line : lines)
    for (const auto& [px, py] : line.points) {
      xs.push_back(px);
      ys.push_back(py);
    }
  const Scale across = scale_over(xs, log_x, kLeft, width - kRight);
  const Scale upwards = scale_over(ys, log_y, height - kFoot, kTop);
  std::string body = svg::words(kLeft, 19, "start", title, "title");
  for (const double tick : across.ticks) {
    body += svg::line(across.axis(tick), kTop, across.axis(tick), height - kFoot);
    body += svg::words(across.axis(tick), height - kFoot + 15, "middle", across.label(tick));
  }
  for (const double tick : upwards.ticks) {
    body += svg::line(kLeft, upwards.axis(tick), width - kRight, upwards.axis(tick));
    body += svg::words(kLeft - 6, upwards.axis(tick) + 4, "end", upwards.label(tick));
  }
  body += svg::words(0.5 * (kLeft + width - kRight), height - 12, "middle", x);
  body += "<g transform=\"translate(14 " + svg::number("%.0f", 0.5 * height) + ") rotate(-90)\">" +
          svg::words(0, 0, "middle", y) + "</g>\n";
  double foot = height + 4;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const char* colour = svg::kColours[k % svg::kColours.size()];
    body += drawn(lines[k], across, upwards, colour);
    if (lines[k].name.empty()) continue;
    body += svg::Element("line")
                .with("x1", kLeft)
                .with("y1", foot - 4)
                .with("x2", kLeft + 18)
                .with("y2", foot - 4)
                .with("class", "curve")
                .with("stroke", colour)
                .end() +
            svg::words(kLeft + 26, foot, "start", lines[k].name);
    foot += kLegend;
  }
  return svg::picture(width, foot + 2,
                      ".words{font-size:11px}.title{font-size:13px;font-weight:bold}.grid{stroke:#e2e2e2}"
                      ".curve{fill:none;stroke-width:1.6}",
                      body);
}

}  // namespace tendril::gallery
