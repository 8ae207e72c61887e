#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

/// SVG as the program's chart and the validation book write it: elements, words, lines, axes and colours.
namespace tendril::svg {

/// Colours that differ for colour-blind readers too (Okabe and Ito), dark enough on white.
inline constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                     "#56b4e9", "#8c6d1f", "#555555"};

inline std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

/// Attributes of one element, in the order given.
class Element {
 public:
  explicit Element(std::string name) : text_("<" + std::move(name)) {}
  Element& with(const char* key, const std::string& value) {
    text_ += std::string(" ") + key + "=\"" + value + "\"";
    return *this;
  }
  Element& with(const char* key, double value) { return with(key, number("%.2f", value)); }
  std::string end() const { return text_ + "/>\n"; }
  std::string end(const std::string& inside) const {
    return text_ + ">" + escaped(inside) + "</" + text_.substr(1, text_.find(' ') - 1) + ">\n";
  }

 private:
  std::string text_;
};

/// \param kind  the class in the style sheet
inline std::string words(double x, double y, const char* anchor, const std::string& text,
                         const char* kind = "words") {
  return Element("text").with("x", x).with("y", y).with("text-anchor", anchor).with("class", kind).end(text);
}

inline std::string line(double x1, double y1, double x2, double y2, const char* kind = "grid") {
  return Element("line")
      .with("x1", x1)
      .with("y1", y1)
      .with("x2", x2)
      .with("y2", y2)
      .with("class", kind)
      .end();
}

inline std::string circle(double x, double y, double radius, const std::string& fill,
                          const std::string& stroke = "none") {
  return Element("circle")
      .with("cx", x)
      .with("cy", y)
      .with("r", radius)
      .with("fill", fill)
      .with("stroke", stroke)
      .end();
}

/// One of a polyline's points.
inline std::string corner(double x, double y) {
  return number("%.2f,", x) + number("%.2f ", y);
}

/// Values to places in the picture: low at `from`, high at `to`.
struct Axis {
  double low = 0.0, high = 1.0, from = 0.0, to = 1.0;
  double operator()(double value) const { return from + (to - from) * (value - low) / (high - low); }
};

/// What stands around all: the style sheet, a white ground, the body.
inline std::string picture(double width, double height, const std::string& style, const std::string& body) {
  const std::string w = number("%.0f", width), h = number("%.0f", height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " +
         w + " " + h + "\">\n<style>text{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif;fill:#222222}" +
         style + "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body + "</svg>\n";
}

}  // namespace tendril::svg
