#include <algorithm>
#include <cmath>

#include "accuracy/case.h"
#include "study/svg.h"

namespace tendril::accuracy {
namespace {

using namespace svg;

constexpr double kWidth = 430, kHeight = 300, kLeft = 76, kTop = 34, kRight = 16, kFoot = 48, kLine = 18;

constexpr const char* kGrey = "#aaaaaa";

Axis axis_over(double low, double high, double from, double to) {
  if (!(high > low)) high = low + 1;
  const double margin = 0.04 * (high - low);
  return {low - margin, high + margin, from, to};
}

/// About five round numbers on an axis.
std::vector<double> ticks(const Axis& axis) {
  const double rough = (axis.high - axis.low) / 5, decade = std::pow(10.0, std::floor(std::log10(rough)));
  const double step = rough / decade < 1.5 ? decade : rough / decade < 3.5 ? 2 * decade : 5 * decade;
  std::vector<double> out;
  for (double k = std::ceil(axis.low / step); k * step <= axis.high; ++k) out.push_back(k * step);
  return out;
}

std::string draw(const Curve& curve, const Axis& x, const Axis& y, const char* colour) {
  std::string marks, path;
  for (const auto& [px, py] : curve.points)
    if (curve.kind == Curve::Kind::marks)
      marks += circle(x(px), y(py), 2.8, colour);
    else
      path += corner(x(px), y(py));
  if (path.empty()) return marks;
  return Element("polyline").with("class", "curve").with("stroke", colour).with("points", path).end();
}

/// The curve's line of the legend.
std::string key(const Curve& curve, const char* colour, double height) {
  const Axis x{0, 1, kLeft + 4, kLeft + 22}, y{0, 1, height - 4, height - 3};
  return draw({"", {{0, 0}, {1, 0}}, curve.kind}, x, y, colour) +
         words(kLeft + 30, height, "start", curve.name);
}

const char* const kStyle =
    ".words{font-size:11px}.title{font-size:13px;font-weight:bold}.grid{stroke:#e2e2e2}"
    ".curve{fill:none;stroke-width:1.6}";

/// A picture whose points are places on the axes already; `label` writes a tick.
template <typename Label>
std::string drawn(const Figure& figure, const Axis& x, const Axis& y, const std::vector<double>& x_ticks,
                  const std::vector<double>& y_ticks, Label label) {
  const auto named = std::count_if(figure.curves.begin(), figure.curves.end(),
                                   [](const Curve& curve) { return !curve.name.empty(); });
  std::string out = words(kLeft, 20, "start", figure.title, "title");
  for (const double at : x_ticks) {
    out += line(x(at), y.from, x(at), y.to);
    out += words(x(at), y.from + 16, "middle", label(at, true));
  }
  for (const double at : y_ticks) {
    out += line(x.from, y(at), x.to, y(at));
    out += words(x.from - 6, y(at) + 4, "end", label(at, false));
  }
  out += words(0.5 * (x.from + x.to), kHeight - 14, "middle", figure.x);
  out += "<g transform=\"translate(14 " + number("%.0f", 0.5 * (y.from + y.to)) + ") rotate(-90)\">" +
         words(0, 0, "middle", figure.y) + "</g>\n";
  for (const Curve& curve : figure.curves)
    if (curve.kind == Curve::Kind::reference) out += draw(curve, x, y, kGrey);
  std::size_t k = 0;
  double at = kHeight + 4;
  for (const Curve& curve : figure.curves) {
    const bool reference = curve.kind == Curve::Kind::reference;
    const char* colour = reference ? kGrey : kColours[k++ % kColours.size()];
    if (!reference) out += draw(curve, x, y, colour);
    if (curve.name.empty()) continue;
    out += key(curve, colour, at);
    at += kLine;
  }
  return picture(kWidth, kHeight + kLine * static_cast<double>(named), kStyle, out);
}

struct Box {
  double x[2] = {HUGE_VAL, -HUGE_VAL}, y[2] = {HUGE_VAL, -HUGE_VAL};
};
Box box_of(const Figure& figure) {
  Box box;
  for (const Curve& curve : figure.curves)
    for (const auto& [x, y] : curve.points) {
      box.x[0] = std::min(box.x[0], x);
      box.x[1] = std::max(box.x[1], x);
      box.y[0] = std::min(box.y[0], y);
      box.y[1] = std::max(box.y[1], y);
    }
  return box;
}

/// Widens the range whose unit would be drawn longer.
void even_out(Box& box) {
  const double w = kWidth - kLeft - kRight, h = kHeight - kTop - kFoot;
  const double unit = std::max((box.x[1] - box.x[0]) / w, (box.y[1] - box.y[0]) / h);
  const auto widen = [&](double* range, double size) {
    const double middle = 0.5 * (range[0] + range[1]);
    range[0] = middle - 0.5 * unit * size;
    range[1] = middle + 0.5 * unit * size;
  };
  widen(box.x, w);
  widen(box.y, h);
}

}  // namespace

std::string to_svg(const Figure& figure) {
  Box box = box_of(figure);
  if (figure.same_scale) even_out(box);
  const Axis x = axis_over(box.x[0], box.x[1], kLeft, kWidth - kRight);
  const Axis y = axis_over(box.y[0], box.y[1], kHeight - kFoot, kTop);
  return drawn(figure, x, y, ticks(x), ticks(y),
               [](double at, bool) { return number("%.3g", std::abs(at) < 1e-12 ? 0.0 : at); });
}

std::string errors_svg(const Case& one) {
  Figure figure{"Error", one.count, "error"};
  for (const Quantity& quantity : one.quantities) {
    Curve curve{quantity.name, {}};
    for (const Row& row : quantity.rows)
      if (row.error != 0.0) curve.points.emplace_back(std::log10(row.n), std::log10(std::abs(row.error)));
    if (curve.points.size() > 1) figure.curves.push_back(std::move(curve));
  }
  if (figure.curves.empty()) return "";
  const Box box = box_of(figure);
  const Axis x = axis_over(box.x[0], box.x[1], kLeft, kWidth - kRight);
  const Axis y = axis_over(std::floor(box.y[0]), std::ceil(box.y[1]), kHeight - kFoot, kTop);
  std::vector<double> counts, decades;
  for (const Quantity& quantity : one.quantities)
    for (const Row& row : quantity.rows) counts.push_back(std::log10(row.n));
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  // Labels that would run into each other are left out.
  std::vector<double> apart;
  for (const double at : counts)
    if (at >= x.low && at <= x.high && (apart.empty() || x(at) - x(apart.back()) > 34)) apart.push_back(at);
  const double stride = std::ceil((y.high - y.low) / 8);
  for (double e = std::ceil(y.low); e <= y.high; e += stride) decades.push_back(e);
  return drawn(figure, x, y, apart, decades, [](double at, bool is_count) {
    return is_count ? number("%.0f", std::pow(10.0, at)) : number("1e%.0f", at);
  });
}

}  // namespace tendril::accuracy
