#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "study/output.h"
#include "study/svg.h"

namespace tendril::runner {
namespace {

using namespace svg;

// Two panels beside each other, the legend below.
constexpr double kPanelWidth = 430, kPanelHeight = 360, kLeft = 84, kTop = 92, kBetween = 96, kRight = 28;
constexpr double kLine = 20;  // of the legend and notes

/// Of a method, by its row in the table.
const char* colour_of(Method method) {
  return kColours[static_cast<std::size_t>(method) % kColours.size()];
}

/// A logarithmic axis over whole decades.
struct Decades : Axis {
  double operator()(double value) const { return Axis::operator()(std::log10(value)); }
};

Decades decades_over(const std::vector<double>& values, double from, double to) {
  if (values.empty()) return {{0.0, 1.0, from, to}};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double low = std::floor(std::log10(*least) - 0.05);
  return {{low, std::max(low + 1.0, std::ceil(std::log10(*most) + 0.05)), from, to}};
}

std::string decade(int exponent) {
  static const std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (exponent == 0) return "1";
  std::string out = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) out += digits[static_cast<std::size_t>(c - '0')];
  return out;
}

/// What one panel shows of a trial along its horizontal axis.
using Cost = double (*)(const Trial&);

bool shown(const Trial& trial) {
  return trial.error && trial.error->position > 0.0 && trial.evaluations > 0.0;
}

struct Panel {
  const Results& results;
  Cost cost;
  Decades x, y;

  std::string grid(const char* title) const {
    std::string out = Element("rect")
                          .with("x", x.from)
                          .with("y", y.to)
                          .with("width", x.to - x.from)
                          .with("height", y.from - y.to)
                          .with("class", "frame")
                          .end();
    const int stride = 1 + static_cast<int>(x.high - x.low) / 8;
    const int first = static_cast<int>(x.low);
    for (int e = first; e <= x.high; ++e) {
      const double at = x(std::pow(10.0, e));
      out += line(at, y.from, at, y.to);
      if ((e - first) % stride == 0) out += words(at, y.from + 18, "middle", decade(e));
    }
    for (int e = static_cast<int>(y.low); e <= y.high; ++e) {
      const double at = y(std::pow(10.0, e));
      out += line(x.from, at, x.to, at);
      out += words(x.from - 8, at + 4, "end", decade(e));
    }
    return out + words(0.5 * (x.from + x.to), y.from + 42, "middle", title, "title");
  }

  /// What the reference does not resolve, and what the reader is after.
  std::string bands() const {
    std::string out;
    const double gap = results.reference ? results.reference->gap.position : 0.0;
    const double floor = std::pow(10.0, y.low), ceiling = std::pow(10.0, y.high);
    if (gap > floor && std::isfinite(gap)) {
      const double top = y(std::min(gap, ceiling));
      out += Element("rect")
                 .with("x", x.from)
                 .with("y", top)
                 .with("width", x.to - x.from)
                 .with("height", y.from - top)
                 .with("class", "gap")
                 .end();
    }
    const double target = results.plan.target;
    if (target > floor && target < ceiling) {
      out += line(x.from, y(target), x.to, y(target), "target");
      out += words(x.to - 6, y(target) - 6, "end", "target", "small");
    }
    return out;
  }

  std::string mark(const Trial& trial) const {
    const Setting& setting = trial.setting;
    const char* colour = colour_of(setting.method);
    const double cx = x(cost(trial)), cy = y(trial.error->position);
    // The automatic choice lies on one of the others: smaller, so that both are seen.
    const double r = setting.method == Method::automatic ? 2.6 : 4.6;
    std::string out = circle(cx, cy, r, trial.finished() ? colour : "#ffffff", colour);
    const auto& advised = results.advice.setting;
    if (advised && advised->method == setting.method && advised->value == setting.value)
      out += circle(cx, cy, 9.0, "none", "#222222");
    return out;
  }

  std::string curve(Method method) const {
    std::string points, marks;
    for (const Trial& trial : results.trials) {
      if (trial.setting.method != method || !shown(trial)) continue;
      if (trial.finished()) points += corner(x(cost(trial)), y(trial.error->position));
      marks += mark(trial);
    }
    const char* kind = method == Method::automatic ? "curve chosen" : "curve";
    return Element("polyline")
               .with("points", points)
               .with("stroke", colour_of(method))
               .with("class", kind)
               .end() +
           marks;
  }

