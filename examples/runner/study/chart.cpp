#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "study/output.h"

namespace tendril::runner {
namespace {

// Two panels beside each other, the legend below.
constexpr double kPanelWidth = 430, kPanelHeight = 360, kLeft = 84, kTop = 92, kBetween = 96, kRight = 28;
constexpr double kLine = 20;  // of the legend and notes

/// Colours that differ for colour-blind readers too (Okabe and Ito), by the method's row; dark enough on
/// white.
const char* colour_of(Method method) {
  constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#8c6d1f", "#555555"};
  return kColours[static_cast<std::size_t>(method) % kColours.size()];
}

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

/// Attributes of one SVG element, in the order given.
struct Element {
  explicit Element(std::string name) : text("<" + std::move(name)) {}
  Element& with(const char* key, const std::string& value) {
    text += std::string(" ") + key + "=\"" + value + "\"";
    return *this;
  }
  Element& with(const char* key, double value) { return with(key, number("%.2f", value)); }
  std::string end() const { return text + "/>\n"; }
  std::string end(const std::string& inside) const {
    return text + ">" + escaped(inside) + "</" + text.substr(1, text.find(' ') - 1) + ">\n";
  }
  std::string text;
};

std::string words(double x, double y, const char* anchor, const std::string& text,
                  const char* kind = "words") {
  return Element("text").with("x", x).with("y", y).with("text-anchor", anchor).with("class", kind).end(text);
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return Element("line")
      .with("x1", x1)
      .with("y1", y1)
      .with("x2", x2)
      .with("y2", y2)
      .with("class", kind)
      .end();
}

/// A logarithmic axis over whole decades.
struct Axis {
  int low = 0, high = 1;
  double from = 0.0, to = 1.0;  ///< in the picture
  double operator()(double value) const {
    return from + (to - from) * (std::log10(value) - low) / (high - low);
  }
};

Axis axis_over(const std::vector<double>& values, double from, double to) {
  Axis out{0, 1, from, to};
  if (values.empty()) return out;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  out.low = static_cast<int>(std::floor(std::log10(*least) - 0.05));
  out.high = std::max(out.low + 1, static_cast<int>(std::ceil(std::log10(*most) + 0.05)));
  return out;
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
  Axis x, y;

  std::string grid(const char* title) const {
    std::string out = Element("rect")
                          .with("x", x.from)
                          .with("y", y.to)
                          .with("width", x.to - x.from)
                          .with("height", y.from - y.to)
                          .with("class", "frame")
                          .end();
    const int stride = 1 + (x.high - x.low) / 8;
    for (int e = x.low; e <= x.high; ++e) {
      const double at = x(std::pow(10.0, e));
      out += line(at, y.from, at, y.to, "grid");
      if ((e - x.low) % stride == 0) out += words(at, y.from + 18, "middle", decade(e));
    }
    for (int e = y.low; e <= y.high; ++e) {
      const double at = y(std::pow(10.0, e));
      out += line(x.from, at, x.to, at, "grid");
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

  static Element circle(double cx, double cy, double r, const char* fill, const char* stroke) {
    return Element("circle")
        .with("cx", cx)
        .with("cy", cy)
        .with("r", r)
        .with("fill", fill)
        .with("stroke", stroke);
  }

  std::string mark(const Trial& trial) const {
    const Setting& setting = trial.setting;
    const char* colour = colour_of(setting.method);
    const double cx = x(cost(trial)), cy = y(trial.error->position);
    // The automatic choice lies on one of the others: smaller, so that both are seen.
    const double r = setting.method == Method::automatic ? 2.6 : 4.6;
    std::string out = circle(cx, cy, r, trial.finished() ? colour : "#ffffff", colour).end();
    const auto& advised = results.advice.setting;
    if (advised && advised->method == setting.method && advised->value == setting.value)
      out += circle(cx, cy, 9.0, "none", "#222222").end();
    return out;
  }

  std::string curve(Method method) const {
    std::string points, marks;
    for (const Trial& trial : results.trials) {
      if (trial.setting.method != method || !shown(trial)) continue;
      if (trial.finished())
        points += number("%.2f", x(cost(trial))) + "," + number("%.2f ", y(trial.error->position));
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
  return {results, cost, axis_over(costs, left, left + kPanelWidth),
          axis_over(errors, kTop + kPanelHeight, kTop)};
}

/// One entry a method, several in a row.
std::string legend(const Results& results, double& y) {
  std::string out;
  double x = kLeft;
  const double width = kLeft + 2 * kPanelWidth + kBetween;
  for (const Method method : results.plan.methods) {
    const std::string name = tendril::to_string(method);
    if (x + 130 > width) x = kLeft, y += kLine;
    out += Element("circle")
               .with("cx", x + 6)
               .with("cy", y - 4)
               .with("r", 4.5)
               .with("fill", colour_of(method))
               .end();
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
    "<style>text{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif;fill:#222222}.words{font-size:13px}"
    ".title{font-size:14px}.small{font-size:11.5px;fill:#555555}.head{font-size:17px;font-weight:bold}"
    ".frame{fill:#ffffff;stroke:#888888;stroke-width:1}.grid{stroke:#e4e4e4;stroke-width:1}"
    ".target{stroke:#222222;stroke-width:1;stroke-dasharray:5 4}.gap{fill:#eeeeee}"
    ".curve{fill:none;stroke-width:2}.chosen{stroke-width:1.4;stroke-dasharray:3 3}</style>\n";

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
  const std::string size = number("%.0f", width) + "\" height=\"" + number("%.0f", y + 18);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " +
         number("%.0f ", width) + number("%.0f", y + 18) + "\">\n" + kStyle +
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body + "</svg>\n";
}

}  // namespace tendril::runner