  std::string draw(const char* title) const {
    std::string out = grid(title) + bands();
    for (const Method method : results.plan.methods)
      if (method != Method::automatic) out += curve(method);
    return out + curve(Method::automatic);
  }
};

Panel panel(const Results& results, Cost cost, double left) {
  std::vector<double> costs, errors{results.plan.target};
  for (const Trial& trial : results.trials) {
    if (!shown(trial)) continue;
    costs.push_back(std::max(cost(trial), 1e-9));
    errors.push_back(std::clamp(trial.error->position, 1e-16, 1e3));
  }
  return {results, cost, decades_over(costs, left, left + kPanelWidth),
          decades_over(errors, kTop + kPanelHeight, kTop)};
}

/// One entry a method, several in a row.
std::string legend(const Results& results, double& y) {
  std::string out;
  double x = kLeft;
  const double width = kLeft + 2 * kPanelWidth + kBetween;
  for (const Method method : results.plan.methods) {
    const std::string name = tendril::to_string(method);
    if (x + 130 > width) x = kLeft, y += kLine;
    out += circle(x + 6, y - 4, 4.5, colour_of(method));
    out += words(x + 16, y, "start", name);
    x += 130;
  }
  y += kLine;
  out += words(
      kLeft, y, "start",
      "hollow: stopped at its cap, cost extrapolated, error so far; ring: recommended; grey: below what the "
      "reference resolves",
      "small");
  return out;
}

/// Why runs are not in the picture, one line each kind.
std::string notes(const Results& results, double& y) {
  std::string out;
  std::vector<Method> told;
  for (const Trial& trial : results.trials) {
    const bool known = std::find(told.begin(), told.end(), trial.setting.method) != told.end();
    if (trial.outcome != Trial::Outcome::refused || known) continue;
    told.push_back(trial.setting.method);
    y += kLine - 3;
    std::string text = "refused: " + to_string(trial.setting) + ": " + trial.reason;
    if (text.size() > 150) text = text.substr(0, 147) + "...";
    out += words(kLeft, y, "start", text, "small");
  }
  return out;
}

const char* const kStyle =
    ".words{font-size:13px}"
    ".title{font-size:14px}.small{font-size:11.5px;fill:#555555}.head{font-size:17px;font-weight:bold}"
    ".frame{fill:#ffffff;stroke:#888888;stroke-width:1}.grid{stroke:#e4e4e4;stroke-width:1}"
    ".target{stroke:#222222;stroke-width:1;stroke-dasharray:5 4}.gap{fill:#eeeeee}"
    ".curve{fill:none;stroke-width:2}.chosen{stroke-width:1.4;stroke-dasharray:3 3}";

}  // namespace

std::string to_svg(const Results& results, const Study& study) {
  const double width = kLeft + 2 * kPanelWidth + kBetween + kRight;
  const Panel time = panel(
      results, [](const Trial& t) { return t.cpu; }, kLeft);
  const Panel work = panel(
      results, [](const Trial& t) { return t.evaluations; }, kLeft + kPanelWidth + kBetween);
  std::string body =
      words(kLeft, 32, "start",
            "Error against cost: " + std::filesystem::path(study.file().path).filename().string(), "head");
  body += words(
      kLeft, 54, "start",
      "position error: root mean square over the masses, largest over the outputs, relative to the longest "
      "curve-pair",
      "small");
  body += words(kLeft, 72, "start",
                "reference " + (results.reference ? results.reference->statement : std::string("missing")),
                "small");
  body +=
      Element("text")
          .with("transform", "translate(24 " + number("%.0f", kTop + 0.5 * kPanelHeight) + ") rotate(-90)")
          .with("text-anchor", "middle")
          .with("class", "title")
          .end("position error");
  body += time.draw(results.plan.rate ? "time by evaluations [s]" : "CPU time [s]") +
          work.draw("evaluations of the equations");
  double y = kTop + kPanelHeight + 76;
  body += legend(results, y);
  body += notes(results, y);
  return picture(width, y + 18, kStyle, body);
}

}  // namespace tendril::runner
